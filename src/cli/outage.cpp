#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "coast/io/writers.hpp"
#include "coast/io/yaml.hpp"
#include "coast/record/error.hpp"
#include "coast/report/panels.hpp"
#include "coast/report/render.hpp"
#include "commands.hpp"
#include "drift.hpp"
#include "load.hpp"
#include "progress.hpp"
#include "run_config.hpp"

namespace coast::cli {

namespace {

struct Model {
  std::string name;
  noise::ImuErrorModel model;
};

/// study.yaml: a run, a sweep, and the error models to be compared in it.
struct StudyConfig {
  RunConfig run;
  study::OutageSweep sweep;
  std::vector<Model> models;
};

StudyConfig read_study(const std::filesystem::path& file) {
  const config::Node root = io::load_yaml(file);
  static_cast<void>(root.text("schema", "coast.study/1"));
  StudyConfig study;
  study.run = read_run_config(root.at("run").path());
  study.sweep = sweep_from(root.at("sweep"));
  if (const auto models = root.find("error_models")) {
    for (const config::Node& item : models->items())
      study.models.push_back({item.at("name").text(), noise::ImuErrorModel::from(io::load_yaml(item.at("file").path()))});
  } else {
    study.models.push_back({study.run.setup.model.sensor_name(), study.run.setup.model});
  }
  root.refuse_unasked();
  return study;
}

std::vector<study::OutageResult> run_model(const StudyConfig& config, const Model& model, const study::Progress& progress) {
  study::Setup setup = config.run.setup;
  setup.model = model.model;
  Recordings recordings = load(config.run);
  if (config.run.start) setup.start = start_of(*config.run.start, recordings.gnss.fixes.front().t);
  const study::PreparedMission mission(std::move(recordings.imu), std::move(recordings.gnss), std::move(setup), progress);
  record::Trajectory gap_free;
  study::SolutionOutputs outputs;
  constexpr double kInterval = 0.1;  // s
  outputs.smoothed = [&](const record::TrajectoryEpoch& epoch) {
    if (gap_free.states.empty() || epoch.nav.t - gap_free.states.back().t >= kInterval - 1e-6)
      gap_free.states.push_back(epoch.nav);
  };
  const study::Solution solution = study::solve(mission, mission.options(), true, outputs, progress);
  const record::Trajectory& truth = recordings.reference ? *recordings.reference : gap_free;
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

/// Mean of the logarithm of the ratio second : first of the largest horizontal error, outage by outage, with its 95 % interval.
struct PairedRatio {
  double ratio = 1.0;
  double low = 1.0;
  double high = 1.0;
};

PairedRatio paired_ratio(const std::vector<study::OutageResult>& first, const std::vector<study::OutageResult>& second,
                         double duration_s, bool smoothed) {
  std::vector<double> logs;
  for (std::size_t i = 0; i < std::min(first.size(), second.size()); ++i) {
    if (first[i].outage.duration_s != duration_s) continue;
    const auto error = [&](const study::OutageResult& o) {
      return smoothed ? o.smoothed->horizontal_max_m : o.forward.horizontal_max_m;
    };
    if (error(first[i]) > 0.0 && error(second[i]) > 0.0) logs.push_back(std::log(error(second[i]) / error(first[i])));
  }
  const auto n = static_cast<double>(logs.size());
  if (n < 2.0) return {};
  double mean = 0.0;
  double square = 0.0;
  for (const double x : logs) mean += x / n;
  for (const double x : logs) square += (x - mean) * (x - mean) / (n - 1.0);
  const double half = 1.96 * std::sqrt(square / n);
  return {std::exp(mean), std::exp(mean - half), std::exp(mean + half)};
}

using Json = nlohmann::ordered_json;

Json drift_json(const Drift& d) {
  return {{"median_m", d.median}, {"p68_m", d.p68}, {"p95_m", d.p95}, {"max_m", d.max}};
}

Json model_json(const Model& model, const std::vector<study::OutageResult>& results) {
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

coast::report::Section drift_section(const Model& model, const std::vector<study::OutageResult>& results, std::size_t number) {
  namespace page = coast::report;
  page::Section section;
  section.id = "model-" + std::to_string(number);
  section.title = model.name;
  page::Table table;
  table.id = section.id + "-table";
  table.title = "Largest horizontal error of an outage";
  table.columns = {{"duration", "s"},        {"outages", ""},        {"forward median", "m"},   {"forward 95 %", "m"},
                   {"smoothed median", "m"}, {"smoothed 95 %", "m"}, {"inside 95 % bound", "%"}};
  page::Panel panel = page::xy_panel(
      section.id + "-drift", "Drift against duration",
      {.label = "duration", .unit = "s", .scale = page::Axis::Scale::kLog, .ticks = {}, .range = {}},
      {.label = "largest horizontal error", .unit = "m", .scale = page::Axis::Scale::kLog, .ticks = {}, .range = {}},
      "Median and 95 % over all outages of a duration; smoothed lies far below forward.");
  page::Series forward;
  page::Series forward95;
  page::Series smoothed;
  page::Series smoothed95;
  const auto push = [](page::Series& s, double x, double y) {
    s.x.push_back(x);
    s.y.push_back(y);
  };
  for (const DriftRow& row : drift_table(results)) {
    table.rows.push_back({{fmt::format("{:g}", row.duration_s)},
                          {fmt::format("{}", row.outages)},
                          {fmt::format("{:.3f}", row.forward.median)},
                          {fmt::format("{:.3f}", row.forward.p95)},
                          {fmt::format("{:.3f}", row.smoothed.median)},
                          {fmt::format("{:.3f}", row.smoothed.p95)},
                          {fmt::format("{:.1f}", 100.0 * row.inside_95)}});
    push(forward, row.duration_s, row.forward.median);
    push(forward95, row.duration_s, row.forward.p95);
    push(smoothed, row.duration_s, row.smoothed.median);
    push(smoothed95, row.duration_s, row.smoothed.p95);
  }
  page::add_line(panel.plot(), "forward, median", forward, page::Tone::kForward);
  page::add_line(panel.plot(), "forward, 95 %", forward95, page::Tone::kForward).style = page::Line::Style::kDashed;
  page::add_line(panel.plot(), "smoothed, median", smoothed, page::Tone::kSmoothed);
  page::add_line(panel.plot(), "smoothed, 95 %", smoothed95, page::Tone::kSmoothed).style = page::Line::Style::kDashed;
  section.tables.push_back(std::move(table));
  section.panels.push_back(std::move(panel));
  return section;
}

}  // namespace

void outage(const std::filesystem::path& study_yaml, const CommonOptions& options) {
  ProgressLine line(options.quiet);
  const study::Progress progress = [&line](const char* what, double fraction) { line.show(what, fraction); };
  const StudyConfig config = read_study(study_yaml);
  const std::filesystem::path out = output_folder(study_yaml, options.out);

  Json j;
  coast::report::Page page;
  page.title = "Outage study";
  page.subtitle = study_yaml.filename().string();
  std::vector<std::vector<study::OutageResult>> results;
  for (const Model& model : config.models) {
    results.push_back(run_model(config, model, progress));
    j["models"].push_back(model_json(model, results.back()));
    page.sections.push_back(drift_section(model, results.back(), results.size()));
  }
  line.clear();
  for (std::size_t i = 1; i < results.size(); ++i)
    for (const DriftRow& row : drift_table(results.front()))
      for (const bool smoothed : {false, true}) {
        const PairedRatio ratio = paired_ratio(results.front(), results[i], row.duration_s, smoothed);
        j["paired"].push_back({{"first", config.models.front().name},
                               {"second", config.models[i].name},
                               {"duration_s", row.duration_s},
                               {"solution", smoothed ? "smoothed" : "forward"},
                               {"ratio", ratio.ratio},
                               {"interval_95", {ratio.low, ratio.high}}});
      }
  io::write_text(out / "outage.json", j.dump(1) + "\n");
  io::write_text(out / "report.json", coast::report::to_json(page));
  io::write_text(out / "report.html", coast::report::render(page));
  if (!options.quiet) fmt::print("report: {}\n", (out / "report.html").string());
}

}  // namespace coast::cli
