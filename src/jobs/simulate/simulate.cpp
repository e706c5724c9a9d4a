#include "coast/jobs/simulate.hpp"

#include <tbb/global_control.h>

#include "coast/io/yaml.hpp"

namespace coast::jobs {

SimulationConfig read_simulate(const std::filesystem::path& file, std::optional<std::uint64_t> seed) {
  return read_simulate(io::load_yaml(file), seed);
}

SimulationConfig read_simulate(const config::Node& root, std::optional<std::uint64_t> seed) {
  SimulationConfig config;
  config.file = root.file();
  config.scenario = simulate::Scenario::from(root, [](const auto& other) { return io::load_yaml(other); });
  if (seed) config.scenario.seed = *seed;
  if (!config.scenario.error_model)
    throw InputError({config.file.string(), 0, "a scenario without imu.error_model", "an error model",
                      "The recording would have no run.yaml that processes it."});
  return config;
}

SimulationResult simulate(const SimulationConfig& config, const Progress& progress) {
  const simulate::Scenario& scenario = config.scenario;
  const auto threads = static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
  progress("simulating", 0.0);
  SimulationResult result{simulate::simulate(scenario, threads), {}, {}, {}};
  if (scenario.observations) {
    progress("simulating observations", 0.0);
    result.observations = simulate::simulate_observations(simulate::make_motion(scenario.kind, scenario.motion), scenario.start,
                                                          *scenario.observations, scenario.seed);
  }
  for (std::size_t k = 0; k < scenario.array.size(); ++k)
    result.array.push_back(simulate::simulate_array_imu(scenario, k, threads));
  if (scenario.aids.empty()) return result;
  const simulate::AnalyticTrajectory motion = simulate::make_motion(scenario.kind, scenario.motion);
  for (std::size_t k = 0; k < scenario.aids.size(); ++k)
    result.aids.push_back(simulate::aid_rows(motion, scenario.start, scenario.aids[k], scenario.seed, k));
  return result;
}

}  // namespace coast::jobs
