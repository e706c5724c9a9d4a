#pragma once
// Parts of find_changes.

#include <vector>

#include "coast/fleet/changes.hpp"
#include "coast/fleet/student.hpp"
#include "panel_test.hpp"

namespace coast::fleet {

using LeftOut = std::vector<std::vector<bool>>;  ///< of a panel: by series and estimate

/// Scatter between missions at which robust residuals have variance 1.
[[nodiscard]] Scatter robust_scatter(const Panel& panel, const std::vector<Change>& changes, const LeftOut& left_out);

/// Marks the missions that depart, and gives every comparison.
/// @param left_out  of each panel, written
[[nodiscard]] std::vector<Departure> find_departures(const Fleet& fleet, const std::vector<PanelChanges>& panels, double level,
                                                     std::vector<LeftOut>& left_out, Tails& tails);

}  // namespace coast::fleet
