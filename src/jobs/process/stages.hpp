#pragma once
// The stages of `coast process`, in the order of process(): functions of the prepared data, each of which sets its part
// of the result.

#include <optional>
#include <vector>

#include "coast/jobs/process.hpp"
#include "coast/study/outage_runs.hpp"
#include "process/state_tracks.hpp"

namespace coast::jobs {

/// Input of all stages.
struct Work {
  const RunConfig& config;
  study::PreparedMission& mission;  ///< backward passes temporarily reverse its recordings
  const std::optional<record::Trajectory>& reference;
  std::vector<study::Outage> outages;  ///< withheld from the delivered trajectory
  estimate::KnotSampling sampling;     ///< of the knots that are stored
  const Progress& progress;
  const std::optional<record::TimeMarkRecording>& marks;

  [[nodiscard]] geo::GpsTime start() const { return mission.start().nav.t; }
  /// Options of the filter, with the outages withheld.
  [[nodiscard]] estimate::FilterOptions options() const;
};

/// Outages of the configuration. @throws InputError  one begins outside of the mission
[[nodiscard]] std::vector<study::Outage> outages_of(const RunConfig& config, geo::GpsTime start, geo::GpsTime end);

// --- describe.cpp

[[nodiscard]] ProcessResult what_was_read(const Recordings& recordings);
/// Properties of the prepared mission: span, start, epochs by quality, fitted noise, adaptations.
void describe_mission(const Work& work, ProcessResult& result);
/// The projection of the run file: chosen for the place of the mission, told, and noted in the resolved file.
/// @throws InputError  no transformation can be used there
void describe_projection(const Work& work, ProcessResult& result);

// --- solve.cpp

/// Results that earlier passes provide for the last one.
struct EarlierPasses {
  std::optional<estimate::FilterState> carried;     ///< start, if there are several passes
  std::optional<estimate::BackwardKnots> backward;  ///< for a combined solution
};
[[nodiscard]] EarlierPasses earlier_passes(const Work& work, const estimate::FilterOptions& options);

/// The run without withheld data, if outages are studied without a reference; otherwise empty.
[[nodiscard]] study::GapFreeReference solve_without_outages(const Work& work);

/// Results available with the delivered solution.
struct Delivery {
  study::Solution solution;
  std::vector<KnotState> forward_knots;
  std::vector<Check> motion;                  ///< checks of speed and tilt
  study::GapFreeReference gap_free;           ///< of this solution, if a sweep needs one
  std::optional<study::MarkedStates> marked;  ///< if the configuration has events
};
/// Solves the mission; its epochs go to the sinks, to the curves of the page and to the comparisons, all concurrently with the
/// filter.
/// @param gap_free  reference for outages, if there is no other reference
[[nodiscard]] Delivery deliver(const Work& work, const EarlierPasses& passes, const study::GapFreeReference& gap_free,
                               const TrajectorySinks& sinks, ProcessResult& result);

// --- findings.cpp

/// Counts, NIS and smallest error detectable by the gate.
void count_innovations(const Work& work, ProcessResult& result);
void count_aids(const Work& work, ProcessResult& result);
/// Suggests sigmas if the stated ones do not fit.
void offer_gnss_noise(const Work& work, ProcessResult& result);
/// Whether the recording contradicts the stated lever arm.
void doubt_lever_arm(const Work& work, ProcessResult& result);
/// Each outage of the sweep separately.
void study_sweep(const Work& work, const Delivery& delivery, const EarlierPasses& passes, ProcessResult& result);
[[nodiscard]] std::vector<Separation> separate_forward_and_backward(const Work& work, const Delivery& delivery, bool carried);
/// Biases and lever arm in the last state of the filter.
void note_last_state(const Work& work, const Delivery& delivery, ProcessResult& result);
/// Adds the estimates to the resolved file as comments, ready to be used in another run.
void note_estimates(const Work& work, const ProcessResult& result);

}  // namespace coast::jobs
