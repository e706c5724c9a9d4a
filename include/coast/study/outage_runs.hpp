#pragma once
// Many outages of one mission for the price of few runs.

#include <functional>
#include <vector>

#include "coast/study/outage.hpp"
#include "coast/study/solution.hpp"

namespace coast::study {

/// What errors are measured against.
struct Truth {
  const record::Trajectory& trajectory;
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();  ///< from the IMU to its point, body axes, m
};

/// Takes a result as soon as it is there, with the place of its outage; called one at a time.
using OutageSink = std::function<void(std::size_t index, const OutageResult& result)>;

/// The forward pass without gaps that outages branch off from.
[[nodiscard]] estimate::KnotStore gap_free_knots(const PreparedMission& mission, const Progress& progress);

/// Runs every outage by itself. The filter goes on from the last knot of the gap-free run before the outage to a knot `kSettle`
/// after it; there the smoother begins with what the gap-free run knows of all that follows (estimate::Future) and comes back
/// to where the filter began. Equal to a run of the whole mission with the fixes withheld, but for what the linearisation of
/// the future changes with the state it is about. Tightly coupled missions, whose ambiguities differ from run to run, filter
/// and smooth `kTightTail` beyond the outage instead. Smoothed by the backward recursion whatever the setup delivers. On all
/// threads; the same numbers for any number of them.
/// @param knots  gap_free_knots() of the mission
/// @return  in the order of the outages
std::vector<OutageResult> run_outages(const PreparedMission& mission, const estimate::KnotStore& knots, const Truth& truth,
                                      const std::vector<Outage>& outages, const OutageSink& sink = {});
inline constexpr double kSettle = 10.0;     ///< s
inline constexpr double kTightTail = 60.0;  ///< s

/// One outage by a run of the whole mission that never has its fixes, smoothed as the setup says.
[[nodiscard]] OutageResult run_outage_whole(const PreparedMission& mission, const Truth& truth, const Outage& outage);

}  // namespace coast::study
