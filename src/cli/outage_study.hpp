#pragma once
// `coast outage` in three steps: a study is run, in one of two ways, written as tables, and drawn.

#include <nlohmann/json.hpp>

#include "coast/report/page.hpp"
#include "study_config.hpp"
#include "study_journal.hpp"

namespace coast::cli {

/// What was run. Of the result's runs those of one truth stand together, one for each error model; floors come last.
struct OutageStudy {
  study::StudyResult result;
  std::size_t truths = 1;  ///< 1 of a recording
  std::size_t models = 1;
  std::string described;             ///< a sentence or two: from what, against what
  bool simulated = false;            ///< otherwise one recording
  std::uint64_t first_seed = 0;      ///< of simulated ones
  std::vector<geo::Psd> gyro_noise;  ///< of simulated ones: the largest white density of each run's gyros
  [[nodiscard]] bool is_floor(std::size_t run) const { return run >= truths * models; }
};

/// Two runs over the same outages whose errors are compared pair by pair.
struct StudyPair {
  const study::ModelRun* first;
  const study::ModelRun* second;
  bool floor = false;  ///< the second is a floor: less noise in its recordings, not another model of the same
};
/// Of each truth its first error model against every further one, then against every floor.
[[nodiscard]] std::vector<StudyPair> pairs_of(const OutageStudy& study);

/// Outages of one manoeuvre class among those of a group.
struct ManoeuvreDrift {
  study::Manoeuvre manoeuvre;
  std::vector<study::OutageResult> outages;
};
/// Classes that occur, in the order of study::Manoeuvre.
[[nodiscard]] std::vector<ManoeuvreDrift> by_manoeuvre(const std::vector<study::OutageResult>& outages);

[[nodiscard]] OutageStudy run_sweep(const SweepStudy& config, const OpenJournal& journal, const study::Progress& progress);
[[nodiscard]] OutageStudy run_seeds(const EnsembleStudy& config, const OpenJournal& journal, const study::Progress& progress);

/// outage.json
[[nodiscard]] nlohmann::ordered_json outage_json(const OutageStudy& study);
/// outages.csv: one line per outage and error model.
[[nodiscard]] std::string outages_csv(const OutageStudy& study);

// --- the page: page_study_durations.cpp, page_study_group.cpp

/// Over durations: drift, prediction, gain of the smoother; by manoeuvre.
void add_durations(const OutageStudy& study, report::Page& page);
/// Tiles, and a section for each group of outages and each truth.
void add_groups(const OutageStudy& study, report::Page& page);

}  // namespace coast::cli
