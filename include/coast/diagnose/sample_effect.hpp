#pragma once
// Effects that leave their mark in the samples themselves: what a converter does to a signal.

#include <Eigen/Core>
#include <optional>
#include <string_view>
#include <vector>

#include "coast/diagnose/effect.hpp"

namespace coast::diagnose {

struct MissionInput;

/// One axis of a sensor as its converter delivered it: rates or specific forces.
struct AxisSeries {
  Eigen::ArrayXd values;         ///< sensor axis, rad/s or m/s^2
  double white_sd = 0.0;         ///< of a sample, by the error model
  bool rounding_stated = false;  ///< the error model knows of a rounding
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
  /// The parameter, where the samples bear the mark.
  std::optional<double> (*find)(const AxisSeries& series) = nullptr;
  /// The mission with what can be mended mended, and with noise for the rest.
  void (*model)(MissionInput& input, Site site, int axis, double parameter) = nullptr;
  /// Sd of an error that it may leave and that wanders: noise of the same axis that is no larger is a part of it. Null: none.
  double (*residue)(double parameter) = nullptr;
};

/// Every such effect. A new one is a file in src/diagnose/sample_effects and a line in sample_catalogue.cpp.
[[nodiscard]] const std::vector<SampleEffect>& sample_catalogue();

}  // namespace coast::diagnose
