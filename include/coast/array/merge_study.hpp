#pragma once
// Accuracy of each merging method for sensors with known errors, and the bias of models estimated from residuals to the mean.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "coast/array/synthetic.hpp"

namespace coast::array {

/// One channel of several sensors, each with its own ARMA-GARCH error and, with motion, a scale error.
struct MergeStudyOptions {
  std::vector<noise::ArmaGarch> sensors;  ///< truth, mean zero; two or more
  double dt = 0.01;                       ///< s
  std::size_t samples = 20000;
  std::size_t runs = 100;
  std::uint64_t first_seed = 1;  ///< run r is drawn with first_seed + r
  double motion_rms = 0.0;       ///< of the common signal: a slow and a fast sine, [signal]
  double scale_sd = 0.0;         ///< constant scale errors, drawn for each sensor and run
  noise::ArmaGarchOrders orders{3, 2, 1, 1};
};

/// Mean square error of one merging method, run by run.
struct MergeResult {
  std::string name;
  std::vector<double> mse;  ///< [signal]^2

  [[nodiscard]] double mean() const;
};

/// Model of one sensor from its residuals to the mean, compared with that from its own errors; means over the runs.
struct ResidualModel {
  double own_sd_ratio = 0.0;     ///< innovation standard deviation, solved for the sensor's own, over the true one
  double autocorrelation = 0.0;  ///< of neighbouring samples, from the residual model
  double persistence = 0.0;      ///< gamma + delta, likewise
  double true_autocorrelation = 0.0;
  double true_persistence = 0.0;
  double removed = 0.0;            ///< share of the true error's variance removed by the prediction from residuals
  double removed_by_errors = 0.0;  ///< the same with model and prediction from the errors themselves
};

struct MergeStudy {
  /// single 1, 2, ..; mean; weighted; garch; corrected (by residuals); corrected by errors (as the paper did, with a
  /// reference); oracle weights (the true variances); oracle (true variances and predictions)
  std::vector<MergeResult> merges;
  std::vector<ResidualModel> residual_models;  ///< by sensor
  /// First run, for figures: errors of each sensor, of the mean, and of the merges corrected by residuals and by errors.
  std::vector<std::vector<double>> first_errors;
  /// Sensor 1 in the first run, sample by sample: its errors minus their prediction by the model of its errors, and their
  /// standard deviation, true and predicted by that model.
  std::vector<double> first_residuals, first_sd, first_predicted_sd;
};

/// Runs in parallel; the result is bitwise the same for any number of threads.
/// @throws std::invalid_argument  fewer than two sensors, no runs, too few samples
[[nodiscard]] MergeStudy run_merge_study(const MergeStudyOptions& options, const std::function<void(double)>& progress = {});

}  // namespace coast::array
