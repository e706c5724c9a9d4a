#pragma once
// One scenario simulated with many seeds, each recording processed with several error models: paired outages with known truth.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "coast/simulate/scenario.hpp"
#include "coast/study/outage_runs.hpp"
#include "coast/study/study_result.hpp"

namespace coast::study {

/// Error model of a filter, and how its solution is smoothed.
struct NamedModel {
  std::string name;
  noise::ImuErrorModel model;
  std::optional<estimate::BatchOptions> batch = {};  ///< batch smoother; the whole mission is then solved for every outage
};

/// Sensors with the errors `truth`, and the error models of the filters, one run each.
struct EnsembleCase {
  NamedModel truth;
  std::vector<NamedModel> filters;
};

struct EnsemblePlan {
  simulate::Scenario scenario;  ///< its own error model and seed are not used
  std::uint64_t first_seed = 1;
  std::size_t seeds = 1;
  std::vector<OutageGroup> groups;  ///< each outage separately, in the scenario's time; empty: the scenario's own
  std::vector<EnsembleCase> cases;
};

/// Index of one outage of one error model on one recording in StudyResult.
struct StudyPlace {
  std::size_t run = 0;
  std::size_t group = 0;
  std::size_t outage = 0;  ///< within the group: start by start, within it seed by seed
};

/// Lets a study continue from stored results of an interrupted one, and stores its own.
struct StudyJournal {
  /// A stored result, without its `outage`; nothing if there is none.
  std::function<std::optional<OutageResult>(const StudyPlace&)> known;
  std::function<void(const StudyPlace&, const OutageResult&)> finished;  ///< called one at a time
};

/// Simulates and processes every seed of every case.
///
/// Seed k of two cases has the same motion, the same GNSS errors, and the same draw of each process at the same place in both
/// error models; the filters of one case process the same recording. A recording is processed as by `coast process`: alignment,
/// refined start and filter with GNSS positions and velocities; the start is refined with fixes before the first outage.
/// Outages branch off from that run (run_outages); errors are relative to the simulated truth. Runs on all threads; the result
/// is the same for any number of them. A thread holds one recording and its knots at a time, some 150 MB for 10 minutes with
/// GNSS at 10 Hz and 40 states. A recording is not simulated if all its outages are stored.
///
/// @param progress  fraction of the recordings; called one at a time
/// @throws InputError      an outage is not within the scenario, or begins before the filter
/// @throws NumericalError  a recording cannot be processed; names its seed
[[nodiscard]] StudyResult run_ensemble(const EnsemblePlan& plan, const std::function<void(double)>& progress = {},
                                       const StudyJournal& journal = {});

}  // namespace coast::study
