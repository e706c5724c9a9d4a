#pragma once
// The page of `coast outage`: page_study_sweep.cpp for a recording, page_ensemble.cpp for simulated ones.

#include <string>
#include <vector>

#include "coast/report/page.hpp"
#include "study_config.hpp"

namespace coast::cli {

/// Drift against duration of one error model over the outages of a recording.  @param number from 1, for its id
[[nodiscard]] report::Section sweep_section(const std::string& model, const std::vector<study::OutageResult>& results,
                                            std::size_t number);

/// Two runs over the same seeds whose errors are compared pair by pair.
struct EnsemblePair {
  const study::EnsembleRun* first;
  const study::EnsembleRun* second;
  bool floor = false;  ///< the second is a floor: less noise in its recordings, not another model of the same
};
/// Of each truth its first error model against every further one, then against every floor.
[[nodiscard]] std::vector<EnsemblePair> pairs_of(const EnsembleStudy& study, const study::EnsembleResult& result);

/// White gyro noise of a run's truth alone, closed form, m per horizontal axis.
[[nodiscard]] double gyro_noise_drift_of(const EnsembleStudy& study, const study::EnsembleRun& run, double duration_s);

/// Tiles, and one section per outage and truth: tables, distribution over the seeds, the first seed's N, E, D.
void add_ensemble(const EnsembleStudy& study, const study::EnsembleResult& result, report::Page& page);

}  // namespace coast::cli
