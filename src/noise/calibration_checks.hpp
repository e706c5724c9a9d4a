#pragma once
// What is asked of a record, and what is said of an estimate once it stands. Private to the room.

#include "coast/noise/calibration.hpp"

namespace coast::noise {

/// @throws NumericalError  too few samples (100), or all alike
void check_record(const StaticSignal& record);

[[nodiscard]] Whiteness whiteness_of(const std::vector<double>& standardised, int fitted_parameters);
/// Innovations beyond what one record in a hundred would show.
[[nodiscard]] std::vector<Outlier> outliers_of(const Likelihood& likelihood, const std::vector<double>& u);
/// @param curve  of the record that the estimate is from; level and drift of the model as in the record do not matter to it
[[nodiscard]] CurveBand band_of(const AllanCurve& curve, const SumModel& model, const std::vector<double>& u,
                                const StaticSignal& signal, double slope, const CalibrationOptions& options);
[[nodiscard]] std::vector<ParameterEstimate> parameters_of(const Likelihood& likelihood, const Fit& fit,
                                                           const Eigen::MatrixXd& covariance,
                                                           const CalibrationOptions& options);
[[nodiscard]] std::vector<Combination> combinations_of(const SumModel& model, const Eigen::MatrixXd& information);
[[nodiscard]] std::vector<std::string> remarks_of(const SumModel& model, const std::vector<ParameterEstimate>& parameters,
                                                  const Eigen::MatrixXd& covariance, double duration);

}  // namespace coast::noise
