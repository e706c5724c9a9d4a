#pragma once
// Effects that can be detected in the samples themselves, such as those of an analogue-to-digital converter.

#include <Eigen/Core>
#include <optional>
#include <string_view>
#include <vector>

#include "coast/diagnose/effect.hpp"

namespace coast::diagnose {

struct MissionInput;

/// One axis of a sensor as output by its converter: rates or specific forces.
struct AxisSeries {
  Eigen::ArrayXd values;         ///< sensor axis, rad/s or m/s^2
  double white_sd = 0.0;         ///< of a sample, by the error model
  bool rounding_stated = false;  ///< the error model contains a rounding
};
[[nodiscard]] AxisSeries axis_series(const MissionInput& input, Site site, int axis);

struct SampleEffect {
  std::string_view name{};
  Site site = Site::kGyro;
  std::string_view parameter{};
  std::string_view unit{};
  std::string_view equation{};
  std::string_view meaning{};
  std::string_view separating_manoeuvre{};
  std::string_view source{};
  /// The parameter, if the effect is detected in the samples.
  std::optional<double> (*find)(const AxisSeries& series) = nullptr;
  /// Corrects the mission as far as possible, and adds noise for the rest.
  void (*model)(MissionInput& input, Site site, int axis, double parameter) = nullptr;
  /// Sd of a possible remaining slowly varying error: detected noise of the same axis that is not larger is attributed to it.
  /// Null: none.
  double (*residue)(double parameter) = nullptr;
};

/// Every such effect. A new one is a file in src/diagnose/sample_effects and a line in sample_catalogue.cpp.
[[nodiscard]] const std::vector<SampleEffect>& sample_catalogue();

}  // namespace coast::diagnose
