#pragma once
// Checks of a record before, and of an estimate after, the estimation. Private to the room.

#include "coast/noise/calibration.hpp"

namespace coast::noise {

/// @throws NumericalError  too few samples (100), or all equal
void check_record(const StaticSignal& record);

[[nodiscard]] Whiteness whiteness_of(const std::vector<double>& standardised, int fitted_parameters);
/// Innovations larger than expected in one of a hundred records.
[[nodiscard]] std::vector<Outlier> outliers_of(const Likelihood& likelihood, const std::vector<double>& u);
/// @param curve  of the record used for the estimate; the model's level and drift as in the record do not affect it
[[nodiscard]] CurveBand band_of(const AllanCurve& curve, const SumModel& model, const std::vector<double>& u,
                                const StaticSignal& signal, double slope, const CalibrationOptions& options);
[[nodiscard]] std::vector<ParameterEstimate> parameters_of(const Likelihood& likelihood, const Fit& fit,
                                                           const Eigen::MatrixXd& covariance,
                                                           const CalibrationOptions& options);
[[nodiscard]] std::vector<Combination> combinations_of(const SumModel& model, const Eigen::MatrixXd& information);
[[nodiscard]] std::vector<std::string> remarks_of(const SumModel& model, const std::vector<ParameterEstimate>& parameters,
                                                  const Eigen::MatrixXd& covariance, double duration);

}  // namespace coast::noise
