#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coast/diagnose/diagnosis.hpp"
#include "coast/io/results_folder.hpp"
#include "coast/io/writers.hpp"
#include "coast/io/yaml.hpp"
#include "coast/report/render.hpp"
#include "coast/simulate/scenario.hpp"
#include "commands.hpp"
#include "diagnosis_json.hpp"
#include "load.hpp"
#include "progress.hpp"

namespace coast::cli {

namespace {

diagnose::MissionInput recorded_input(const std::filesystem::path& run_yaml, const RunConfig& config, Recordings& recordings) {
  if (config.tight)
    throw InputError({run_yaml.string(), 0, "tightly coupled observations", "positions: effects are sought in fixes", ""});
  if (!config.effects.empty())
    throw InputError({run_yaml.string(), 0, "`effects` that were found already", "a run without them",
                      "Take them out of the file: they are sought from nothing."});
  const study::Setup setup = setup_of(config, recordings, {});
  return {std::move(recordings.imu), std::move(recordings.gnss), setup};
}

/// Recordings of a scenario with as many seeds, each processed as the scenario says that its sensors are.
std::vector<diagnose::MissionInput> from_scenario(const config::Node& root, const study::Setup& as, std::size_t count) {
  const simulate::Scenario scenario = simulate::Scenario::from(root, [](const auto& file) { return io::load_yaml(file); });
  root.refuse_unasked();
  const simulate::ErrorFreeMission mission(scenario);
  study::Setup setup = as;
  setup.start.reset();
  setup.C_s_b = ins::C_s_b(scenario.mounting);
  setup.lever_arm_b = scenario.gnss.lever_arm_b;
  setup.time_offset_s = scenario.gnss.time_offset;
  if (scenario.error_model) setup.model = *scenario.error_model;
  std::vector<diagnose::MissionInput> inputs;
  for (std::size_t i = 0; i < count; ++i) {
    simulate::ErrorFreeMission::Recordings recordings = mission.recorded(scenario.error_model, scenario.seed + i);
    ins::to_body(recordings.imu, setup.C_s_b);
    inputs.push_back({std::move(recordings.imu), std::move(recordings.gnss), setup});
  }
  return inputs;
}

std::vector<diagnose::MissionInput> simulated_inputs(const std::filesystem::path& file, const study::Setup& as, int count,
                                                     const study::Progress& progress) {
  if (file.empty()) return {};
  const config::Node root = io::load_yaml(file);
  if (root.text("schema", "coast.run/1").starts_with("coast.scenario/"))
    return from_scenario(root, as, static_cast<std::size_t>(std::max(1, count)));
  const RunConfig config = read_run_config(file);
  Recordings recordings = load(config, progress);
  return {recorded_input(file, config, recordings)};
}

/// Why figures of a simulation say little of the recording: it is of another drive. Empty where it is of the same.
std::string of_another_drive(const diagnose::MissionInput& recording, const diagnose::MissionInput& simulation) {
  constexpr double kSameSpan = 0.05;    // of the recording's
  constexpr double kSamePlace = 100.0;  // m
  const std::vector<record::GnssFix>& real = recording.gnss.fixes;
  const std::vector<record::GnssFix>& other = simulation.gnss.fixes;
  if (real.empty() || other.empty()) return {};
  const double span = real.back().t - real.front().t;
  const double its_span = other.back().t - other.front().t;
  if (std::abs(its_span - span) > kSameSpan * span)
    return fmt::format("it takes {:.0f} s, the recording {:.0f} s; what differs may be the drive", its_span, span);
  double farthest = 0.0;
  std::size_t k = 0;
  for (const record::GnssFix& fix : real) {
    while (k + 1 < other.size() && other[k].t - other.front().t < fix.t - real.front().t) ++k;
    farthest = std::max(farthest, (other[k].r_ea_e - fix.r_ea_e).norm());
  }
  if (farthest < kSamePlace) return {};
  return fmt::format("it is up to {:.0f} m from the recording at the same time since the start; what differs may be the drive",
                     farthest);
}

}  // namespace

void diagnose(const std::filesystem::path& run_yaml, const DiagnoseOptions& choice, const CommonOptions& options) {
  ProgressLine line(options.quiet);
  const study::Progress progress = line.stages();
  const RunConfig config = read_run_config(run_yaml);
  Recordings recordings = load(config, progress);
  const std::filesystem::path out =
      output_folder(run_yaml, options.out,
                    {"diagnosis.json", "run.diagnosed.yaml", "error_model.diagnosed.yaml", "report.json", "report.html"});
  line.clear();
  print_inspection(recordings, options.quiet);
  refuse_wrong_axes(config, recordings);
  refuse_wrong_units(config, recordings);
  const diagnose::MissionInput input = recorded_input(run_yaml, config, recordings);
  const std::vector<diagnose::MissionInput> simulations =
      simulated_inputs(choice.simulation, input.setup, choice.twins, progress);
  std::optional<SimulationCheck> simulation;
  if (!simulations.empty())
    simulation = SimulationCheck{choice.simulation.string(), diagnose::diagnose(simulations.front(), {.twins = 0}, progress),
                                 of_another_drive(input, simulations.front())};
  line.clear();
  if (simulation && !simulation->of_another_drive.empty())
    fmt::print(stderr, "warning: {}: {}\n", simulation->source, simulation->of_another_drive);
  diagnose::DiagnosisOptions search{.twins = choice.twins};
  if (const std::optional<double> shift = recordings.time_shift_s) search.time_offset_s = -*shift;
  if (recordings.reference) search.reference = {&*recordings.reference, config.reference_lever_arm_b};
  const diagnose::Diagnosis diagnosis = diagnose::diagnose(input, search, progress, simulations);
  line.show("writing", 0.0);
  const std::string error_model = "error_model.diagnosed.yaml";  // beside the run, so that both can be moved
  const std::string diagnosed = diagnosed_yaml(config.root.resolved_yaml(), diagnosis, error_model);
  io::begin_results(out / "diagnosis.json");
  if (changes_error_model(diagnosis))
    io::write_text(out / error_model, diagnosis.modelled.setup.model.yaml());
  else
    std::filesystem::remove(out / error_model);  // of a former diagnosis
  io::write_text(out / "run.diagnosed.yaml", diagnosed);
  const report::Page page = diagnosis_page(run_yaml.filename().string(), diagnosis, diagnosed, simulation);
  io::write_text(out / "report.json", report::to_json(page));
  io::write_text(out / "report.html", report::render(page));
  io::write_text(out / "diagnosis.json", diagnosis_json(diagnosis, input, simulation));
  line.clear();
  if (!options.quiet)
    fmt::print("{}the run with it: {}\nreport: {}\n", diagnosis_text(diagnosis, simulation),
               (out / "run.diagnosed.yaml").string(), (out / "report.html").string());
}

}  // namespace coast::cli
