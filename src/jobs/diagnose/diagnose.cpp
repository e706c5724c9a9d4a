#include "coast/jobs/diagnose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coast/io/yaml.hpp"
#include "coast/simulate/scenario.hpp"
#include "run_file/recordings.hpp"

namespace coast::jobs {

namespace {

void require_positions(const RunConfig& config) {
  if (config.tight)
    throw InputError({config.file.string(), 0, "tightly coupled observations", "positions: effects are sought in fixes", ""});
  if (!config.effects.empty())
    throw InputError({config.file.string(), 0, "`effects` that were found already", "a run without them",
                      "Take them out of the file: they are sought from nothing."});
}

diagnose::MissionInput recorded_input(const RunConfig& config, Recordings& recordings) {
  study::Setup setup = setup_of(config, recordings, {});
  return {std::move(recordings.imu), std::move(recordings.gnss), std::move(setup)};
}

/// Recordings of a scenario with several seeds, each processed with the sensor errors of the scenario.
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
                                                     const Progress& progress) {
  if (file.empty()) return {};
  const config::Node root = io::load_yaml(file);
  if (root.text("schema", "coast.run/1").starts_with("coast.scenario/"))
    return from_scenario(root, as, static_cast<std::size_t>(std::max(1, count)));
  const RunConfig config = read_run_config(file);
  require_positions(config);
  Recordings recordings = load(config, progress);
  return {recorded_input(config, recordings)};
}

/// Why figures of a simulation do not apply to the recording: it is of another drive. Empty if it is of the same one.
std::string of_another_drive(const diagnose::MissionInput& recording, const diagnose::MissionInput& simulation) {
  constexpr double kSameSpan = 0.05;    // relative to the recording's
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

std::optional<SimulationCheck> check_simulation(const DiagnosisConfig& config, const diagnose::MissionInput& input,
                                                const std::vector<diagnose::MissionInput>& simulations,
                                                const Progress& progress) {
  if (simulations.empty()) return std::nullopt;
  SimulationCheck check{config.simulation.string(), diagnose::diagnose(simulations.front(), {.twins = 0}, progress),
                        of_another_drive(input, simulations.front())};
  if (progress.warn && !check.of_another_drive.empty())
    progress.warn(fmt::format("{}: {}", check.source, check.of_another_drive));
  return check;
}

}  // namespace

DiagnosisConfig read_diagnose(const std::filesystem::path& run_yaml) {
  return read_diagnose(io::load_yaml(run_yaml));
}

DiagnosisConfig read_diagnose(const config::Node& root) {
  DiagnosisConfig config;
  config.run = read_run_config(root);
  require_positions(config.run);
  return config;
}

DiagnosisResult diagnose(const DiagnosisConfig& config, Recordings recordings, const Progress& progress) {
  tell_inspection(recordings, progress);
  refuse_wrong_axes(config.run, recordings);
  refuse_wrong_units(config.run, recordings);
  const diagnose::MissionInput input = recorded_input(config.run, recordings);
  const std::vector<diagnose::MissionInput> simulations =
      simulated_inputs(config.simulation, input.setup, config.twins, progress);
  DiagnosisResult result;
  result.quick = config.quick;
  result.simulation = check_simulation(config, input, simulations, progress);
  diagnose::DiagnosisOptions search{.twins = config.quick ? 0 : config.twins, .exchanges = !config.quick};
  if (const std::optional<double> shift = recordings.time_shift_s) search.time_offset_s = -*shift;
  if (recordings.reference) search.reference = {&*recordings.reference, config.run.reference_lever_arm_b};
  result.diagnosis = diagnose::diagnose(input, search, progress, simulations);
  result.start = input.imu.samples.front().t;
  result.end = input.imu.samples.back().t;
  return result;
}

}  // namespace coast::jobs
