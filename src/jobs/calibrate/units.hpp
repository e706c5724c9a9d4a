#pragma once
// Estimated parameters as on data sheets: densities as square roots, correlation times instead of rates.

#include <optional>
#include <string>
#include <string_view>

#include "coast/noise/calibration.hpp"

namespace coast::jobs {

/// Usual units of sensor errors.
struct SheetUnits {
  const char* white_noise;       ///< deg/sqrt(h) | m/s/sqrt(h)
  const char* signal;            ///< deg/h | ug
  const char* rate_random_walk;  ///< deg/h/sqrt(h) | ug/sqrt(s)
  const char* rate_ramp;         ///< deg/h/h | ug/h
  const char* integral;          ///< arcsec | m/s
};
[[nodiscard]] const SheetUnits& sheet_units(noise::Sensor sensor);
/// Converts an SI value to one of these units.
[[nodiscard]] double in_unit(double si, const char* unit);

/// A parameter of a model in its data sheet unit.
struct SheetValue {
  std::string name;  ///< "GM 1 correlation time"
  std::string unit;  ///< may be empty
  double value = 0.0;
  std::optional<double> lower;
  std::optional<double> upper;
  double relative_bound = 0.0;  ///< Cramer-Rao standard deviation of log(value); infinite: no information
};
/// @param i  parameter of the model  @param estimate  its value and interval in SI
[[nodiscard]] SheetValue sheet_value(const noise::SumModel& model, std::size_t i, noise::Sensor sensor,
                                     const noise::ParameterEstimate& estimate);
/// "(rad/s)^2/Hz" from "signal^2/Hz".
[[nodiscard]] std::string si_unit_of(std::string_view unit, noise::Sensor sensor);
/// "GM 1" for the first Gauss-Markov process among several, "WN" for the only white noise.
[[nodiscard]] std::string term_name(const noise::SumModel& model, std::size_t term);

}  // namespace coast::jobs
