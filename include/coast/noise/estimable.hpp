#pragma once
// A process as an estimator sees it: a block over one sample interval as a function of free parameters, its derivatives, and
// the closed-form step of the EM algorithm.

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

/// What one value of a signal is: the mean of `averaged` samples, `interval` s apart.
struct SampleStep {
  SampleStep(double seconds, std::size_t count = 1) : interval(seconds), averaged(count) {}  // a bare interval is one sample
  [[nodiscard]] double duration() const { return interval * static_cast<double>(averaged); }
  double interval;
  std::size_t averaged;
};

/// Whose samples, and how far apart.
struct Sampling {
  Sensor sensor = Sensor::kGyro;
  double interval = 1.0;  ///< s
};

/// What is known of a signal before anything is estimated; ranges of parameters follow from it.
struct SignalScale {
  double interval = 1.0;  ///< s
  double duration = 1.0;  ///< s
  double variance = 1.0;  ///< [signal]^2, mean and slope taken off
};

/// Expected second moments of a block's states given the whole signal, summed over all steps of all records.
struct BlockMoments {
  Eigen::MatrixXd first;     ///< E x[1] x[1]', over records
  Eigen::MatrixXd before;    ///< E x[k] x[k]', over transitions k -> k+1
  Eigen::MatrixXd lagged;    ///< E x[k+1] x[k]'
  Eigen::MatrixXd after;     ///< E x[k+1] x[k+1]'
  double transitions = 0.0;  ///< their number
  double records = 0.0;
  double residual = 0.0;  ///< E (y - h x - mean)^2 over samples, of the whole sum of processes
  double samples = 0.0;
};

/// A free parameter: inside it is unconstrained, u.
struct ParameterInfo {
  enum class Kind {
    kVariance,  ///< exp(u); zero is a value it may have: the process is then not there
    kRate,      ///< exp(u)
    kPartial,   ///< tanh(u): a partial autocorrelation
  };
  std::string_view name;  ///< "sigma2", "beta", ...
  std::string_view unit;  ///< with `signal` for rad/s or m/s^2
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
  /// Whether there is a block for means of samples.
  [[nodiscard]] virtual bool has_averages() const { return true; }
  /// Range of each u in which a record of this scale can tell anything.
  [[nodiscard]] virtual std::vector<Interval> ranges(const SignalScale& scale) const = 0;
  /// The block at u over one step, and its derivatives with respect to each u (h has none). Of means of samples it may have
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
