#pragma once
// What each way of merging reaches with sensors whose errors are known, and how far residuals against the mean mislead about
// them.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "coast/array/synthetic.hpp"

namespace coast::array {

/// One channel of several sensors that err by ARMA-GARCH processes of their own, and by scale where there is motion.
struct MergeStudyOptions {
  std::vector<noise::ArmaGarch> sensors;  ///< truth, mean zero; two or more
  double dt = 0.01;                       ///< s
  std::size_t samples = 20000;
  std::size_t runs = 100;
  std::uint64_t first_seed = 1;  ///< run r is drawn with first_seed + r
  double motion_rms = 0.0;       ///< of what all sensors feel: a slow and a fast sine, [signal]
  double scale_sd = 0.0;         ///< constant scale errors, drawn for each sensor and run
  noise::ArmaGarchOrders orders{3, 2, 1, 1};
};

/// Mean square error of one way of merging, run by run.
struct MergeResult {
  std::string name;
  std::vector<double> mse;  ///< [signal]^2

  [[nodiscard]] double mean() const;
};

/// One sensor's model from its residuals against the mean, beside that from its own errors; means over the runs.
struct ResidualModel {
  double own_sd_ratio = 0.0;     ///< innovation standard deviation, solved for the sensor's own, over the truth's
  double autocorrelation = 0.0;  ///< of neighbouring samples, by the model from residuals
  double persistence = 0.0;      ///< gamma + delta, likewise
  double true_autocorrelation = 0.0;
  double true_persistence = 0.0;
  double removed = 0.0;            ///< share of the true error's variance that the prediction from residuals takes off
  double removed_by_errors = 0.0;  ///< the same with model and prediction from the errors themselves
};

struct MergeStudy {
  /// single 1, 2, ..; mean; weighted; garch; corrected (by residuals); corrected by errors (as the paper did, with a
  /// reference); oracle weights (the true variances); oracle (true variances and predictions)
  std::vector<MergeResult> merges;
  std::vector<ResidualModel> residual_models;  ///< by sensor
  /// Of the first run, for figures: errors of each sensor, of the mean, of what was corrected by residuals and by errors.
  std::vector<std::vector<double>> first_errors;
  /// Of sensor 1 in the first run, sample by sample: its errors less what the model of its errors predicts, and their standard
  /// deviation, true and as that model predicts it.
  std::vector<double> first_residuals, first_sd, first_predicted_sd;
};

/// In parallel; the same bytes on any number of threads.
/// @throws std::invalid_argument  fewer than two sensors, no runs, too few samples
[[nodiscard]] MergeStudy run_merge_study(const MergeStudyOptions& options, const std::function<void(double)>& progress = {});

}  // namespace coast::array
