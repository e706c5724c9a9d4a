#pragma once
// Computes many outages of one mission at the cost of few runs.

#include <functional>
#include <vector>

#include "coast/study/outage.hpp"
#include "coast/study/solution.hpp"

namespace coast::study {

/// Reference for the errors.
struct Truth {
  const record::Trajectory& trajectory;
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();  ///< from the IMU to the reference's point, body axes, m
};

/// Receives each result as soon as it is available, with the index of its outage; called one at a time.
using OutageSink = std::function<void(std::size_t index, const OutageResult& result)>;

/// Knots of the forward pass without outages, from which outages branch off.
[[nodiscard]] estimate::KnotStore gap_free_knots(const PreparedMission& mission, const Progress& progress);

/// Runs every outage separately. The filter continues from the last knot of the gap-free run before the outage to a knot
/// `kSettle` after it; there the smoother begins with the information of the gap-free run on all later data (estimate::Future)
/// and runs back to where the filter began. Equal to a run of the whole mission with the fixes withheld, except for the
/// linearisation point of the later data. Tightly coupled missions, whose ambiguities differ from run to run, filter and smooth
/// `kTightTail` beyond the outage instead. Smoothed by the backward recursion, whatever smoother the setup uses. Runs on all
/// threads; the result is the same for any number of them.
/// @param knots  gap_free_knots() of the mission
/// @return  in the order of the outages
std::vector<OutageResult> run_outages(const PreparedMission& mission, const estimate::KnotStore& knots, const Truth& truth,
                                      const std::vector<Outage>& outages, const OutageSink& sink = {});
inline constexpr double kSettle = 10.0;     ///< s
inline constexpr double kTightTail = 60.0;  ///< s

/// One outage by a run of the whole mission without its fixes, with the smoother of the setup.
[[nodiscard]] OutageResult run_outage_whole(const PreparedMission& mission, const Truth& truth, const Outage& outage);

}  // namespace coast::study
