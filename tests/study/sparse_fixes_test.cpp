// Fixes seconds to half a minute apart: the attitude is found from specific force between them, at rest or in motion.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "coast/geo/units.hpp"
#include "coast/study/comparison.hpp"
#include "coast/study/solution.hpp"
#include "simulated.hpp"

namespace coast::study {
namespace {

struct Sparse {
  double interval_s;
  double static_s;
  int seed;
};

noise::ImuErrorModel mems_model() {
  return noise::ImuErrorModel::from(io::parse_yaml(R"(
schema: coast.imu_error_model/1
gyro:
  all: [{process: white_noise, density: 0.005, unit: deg/s/sqrt(Hz)}, {process: random_constant, sigma: 0.3, unit: deg/s},
        {process: gauss_markov, sigma: 20, unit: deg/h, correlation_time_s: 300}]
accel:
  all: [{process: white_noise, density: 150, unit: ug/sqrt(Hz)}, {process: random_constant, sigma: 10, unit: mg},
        {process: gauss_markov, sigma: 0.1, unit: mg, correlation_time_s: 300}]
)",
                                                   "model.yaml"));
}

class SparseFixes : public testing::TestWithParam<Sparse> {};

TEST_P(SparseFixes, AlignAndTheBoundsHold) {
  const auto [interval, rest, seed] = GetParam();
  simulate::Scenario scenario = simulate::Scenario::from(io::parse_yaml(fmt::format(R"(
schema: coast.scenario/1
trajectory: {{kind: city, duration_s: 900, static_s: {}, origin_deg_m: [46.52, 6.57, 400], course_deg: 30}}
imu: {{rate_hz: 50, lever_arm_m: [0.3, -0.2, -1.1]}}
gnss: {{rate_hz: {}, sd_m: [0.02, 0.02, 0.04]}}
start_gps: {{week: 2374, sow: 208800}}
seed: {}
)",
                                                                                    rest, 1.0 / interval, seed),
                                                                        "scenario.yaml"),
                                                         [](const std::filesystem::path& file) { return io::load_yaml(file); });
  scenario.error_model = mems_model();
  simulate::SimulatedMission recording = simulate::simulate(scenario);
  const record::Trajectory truth = recording.truth;
  study::Setup setup = test::setup_of(scenario);
  setup.unstated = {
      .noise = {.gnss_scale = true, .correlated_gnss = true, .imu_white_noise = true}, .time_offset = true, .lever_arm = true};
  const PreparedMission mission(std::move(recording.imu), std::move(recording.gnss), setup, {});
  EXPECT_FALSE(mission.noise_fit().has_value()) << "the noise is as stated";
  EXPECT_FALSE(mission.heading_assumed());
  double inside = 0.0, compared = 0.0;
  Comparison comparison(truth, Eigen::Vector3d::Zero(), [&](const ErrorSample& e) {
    for (int axis = 0; axis < 2; ++axis) {
      compared += 1.0;
      inside += std::abs(e.position_n(axis)) < 1.96 * e.sd_position(axis) ? 1.0 : 0.0;
    }
  });
  SolutionOutputs outputs;
  outputs.smoothed = [&](const record::TrajectoryEpoch& epoch) { comparison.add(epoch); };
  static_cast<void>(solve(mission, mission.options(), true, outputs, {}));
  ASSERT_GT(compared, 1000.0);
  // 95 % are expected; the intervals are as many as independent errors, 30 of them at 30 s: within a tenth in 99 %.
  EXPECT_GT(inside / compared, 0.85);
}

INSTANTIATE_TEST_SUITE_P(Intervals, SparseFixes,
                         testing::Values(Sparse{5.0, 30.0, 3}, Sparse{10.0, 30.0, 4}, Sparse{30.0, 60.0, 5},
                                         Sparse{5.0, 0.0, 6}, Sparse{10.0, 0.0, 7}, Sparse{30.0, 0.0, 8},
                                         Sparse{30.0, 60.0, 15}, Sparse{10.0, 0.0, 17}, Sparse{30.0, 0.0, 18}));

}  // namespace
}  // namespace coast::study
