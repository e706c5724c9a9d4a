#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "coast/io/writers.hpp"
#include "coast/record/error.hpp"
#include "coast/report/render.hpp"
#include "commands.hpp"
#include "drift.hpp"
#include "load.hpp"
#include "outage_page.hpp"
#include "progress.hpp"
#include "study_config.hpp"

namespace coast::cli {

namespace {

using Json = nlohmann::ordered_json;

std::vector<study::OutageResult> run_model(const SweepStudy& config, const study::NamedModel& model,
                                           const study::Progress& progress) {
  Recordings recordings = load(config.run);
  study::Setup setup = setup_of(config.run, recordings, config.sweep);
  setup.model = model.model;
  const study::PreparedMission mission(std::move(recordings.imu), std::move(recordings.gnss), std::move(setup), progress);
  study::GapFreeReference gap_free;
  study::SolutionOutputs outputs;
  outputs.smoothed = [&](const record::TrajectoryEpoch& epoch) { gap_free.add(epoch); };
  const study::Solution solution = study::solve(mission, mission.options(), true, outputs, progress);
  const record::Trajectory& truth = recordings.reference ? *recordings.reference : gap_free.trajectory();
  const Eigen::Vector3d arm = recordings.reference ? config.run.reference_lever_arm_b : Eigen::Vector3d::Zero();
  const auto outages = study::outages_of(config.sweep, mission.start().nav.t, mission.mission().imu.samples.back().t);
  if (outages.empty())
    throw InputError({config.run.file.string(), 0, "no outage of the sweep fits into the mission",
                      "durations of at most a quarter of it", "Shorten durations_s or first_s."});
  return study::run_outages(mission.mission(), mission.model(), mission.options(), solution.knots, truth, arm, outages, 60.0,
                            [&](double fraction) {
                              if (progress) progress(("outages with " + model.name).c_str(), fraction);
                            });
}

Json model_json(const study::NamedModel& model, const std::vector<study::OutageResult>& results) {
  Json j;
  j["error_model"] = model.name;
  for (const DriftRow& row : drift_table(results))
    j["drift"].push_back({{"duration_s", row.duration_s},
                          {"outages", row.outages},
                          {"forward", drift_json(row.forward)},
                          {"smoothed", drift_json(row.smoothed)},
                          {"smoothed_share_inside_95", row.inside_95}});
  return j;
}

std::vector<study::OutageResult> of_duration(const std::vector<study::OutageResult>& results, double duration_s) {
  std::vector<study::OutageResult> chosen;
  for (const study::OutageResult& result : results)
    if (result.outage.duration_s == duration_s) chosen.push_back(result);
  return chosen;
}

Json paired_json(const study::PairedRatio& paired) {
  return {{"pairs", paired.pairs},
          {"ratio", paired.ratio},
          {"interval_95", {paired.low, paired.high}},
          {"second_smaller", paired.second_smaller},
          {"sign_test", paired.sign_test}};
}

void outage_sweep(const SweepStudy& config, Json& j, report::Page& page, const study::Progress& progress) {
  std::vector<std::vector<study::OutageResult>> results;
  for (const study::NamedModel& model : config.models) {
    results.push_back(run_model(config, model, progress));
    j["models"].push_back(model_json(model, results.back()));
    page.sections.push_back(sweep_section(model.name, results.back(), results.size()));
  }
  for (std::size_t i = 1; i < results.size(); ++i)
    for (const DriftRow& row : drift_table(results.front()))
      for (const bool smoothed : {false, true}) {
        const auto drift = [&](std::size_t model) {
          return study::drifts(of_duration(results[model], row.duration_s), study::DriftMeasure::kHorizontal, smoothed);
        };
        Json pair = {{"first", config.models.front().name},
                     {"second", config.models[i].name},
                     {"duration_s", row.duration_s},
                     {"solution", smoothed ? "smoothed" : "forward"}};
        pair.update(paired_json(study::paired_ratio(drift(0), drift(i))));
        j["paired"].push_back(pair);
      }
}

const char* name_of(study::DriftMeasure measure) {
  constexpr std::array kNames{"n", "e", "d", "horizontal"};
  return kNames[static_cast<std::size_t>(measure)];
}
constexpr std::array kMeasures{study::DriftMeasure::kNorth, study::DriftMeasure::kEast, study::DriftMeasure::kDown,
                               study::DriftMeasure::kHorizontal};

Json spread_json(const study::Spread& spread) {
  return {{"median_m", spread.median}, {"rms_m", spread.rms}, {"p95_m", spread.p95}};
}

Json solution_json(const std::vector<study::OutageResult>& seeds, bool smoothed) {
  const study::EnsembleDrift drift = study::ensemble_drift(seeds, smoothed);
  Json j;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string name = name_of(kMeasures[axis]);
    j["largest"][name] = spread_json(drift.largest[axis]);
    j["end"][name] = spread_json(drift.end[axis]);
    j["end"][name]["predicted_rms_m"] = drift.predicted_end_rms_m(static_cast<Eigen::Index>(axis));
  }
  j["largest"]["horizontal"] = spread_json(drift.horizontal);
  j["share_inside_95"] = drift.inside_95;
  for (const study::DriftMeasure measure : kMeasures)
    j["largest_by_seed_m"][name_of(measure)] = study::drifts(seeds, measure, smoothed);
  return j;
}

Json paired_runs(const std::vector<EnsemblePair>& pairs, std::size_t outage) {
  Json j;
  for (const EnsemblePair& pair : pairs)
    for (const bool smoothed : {false, true}) {
      Json entry = {{"truth", pair.first->truth},
                    {"first", pair.first->filter},
                    {"second", pair.second->filter},
                    {"solution", smoothed ? "smoothed" : "forward"}};
      for (const study::DriftMeasure measure : kMeasures)
        entry[name_of(measure)] =
            paired_json(study::paired_ratio(study::drifts(pair.first->outages[outage], measure, smoothed),
                                            study::drifts(pair.second->outages[outage], measure, smoothed)));
      j.push_back(entry);
    }
  return j;
}

Json ensemble_json(const EnsembleStudy& config, const study::EnsembleResult& result) {
  Json j;
  j["simulated"] = {{"scenario", config.scenario.filename().string()},
                    {"seeds", {{"first", config.plan.first_seed}, {"count", config.plan.seeds}}}};
  for (std::size_t i = 0; i < result.outages.size(); ++i) {
    Json outage = {{"start_s", result.outages[i].start_s}, {"duration_s", result.outages[i].duration_s}};
    for (const study::EnsembleRun& run : result.runs)
      outage["runs"].push_back({{"truth", run.truth},
                                {"error_model", run.filter},
                                {"gyro_noise_alone_m", gyro_noise_drift_of(config, run, result.outages[i].duration_s)},
                                {"forward", solution_json(run.outages[i], false)},
                                {"smoothed", solution_json(run.outages[i], true)}});
    outage["paired"] = paired_runs(pairs_of(config, result), i);
    j["outages"].push_back(outage);
  }
  return j;
}

void ensemble(const EnsembleStudy& config, Json& j, report::Page& page, const study::Progress& progress) {
  const study::EnsembleResult result =
      study::run_ensemble(config.plan, [&](double fraction) { progress("simulating and processing seeds", fraction); });
  j = ensemble_json(config, result);
  add_ensemble(config, result, page);
}

}  // namespace

void outage(const std::filesystem::path& study_yaml, const CommonOptions& options) {
  ProgressLine line(options.quiet);
  const study::Progress progress = [&line](const char* what, double fraction) { line.show(what, fraction); };
  const StudyConfig config = read_study(study_yaml);
  const std::filesystem::path out = output_folder(study_yaml, options.out);

  Json j;
  report::Page page;
  page.title = "Outage study";
  page.subtitle = study_yaml.filename().string();
  if (const auto* sweep = std::get_if<SweepStudy>(&config))
    outage_sweep(*sweep, j, page, progress);
  else
    ensemble(std::get<EnsembleStudy>(config), j, page, progress);
  line.clear();
  io::write_text(out / "outage.json", j.dump(1) + "\n");
  io::write_text(out / "report.json", report::to_json(page));
  io::write_text(out / "report.html", report::render(page));
  if (!options.quiet) fmt::print("report: {}\n", (out / "report.html").string());
}

}  // namespace coast::cli
