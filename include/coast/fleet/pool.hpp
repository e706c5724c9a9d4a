#pragma once
// What many missions say together: of one unit, and of all units.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coast/fleet/changes.hpp"

namespace coast::fleet {

/// A dependence that was fitted together with all others of the unit.
struct Slope {
  double value = 0.0;
  double sd = 0.0;
  double likelihood_ratio = 0.0;  ///< twice the log-likelihood that it gains, scatter known from the whole panel
  bool supported = false;         ///< at 5 %, after Holm's correction over the units
};

struct PooledUnit {
  int missions = 0;  ///< that were used
  int left_out = 0;
  double value = 0.0;  ///< after all steps, at the date of the last mission, at the mean temperature
  double sd = 0.0;     ///< Hartung and Knapp's
  std::pair<double, double> value_95;
  double tau = 0.0;                                 ///< scatter between missions, restricted likelihood
  std::optional<std::pair<double, double>> tau_95;  ///< empty where there is no scatter to be seen
  double shrunk = 0.0;                              ///< best prediction of the unit's value, given also those of the others
  double shrunk_sd = 0.0;
  std::optional<Slope> temperature;  ///< 1/K
  double mean_temperature = 0.0;     ///< deg C, where `temperature` is
  std::optional<Slope> drift;        ///< 1/year; besides changes that were found, in which case it is that of the change
};

struct PooledPanel {
  std::vector<PooledUnit> units;  ///< as Panel::series
  /// Over units, from three on: mean and scatter between them, by restricted likelihood.
  struct Mean {
    double value = 0.0;
    double sd = 0.0;
    std::pair<double, double> value_95;
    double between = 0.0;
    std::pair<double, double> between_95;
  };
  std::optional<Mean> mean;
};

/// @param left_out  missions that depart, by series and estimate
[[nodiscard]] PooledPanel pool(const Panel& panel, const PanelChanges& changes, const std::vector<std::vector<bool>>& left_out);

}  // namespace coast::fleet
