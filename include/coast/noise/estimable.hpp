#pragma once
// A process for the estimators: its state-space block over one sample interval as a function of free parameters, the
// derivatives, and the closed-form M-step of the EM algorithm.

#include <Eigen/Core>
#include <cmath>
#include <span>
#include <string_view>
#include <vector>

#include "coast/noise/interval.hpp"
#include "coast/noise/process.hpp"

namespace coast::noise {

/// y[k] = h x[k] + v[k],  x[k+1] = Phi x[k] + w[k],  var w = Q, var v = white, var x[1] = P_first.
struct SampleBlock {
  Eigen::MatrixXd Phi;
  Eigen::MatrixXd Q;
  Eigen::MatrixXd P_first;
  Eigen::RowVectorXd h;
  double white = 0.0;  ///< variance per sample, [signal]^2

  [[nodiscard]] static SampleBlock zero(Eigen::Index states);
};

/// Meaning of one value of a signal: the mean of `averaged` samples, `interval` s apart.
struct SampleStep {
  SampleStep(double seconds, std::size_t count = 1) : interval(seconds), averaged(count) {}  // a bare interval is one sample
  [[nodiscard]] double duration() const { return interval * static_cast<double>(averaged); }
  double interval;
  std::size_t averaged;
};

/// Sensor and sample interval.
struct Sampling {
  Sensor sensor = Sensor::kGyro;
  double interval = 1.0;  ///< s
};

/// Scale of a signal before estimation, from which the ranges of parameters follow.
struct SignalScale {
  double interval = 1.0;  ///< s
  double duration = 1.0;  ///< s
  double variance = 1.0;  ///< [signal]^2, mean and slope removed
};

/// Expected second moments of a block's states given the whole signal, summed over all steps of all records.
struct BlockMoments {
  Eigen::MatrixXd first;     ///< E x[1] x[1]', summed over records
  Eigen::MatrixXd before;    ///< E x[k] x[k]', summed over transitions k -> k+1
  Eigen::MatrixXd lagged;    ///< E x[k+1] x[k]'
  Eigen::MatrixXd after;     ///< E x[k+1] x[k+1]'
  double transitions = 0.0;  ///< their number
  double records = 0.0;
  double residual = 0.0;  ///< E (y - h x - mean)^2 over samples, of the whole sum of processes
  double samples = 0.0;
};

/// A free parameter; the estimators use the unconstrained variable u.
struct ParameterInfo {
  enum class Kind {
    kVariance,  ///< exp(u); may go to zero: the process is then absent
    kRate,      ///< exp(u)
    kPartial,   ///< tanh(u): a partial autocorrelation
  };
  std::string_view name;  ///< "sigma2", "beta", ...
  std::string_view unit;  ///< contains `signal` for rad/s or m/s^2
  Kind kind = Kind::kVariance;

  [[nodiscard]] double value(double u) const { return kind == Kind::kPartial ? std::tanh(u) : std::exp(u); }
  [[nodiscard]] double inverse(double value) const { return kind == Kind::kPartial ? std::atanh(value) : std::log(value); }
};

/// Stateless description of one kind of process; the objects live as long as the program (registry.cpp).
class Estimable {
 public:
  virtual ~Estimable() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;
  [[nodiscard]] virtual std::string_view symbol() const = 0;  ///< as in "WN + 2 GM + RW"
  [[nodiscard]] virtual std::vector<ParameterInfo> parameters() const = 0;
  [[nodiscard]] virtual Eigen::Index states() const = 0;
  /// Whether a block for means of samples exists.
  [[nodiscard]] virtual bool has_averages() const { return true; }
  /// Range of each u in which a record of this scale is informative.
  [[nodiscard]] virtual std::vector<Interval> ranges(const SignalScale& scale) const = 0;
  /// The block at u over one step, and its derivatives with respect to each u (h has none). For means of samples it may have
  /// more states than `states()`.
  [[nodiscard]] virtual SampleBlock block(std::span<const double> u, const SampleStep& step) const = 0;
  [[nodiscard]] virtual std::vector<SampleBlock> derivatives(std::span<const double> u, const SampleStep& step) const = 0;
  /// Sets u to where the expected complete log-likelihood is largest: the M-step. `fixed[i]` keeps u[i].
  virtual void maximise(const BlockMoments& moments, double interval, const std::vector<bool>& fixed,
                        std::span<double> u) const = 0;
  /// The process at u for the filter, for simulation and for curves.
  [[nodiscard]] virtual ProcessPtr process(std::span<const double> u, const Sampling& sampling) const = 0;
};

}  // namespace coast::noise
