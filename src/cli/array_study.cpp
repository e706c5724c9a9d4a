// coast synth study.yaml: simulated arrays with known truth.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "array_study_config.hpp"
#include "coast/io/results_folder.hpp"
#include "coast/io/writers.hpp"
#include "coast/noise/arma_garch_study.hpp"
#include "coast/report/panels.hpp"
#include "coast/report/render.hpp"
#include "coast/study/drift.hpp"
#include "coast/study/paired.hpp"
#include "commands.hpp"
#include "load.hpp"
#include "page_parts.hpp"
#include "progress.hpp"

namespace coast::cli {

namespace {

using Json = nlohmann::ordered_json;
using Progress = std::function<void(double)>;

/// What one kind of study ends in: its part of the JSON, and its section of the page.
struct StudyPart {
  Json json;
  report::Section section;
};

StudyPart study_models(const ArrayStudyConfig& config, const Progress& progress) {
  const noise::ArmaGarchStudy study =
      noise::run_arma_garch_study(config.model, config.samples, config.runs, config.first_seed, progress, false);
  StudyPart part;
  part.section = {"models", "Intervals of ARMA-GARCH estimates", "", {}, {}, {}};
  part.section.lead = fmt::format("{} series of {} samples: 95 % intervals hold the truth in {} % of all; median time {} s.",
                                  study.runs, config.samples, percent(study.pooled_coverage), number(study.median_seconds));
  report::Table table{"parameters", "Parameters", "", {}, {}};
  table.columns = {{"parameter", "", false}, {"truth", ""}, {"bias", ""}, {"spread", ""}, {"stated", ""}, {"held", "%"}};
  Json parameters = Json::array();
  for (const noise::ArmaGarchParameterSummary& p : study.parameters) {
    parameters.push_back({{"name", p.name},
                          {"truth", p.truth},
                          {"bias", p.bias},
                          {"sd", p.sd},
                          {"mean_stated_sd", p.mean_se},
                          {"coverage", p.coverage}});
    table.rows.push_back(
        cells({p.name, number(p.truth), number(p.bias), number(p.sd), number(p.mean_se), percent(p.coverage)}));
  }
  part.section.tables.push_back(std::move(table));
  part.json = {{"runs", study.runs},
               {"pooled_coverage", study.pooled_coverage},
               {"not_converged", study.not_converged},
               {"without_uncertainty", study.without_uncertainty},
               {"median_seconds", study.median_seconds},
               {"parameters", parameters}};
  return part;
}

/// Ratio of mean square errors to those of the plain mean, with 95 % by the runs' scatter.
Json merge_json(const array::MergeResult& merge, const array::MergeResult& plain) {
  const study::PairedRatio ratio = study::paired_ratio(plain.mse, merge.mse);
  return {{"name", merge.name}, {"mse", merge.mean()}, {"ratio_to_mean", ratio.ratio}, {"ratio_95", {ratio.low, ratio.high}}};
}

Json residual_json(const array::ResidualModel& model) {
  return {{"own_sd_ratio", model.own_sd_ratio},
          {"autocorrelation", model.autocorrelation},
          {"true_autocorrelation", model.true_autocorrelation},
          {"persistence", model.persistence},
          {"true_persistence", model.true_persistence},
          {"removed", model.removed},
          {"removed_by_errors", model.removed_by_errors}};
}

/// The paper's Fig. 10.
report::Panel error_boxes(const std::vector<std::vector<double>>& errors) {
  report::Panel panel = report::xy_panel(
      "boxes", "Errors", {"error", "", report::Axis::Scale::kLinear, {}, {}}, {"", "", report::Axis::Scale::kLinear, {}, {}},
      "Of the first run: each sensor, their mean, corrected by residuals and by errors. 5, 25, 50, 75 and 95 %.");
  constexpr std::array kMerged{"mean", "corrected", "corrected by errors"};
  const std::size_t sensors = errors.size() - kMerged.size();
  report::Boxes boxes;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    std::vector<double> sorted = errors[i];
    std::ranges::sort(sorted);
    const auto q = [&](double p) { return sorted[static_cast<std::size_t>(p * static_cast<double>(sorted.size() - 1))]; };
    boxes.boxes.push_back({static_cast<double>(i), q(0.05), q(0.25), q(0.5), q(0.75), q(0.95)});
    panel.plot().y.ticks.push_back(
        {static_cast<double>(i), i < sensors ? fmt::format("single {}", i + 1) : std::string(kMerged[i - sensors])});
  }
  panel.plot().boxes.push_back(std::move(boxes));
  return panel;
}

/// The paper's Fig. 11.
report::Panel variance_panel(const array::MergeStudy& study, double dt) {
  report::Panel panel =
      report::time_panel("tracking", "Variance tracking", "",
                         "Sensor 1, first run: its errors less what the model predicts of them, their true standard deviation "
                         "and the predicted one.");
  constexpr std::size_t kShown = 3000;  // of more a panel keeps the extremes alone, and dots would have a hole in the middle
  std::vector<double> t;
  for (std::size_t n = 0; n < std::min(kShown, study.first_sd.size()); ++n) t.push_back(dt * static_cast<double>(n));
  const auto shown = [&](const std::vector<double>& all) { return std::vector(all.begin(), all.begin() + std::ssize(t)); };
  report::add_points(panel.plot(), "residuals", curve(t, shown(study.first_residuals)), report::Tone::kMuted).radius_px = 0.8;
  report::add_line(panel.plot(), "true", curve(t, shown(study.first_sd)), report::Tone::kReference);
  report::add_line(panel.plot(), "predicted", curve(t, shown(study.first_predicted_sd)), report::Tone::kSmoothed);
  return panel;
}

StudyPart study_merges(const ArrayStudyConfig& config, const Progress& progress) {
  StudyPart part;
  part.section = {"merges", "Ways of merging", "", {}, {}, {}};
  part.json["cases"] = Json::array();
  report::Table table{"mse", "Mean square errors over the plain mean's", "", {}, {}};
  report::Table models{"residuals", "Models from residuals beside the truth", "Means over sensors and runs.", {}, {}};
  models.columns = {{"sensors", ""},       {"motion rms", ""}, {"own sd, ratio", ""}, {"lag-1 correlation", ""}, {"true", ""},
                    {"gamma + delta", ""}, {"true", ""},       {"removed", "%"},      {"by errors", "%"}};
  const double cases = static_cast<double>(config.counts.size() * config.motions.size());
  double done = 0.0;
  for (const std::size_t count : config.counts) {
    for (const double motion : config.motions) {
      array::MergeStudyOptions options = config.merges;
      options.sensors.resize(count);
      options.motion_rms = motion;
      options.runs = config.runs;
      options.samples = config.samples;
      options.first_seed = config.first_seed;
      const array::MergeStudy study = array::run_merge_study(options, [&](double share) { progress((done + share) / cases); });
      done += 1.0;
      Json one = {{"sensors", count}, {"motion_rms", motion}, {"merges", Json::array()}, {"residual_models", Json::array()}};
      const array::MergeResult& plain = study.merges[count];
      if (table.columns.empty()) table.columns = {{"sensors", ""}, {"motion rms", ""}};
      std::vector<report::Cell> row = cells({fmt::format("{}", count), number(motion)});
      for (const array::MergeResult& merge : study.merges) {
        one["merges"].push_back(merge_json(merge, plain));
        if (merge.name.starts_with("single")) continue;
        if (table.rows.empty()) table.columns.push_back({merge.name, ""});
        row.push_back({decimals(one["merges"].back()["ratio_to_mean"].get<double>(), 4)});
      }
      table.rows.push_back(std::move(row));
      array::ResidualModel mean;
      for (const array::ResidualModel& model : study.residual_models) {
        one["residual_models"].push_back(residual_json(model));
        const double share = 1.0 / static_cast<double>(count);
        mean.own_sd_ratio += share * model.own_sd_ratio;
        mean.autocorrelation += share * model.autocorrelation;
        mean.true_autocorrelation += share * model.true_autocorrelation;
        mean.persistence += share * model.persistence;
        mean.true_persistence += share * model.true_persistence;
        mean.removed += share * model.removed;
        mean.removed_by_errors += share * model.removed_by_errors;
      }
      models.rows.push_back(
          cells({fmt::format("{}", count), number(motion), decimals(mean.own_sd_ratio, 3), decimals(mean.autocorrelation, 3),
                 decimals(mean.true_autocorrelation, 3), decimals(mean.persistence, 4), decimals(mean.true_persistence, 4),
                 percent(mean.removed), percent(mean.removed_by_errors)}));
      part.json["cases"].push_back(std::move(one));
      if (done > 1.0) continue;
      part.section.panels.push_back(error_boxes(study.first_errors));
      part.section.panels.push_back(variance_panel(study, options.dt));
    }
  }
  part.section.tables.push_back(std::move(table));
  part.section.tables.push_back(std::move(models));
  return part;
}

StudyPart study_outages(const ArrayStudyConfig& config, const Progress& progress) {
  const std::vector<study::ArrayOutageRun> runs = study::run_array_outages(*config.outages, progress);
  const auto plain = std::ranges::find(runs, "mean", &study::ArrayOutageRun::name);
  StudyPart part;
  part.section = {"outages", "Drift in an outage", "", {}, {}, {}};
  part.section.lead =
      fmt::format("{} seeds; ratios of the largest horizontal error to that with the plain mean, pair by pair.", config.runs);
  report::Table table{"drift", "Largest horizontal error", "", {}, {}};
  table.columns = {{"IMU", "", false},      {"forward rms", "m"}, {"over the mean's", ""}, {"95 %", ""}, {"smoothed rms", "m"},
                   {"over the mean's", ""}, {"95 %", ""},         {"inside 95 %", "%"}};
  part.json = {{"seeds", config.runs}, {"runs", Json::array()}};
  for (const study::ArrayOutageRun& run : runs) {
    Json one = {{"name", run.name}};
    std::vector<report::Cell> row = cells({run.name});
    for (const bool smoothed : {false, true}) {
      const auto own = study::drifts(run.outages, study::DriftMeasure::kHorizontal, smoothed);
      const study::PairedRatio ratio =
          study::paired_ratio(study::drifts(plain->outages, study::DriftMeasure::kHorizontal, smoothed), own);
      const study::Spread spread = study::spread_of(own);
      one[smoothed ? "smoothed" : "forward"] = {{"horizontal_rms_m", spread.rms},
                                                {"horizontal_median_m", spread.median},
                                                {"ratio_to_mean", ratio.ratio},
                                                {"ratio_95", {ratio.low, ratio.high}},
                                                {"inside_95", study::drift_of(run.outages, smoothed).inside_95}};
      row.push_back({number(spread.rms)});
      row.push_back({decimals(ratio.ratio, 3)});
      row.push_back({fmt::format("{} to {}", decimals(ratio.low, 3), decimals(ratio.high, 3))});
    }
    row.push_back({percent(one["smoothed"]["inside_95"].get<double>())});
    table.rows.push_back(std::move(row));
    part.json["runs"].push_back(std::move(one));
  }
  part.section.tables.push_back(std::move(table));
  return part;
}

StudyPart study_defects(const ArrayStudyConfig& config, const Progress& progress) {
  const array::DefectStudyResult study =
      array::run_defect_study(config.defects, config.injections, config.first_seed, progress);
  StudyPart part;
  part.section = {"defects", "Defects", "", {}, {}, {}};
  part.section.lead = fmt::format("{} false alarms in {} clean hours; {} are stated.", study.false_alarms,
                                  number(study.clean_hours), number(study.stated_false_alarms));
  report::Table table{"detection", "Injected defects", "", {}, {}};
  table.columns = {{"kind", "", false},    {"strength", ""},      {"injected", ""},
                   {"found", "%"},         {"wrong sensor", "%"}, {"right kind", "%"},
                   {"delay, median", "s"}, {"delay, 95 %", "s"},  {"onset error", "s"}};
  part.json = {{"clean_hours", study.clean_hours},
               {"false_alarms", study.false_alarms},
               {"stated_false_alarms", study.stated_false_alarms},
               {"rows", Json::array()}};
  for (const array::DefectStudyRow& row : study.rows) {
    const auto share = [](std::size_t part_of, std::size_t whole) {
      return whole > 0 ? static_cast<double>(part_of) / static_cast<double>(whole) : 0.0;
    };
    part.json["rows"].push_back({{"kind", array::name_of(row.kind)},
                                 {"strength", row.strength},
                                 {"injections", row.injections},
                                 {"detected", share(row.detected, row.injections)},
                                 {"wrong_sensor", share(row.wrong_sensor, row.injections)},
                                 {"right_kind", share(row.right_kind, row.detected)},
                                 {"median_delay_s", row.median_delay_s},
                                 {"delay_95_s", row.delay_95_s},
                                 {"median_onset_error_s", row.median_onset_error_s}});
    table.rows.push_back(cells({std::string(array::name_of(row.kind)), number(row.strength), fmt::format("{}", row.injections),
                                percent(share(row.detected, row.injections)), percent(share(row.wrong_sensor, row.injections)),
                                percent(share(row.right_kind, row.detected)), number(row.median_delay_s),
                                number(row.delay_95_s), number(row.median_onset_error_s)}));
  }
  part.section.tables.push_back(std::move(table));
  return part;
}

StudyPart run_study(const ArrayStudyConfig& config, const Progress& progress) {
  switch (config.kind) {
    case ArrayStudyKind::kModels:
      return study_models(config, progress);
    case ArrayStudyKind::kMerges:
      return study_merges(config, progress);
    case ArrayStudyKind::kOutages:
      return study_outages(config, progress);
    case ArrayStudyKind::kDefects:
      return study_defects(config, progress);
  }
  return {};
}

}  // namespace

void array_study(const std::filesystem::path& study_yaml, const CommonOptions& options) {
  ProgressLine line(options.quiet);
  const ArrayStudyConfig config = read_array_study(study_yaml);
  const std::filesystem::path out = output_folder(study_yaml, options.out, {"array_study.json", "report.json", "report.html"});
  const char* kind = std::array{"models", "merges", "outages", "defects"}[static_cast<std::size_t>(config.kind)];
  StudyPart part;
  try {
    line.show("simulating", 0.0);
    part = run_study(config, [&](double share) { line.show("simulating", share); });
  } catch (const std::invalid_argument& error) {
    throw config.root.error(error.what(), "a study that can be run");
  }
  line.show("writing", 0.0);
  Json json = {{"schema", "coast.array_study_result/1"}, {"kind", kind}};
  json[kind] = std::move(part.json);
  report::Page page;
  page.title = part.section.title;
  page.subtitle = study_yaml.filename().string();
  page.sections.push_back(std::move(part.section));
  page.footer = fmt::format("coast {}, coast synth", COAST_VERSION);
  io::begin_results(out / "array_study.json");
  io::write_text(out / "report.json", report::to_json(page));
  io::write_text(out / "report.html", report::render(page));
  io::write_text(out / "array_study.json", json.dump(2) + "\n");
  line.clear();
  if (!options.quiet) fmt::print("study: {}\n", (out / "report.html").string());
}

}  // namespace coast::cli
