#pragma once
// The exact Gaussian log-likelihood of static records under a sum of processes, its gradient, and the E-step of the EM
// algorithm.

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "coast/noise/static_signal.hpp"
#include "coast/noise/sum_model.hpp"

namespace coast::noise {

/// Level and drift by generalised least squares, with their covariance.
struct MeanEstimate {
  Eigen::VectorXd value;  ///< empty, [level at the middle], or [level, drift per second]
  Eigen::MatrixXd covariance;
};

struct LikelihoodValue {
  double log_likelihood = 0.0;      ///< restricted: maximised by the estimators
  double at_mean = 0.0;             ///< maximised over level and drift: for comparing sums that differ in their mean
  std::vector<MeanEstimate> means;  ///< one per record
};

struct LikelihoodSlope {
  double log_likelihood = 0.0;
  Eigen::VectorXd gradient;
  /// sum over samples of (de de'/S + dS dS'/(2 S^2)), e the innovation, S its variance: the Fisher information evaluated at the
  /// data.
  Eigen::MatrixXd information;
};

/// One or several records of one sensor axis with the same processes; every record has its own level and drift.
///
///     log L = -1/2 sum_k (log 2 pi + log S_k + e_k^2 / S_k) - 1/2 log |X' V^-1 X| / |X' X| + m/2 log 2 pi
///
/// with the innovations e_k at the level and drift that maximise it, X their m regressors and V the covariance of the samples:
/// the restricted log-likelihood (Patterson & Thompson 1971; Harville 1977), i.e. the likelihood of all contrasts of the record
/// that do not depend on level and drift (docs/decisions/0008-restricted-likelihood.md). Computed exactly by the Kalman filter
/// from the stationary start; in holes the filter only predicts. The record is read once for a value and twice more for the
/// gradient. Once the filter's gain is constant (relative 1e-13) it is no longer recomputed; for a long record without holes it
/// is from the first sample on, and what the start changes is added.
/// @note about 15 ns per sample for a value at 3 states (tools/bench).
class Likelihood {
 public:
  /// @param records  not empty; stored detrended, so that a large constant causes no loss of precision. All at the same
  ///                 interval.
  /// @param averaged  samples of the sensor in each value of the records, which are block_means(record, averaged) if not 1
  /// @throws std::invalid_argument  no samples, or intervals that differ
  Likelihood(const std::vector<StaticSignal>& records, SumModel model, std::size_t averaged = 1);

  [[nodiscard]] const SumModel& model() const { return model_; }
  /// s between samples of the sensor; values are `averaged` of them apart.
  [[nodiscard]] double interval() const { return step().interval; }
  [[nodiscard]] SampleStep step() const {
    return {records_.front().signal.interval / static_cast<double>(averaged_), averaged_};
  }
  [[nodiscard]] double samples() const;
  [[nodiscard]] SignalScale scale() const;
  [[nodiscard]] const std::vector<Detrended>& records() const { return records_; }

  /// -infinity if an innovation variance is not positive.
  [[nodiscard]] LikelihoodValue value(const std::vector<double>& u) const;
  [[nodiscard]] LikelihoodSlope slope(const std::vector<double>& u) const;
  /// With the information known from elsewhere, for instance from the spectrum: a long record without holes is then read the
  /// same few times for any number of parameters.
  [[nodiscard]] LikelihoodSlope slope(const std::vector<double>& u, const Eigen::MatrixXd& information) const;

  /// E-step, for records of samples only (averaged = 1): the log-likelihood at u and the moments of every term of the model, in
  /// order.
  struct Expectation {
    double log_likelihood = 0.0;
    std::vector<BlockMoments> moments;
  };
  /// @param memory  work space of the smoother, kept by the caller for the next call
  [[nodiscard]] Expectation expectation(const std::vector<double>& u, std::vector<double>& memory) const;

  /// e/sqrt(S) of every sample of a record, in the order of its values.
  /// @param gate  samples beyond it are reported but not used by the filter, up to 20 in a row
  [[nodiscard]] std::vector<double> standardised_innovations(const std::vector<double>& u, std::size_t record,
                                                             double gate = std::numeric_limits<double>::infinity()) const;

 private:
  [[nodiscard]] LikelihoodSlope slope_with(const std::vector<double>& u, const Eigen::MatrixXd* information) const;

  std::vector<Detrended> records_;
  SumModel model_;
  std::size_t averaged_;
};

}  // namespace coast::noise
