#include "coast/jobs/array_study.hpp"

#include <fmt/format.h>

#include "array_study/result.hpp"
#include "coast/io/results_folder.hpp"
#include "coast/io/writers.hpp"
#include "common/results.hpp"

namespace coast::jobs {

namespace {

std::vector<MergeCase> merge_cases(const ArrayStudyConfig& config, const std::function<void(double)>& progress) {
  const double all = static_cast<double>(config.counts.size() * config.motions.size());
  std::vector<MergeCase> cases;
  for (const std::size_t count : config.counts)
    for (const double motion : config.motions) {
      array::MergeStudyOptions options = config.merges;
      options.sensors.resize(count);
      options.motion_rms = motion;
      options.runs = config.runs;
      options.samples = config.samples;
      options.first_seed = config.first_seed;
      const auto done = static_cast<double>(cases.size());
      cases.push_back({count, motion, array::run_merge_study(options, [&](double share) { progress((done + share) / all); })});
    }
  return cases;
}

ArrayStudyResult run_study(const ArrayStudyConfig& config, const std::function<void(double)>& progress) {
  switch (config.kind) {
    case ArrayStudyKind::kModels:
      return noise::run_arma_garch_study(config.model, config.samples, config.runs, config.first_seed, progress, false);
    case ArrayStudyKind::kMerges:
      return merge_cases(config, progress);
    case ArrayStudyKind::kOutages:
      return study::run_array_outages(*config.outages, progress);
    case ArrayStudyKind::kDefects:
      break;
  }
  return array::run_defect_study(config.defects, config.injections, config.first_seed, progress);
}

}  // namespace

ArrayStudyResult array_study(const ArrayStudyConfig& config, const Progress& progress) {
  try {
    progress("simulating", 0.0);
    return run_study(config, [&progress](double share) { progress("simulating", share); });
  } catch (const std::invalid_argument& error) {
    throw config.root.error(error.what(), "a study that can be run");
  }
}

std::vector<std::string> files_of(const ArrayStudyConfig&) {
  return {"array_study.json", "report.json", "report.html"};
}

void write(const ArrayStudyConfig& config, const ArrayStudyResult& result, const std::filesystem::path& folder) {
  io::begin_results(folder / "array_study.json");
  write_page(array_study_page(config, result), folder);
  io::write_text(folder / "array_study.json", array_study_json(config, result));
}

std::string told(const ArrayStudyConfig&, const ArrayStudyResult&, const std::filesystem::path& folder) {
  return fmt::format("study: {}\n", (folder / "report.html").string());
}

}  // namespace coast::jobs
