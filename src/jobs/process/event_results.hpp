#pragma once
// Events of the run file: their states in the delivered trajectory, and what is told of them.

#include <optional>
#include <string>
#include <vector>

#include "process/stages.hpp"

namespace coast::jobs {

/// Ready to take the epochs of the delivered trajectory; nothing if the configuration has no events.
/// @param time_offset_s  of the fixes: what GNSS times as t is at t - time_offset_s on the clock of the trajectory
[[nodiscard]] std::optional<study::MarkedStates> marked_states(const Work& work, double time_offset_s);

/// Sets result.marked. Events without a state, names that geo.txt cannot tell, and a delay against the stated positions become
/// entries of result.events.
void note_events(const Work& work, const study::MarkedStates& marked, ProcessResult& result);

/// Largest standard deviations among events.
struct WorstSigmas {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< N, E, D, m
  Eigen::Vector3d attitude = Eigen::Vector3d::Zero();  ///< roll, pitch, yaw, rad
  std::string id;                                      ///< the event whose position is least certain
};
[[nodiscard]] WorstSigmas worst_sigmas(const std::vector<record::MarkedState>& states);

/// The lines at the end of a run on the terminal.
/// @param told  events of the run; those of note_events() are among them
[[nodiscard]] std::string events_text(const EventResults& marked, const record::Events& told);

}  // namespace coast::jobs
