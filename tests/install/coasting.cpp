// Simulates a shipped scenario without sensor errors and integrates what its IMU recorded: how far is the end from the truth?
#include <coast/ins/strapdown.hpp>
#include <coast/io/yaml.hpp>
#include <coast/simulate/scenario.hpp>
#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  auto scenario = coast::simulate::Scenario::from(coast::io::load_yaml(argv[1]), coast::io::load_yaml);
  scenario.error_model.reset();
  const auto mission = coast::simulate::simulate(scenario);

  coast::ins::Strapdown strapdown(mission.truth.states.front());
  coast::ins::RawIncrement previous;
  for (const auto& sample : mission.imu.samples) {
    const coast::ins::RawIncrement increment{sample.dt, sample.dtheta, sample.dv};
    strapdown.step(coast::ins::compensate_two_sample(previous, increment));
    previous = increment;
  }
  const double drift = (strapdown.state().r_eb_e - mission.truth.states.back().r_eb_e).norm();
  std::printf("%zu samples, %.4f m from the truth\n", mission.imu.samples.size(), drift);
  // tests/simulate/strapdown_truth_test.cpp holds the integration to its bounds; here a wrong link or a wrong flag would show.
  return drift < 1.0 ? 0 : 1;
}
