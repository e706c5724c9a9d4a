#pragma once
// First steps of all jobs with the recordings of a run.

#include "coast/jobs/run_file.hpp"

namespace coast::jobs {

/// Reports what was understood, and the warnings, before everything else.
void tell_inspection(const Recordings& recordings, const Progress& progress);
/// If gravity has the wrong direction at rest, no result would be useful.
/// @throws NumericalError  axes that contradict gravity or the course, without `accept: true`
void refuse_wrong_axes(const RunConfig& config, const Recordings& recordings);
/// If the size of gravity or of turns is wrong by a unit, a search would explain the unit by many effects.
/// @throws NumericalError  likewise
void refuse_wrong_units(const RunConfig& config, const Recordings& recordings);
/// The setup of run.yaml plus data from the recordings: a given start in their week, and the begin of the first outage.
[[nodiscard]] study::Setup setup_of(const RunConfig& config, const Recordings& recordings,
                                    const std::optional<study::OutageSweep>& sweep);
/// Corrects the recordings and the setup for the effects in run.yaml; no change if there are none.
void take_out_effects(const RunConfig& config, Recordings& recordings, study::Setup& setup, const Progress& progress);

}  // namespace coast::jobs
