#pragma once
// What changed in a fleet, and when: steps, drifts, what several units share, and missions that depart, with a stated
// probability of any false alarm over all units and figures.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coast/fleet/estimates.hpp"
#include "coast/fleet/random_effects.hpp"

namespace coast::fleet {

struct ChangeOptions {
  double false_alarm_probability = 0.05;  ///< of the whole fleet; half for changes, half for missions that depart
  int simulations = 999;                  ///< fleets without changes that are drawn for the threshold
  std::uint64_t seed = 1;
};

enum class ChangeKind {
  kStep,        ///< from a date on
  kDrift,       ///< in proportion to time
  kGroupLevel,  ///< while a grouping factor has one level
};

/// A change of one figure, in one unit or in several at once.
struct Change {
  ChangeKind kind = ChangeKind::kStep;
  bool shared = false;             ///< found in the sum over all units
  std::vector<std::size_t> units;  ///< indices into Panel::series
  double t = 0.0;                  ///< of a step: years; between the last mission before it and the first after it
  std::pair<double, double> t_95;  ///< of a step
  std::size_t factor = 0;          ///< of a group level: index into Fleet::factors
  std::string level;
  double statistic = 0.0;    ///< likelihood-ratio scale: chi-square with one degree of freedom at a date known beforehand
  double p = 1.0;            ///< share of fleets without changes that show any larger statistic anywhere
  std::vector<double> size;  ///< one per unit: [value], of a drift [value]/year
  std::vector<double> size_sd;
  double common_size = 0.0;  ///< weighted mean of the units'
  double common_sd = 0.0;
};

/// One estimate against what all others of its unit say.
struct Departure {
  std::size_t panel = 0;
  std::size_t series = 0;
  std::size_t index = 0;  ///< into Series::estimates
  double expected = 0.0;
  double standardised = 0.0;  ///< difference over its sigma, the scatter between missions included
  double p = 1.0;             ///< of this estimate alone, by the tails of the whole fleet
  bool outlier = false;       ///< after Holm's correction over all estimates; left out of what is pooled
};

struct PanelChanges {
  Scatter scatter;
  double walk_gain = 0.0;  ///< log-likelihood that a random walk gains over none, with the same changes; > 0 where it is used
  std::vector<Change> changes;
};

struct FleetChanges {
  std::vector<PanelChanges> panels;   ///< as Fleet::panels
  std::vector<Departure> departures;  ///< of every estimate that can be compared, most improbable first
  double threshold = 0.0;             ///< of Change::statistic
  double tails_nu = 0.0;              ///< degrees of freedom of the scatter's tails; infinity: normal
};

/// Columns of one unit's design: constant, temperature (where every mission has one, there are six or more, and they differ),
/// changes. Estimates that `left_out` marks have no row.
struct Design {
  Observations observations;
  std::vector<std::size_t> rows;                        ///< index into Series::estimates of each row
  std::optional<Eigen::Index> temperature;              ///< column
  double mean_temperature = 0.0;                        ///< at which the constant holds
  std::vector<std::optional<Eigen::Index>> of_changes;  ///< column of each change; empty where the unit has no part in it
};
[[nodiscard]] Design design_of(const Series& series, std::size_t index, const std::vector<Change>& changes,
                               const std::vector<bool>& left_out = {});

/// Factor on all sigmas of a panel, those of the missions and of the scatter, that its robust residuals ask for; 1 where there
/// is scatter, below 1 where missions state too large sigmas.
[[nodiscard]] double robust_scale(const Panel& panel, const PanelChanges& model,
                                  const std::vector<std::vector<bool>>& left_out);

/// Looks for changes and for missions that depart.
///
/// For each unit every date between two missions (three on either side) and a drift, for all units together every date, a
/// drift and every level of a grouping factor are tested by robust scores on residuals of constant and temperature.
/// The threshold is the quantile of the largest statistic over fleets that are drawn without changes, with the missions,
/// sigmas and temperatures of this one, and tails as heavy as its residuals allow. Found changes become part of the model;
/// one is dropped again where others explain it.
/// @param progress  fraction that is done; may be empty
[[nodiscard]] FleetChanges find_changes(const Fleet& fleet, const ChangeOptions& options,
                                        const std::function<void(double)>& progress = {});

}  // namespace coast::fleet
