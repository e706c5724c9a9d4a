#pragma once
// Passes of the Kalman filter and smoother over one record. Private to the room.

#include <vector>

#include "coast/noise/estimable.hpp"
#include "coast/noise/static_signal.hpp"

namespace coast::noise {

/// y - level - drift tau, tau from -1 to 1 over the grid of the record.
struct MeanCurve {
  double level = 0.0;
  double drift = 0.0;
};
/// tau at a grid index.
class GridTime {
 public:
  explicit GridTime(const StaticSignal& signal)
      : middle_(0.5 * static_cast<double>(signal.length() - 1)), half_(std::max(middle_, 0.5)) {}
  [[nodiscard]] double at(std::uint64_t index) const { return (static_cast<double>(index) - middle_) / half_; }
  [[nodiscard]] double step() const { return 1.0 / half_; }

 private:
  double middle_;
  double half_;
};

/// Innovations of three columns at once: the signal, 1 and tau. They are linear: those of any level and drift follow.
struct InnovationSums {
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();  ///< sum e_i e_j / S
  double log_determinant = 0.0;                        ///< sum log S
  bool positive = true;                                ///< false: an innovation variance was not positive
};
[[nodiscard]] InnovationSums innovation_pass(const SampleBlock& block, const StaticSignal& signal);

/// log-likelihood at a given mean, gradient and information by forward sensitivities.
struct ScoreSums {
  double log_likelihood = 0.0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd information;
  std::vector<Eigen::Matrix2d> products;  ///< derivatives of sum e_c e_d / S of the columns 1 and tau, one per parameter
};
[[nodiscard]] ScoreSums score_pass(const SampleBlock& block, const std::vector<SampleBlock>& derivatives,
                                   const StaticSignal& signal, const MeanCurve& mean);

/// Reused memory of the smoother: for a long record allocating it costs as much as filling it.
struct SmootherScratch {
  std::vector<double> steps;
};
/// Second moments of all states given the signal, as BlockMoments of the full state.
/// @param doubt  curves with independent standard normal coefficients: the uncertainty of the mean
[[nodiscard]] BlockMoments moment_pass(const SampleBlock& block, const StaticSignal& signal, const MeanCurve& mean,
                                       const std::vector<MeanCurve>& doubt, SmootherScratch& scratch);

/// e/sqrt(S), in the order of the values. Values outside the gate are not used, so that their neighbours do not look wrong.
[[nodiscard]] std::vector<double> whitening_pass(const SampleBlock& block, const StaticSignal& signal, const MeanCurve& mean,
                                                 double gate);

/// Smoothed outputs (rows times state) and their variances at every `stride`-th grid point.
struct SmoothedOutputs {
  std::vector<std::uint64_t> at;
  Eigen::MatrixXd mean;  ///< rows x points
  Eigen::MatrixXd variance;
};
[[nodiscard]] SmoothedOutputs smoothing_pass(const SampleBlock& block, const Eigen::MatrixXd& rows, const StaticSignal& signal,
                                             const MeanCurve& mean, std::size_t stride);

}  // namespace coast::noise
