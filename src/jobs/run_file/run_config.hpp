#pragma once
// Parts of run.yaml also used by a study.

#include "coast/jobs/run_file.hpp"

namespace coast::jobs {

/// Keys `every_s`, `first_s`, `durations_s` of a swept study; for a run, `satellites` too.
[[nodiscard]] study::OutageSweep sweep_from(const config::Node& node);
[[nodiscard]] study::OutageSweep sweep_from(const config::Node& node, const RunConfig& run);

}  // namespace coast::jobs
