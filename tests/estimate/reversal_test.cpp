// A mission filtered from its end to its start, as a clock that runs backwards sees it, has the same smoothed trajectory.

#include "coast/ins/reversal.hpp"

#include <gtest/gtest.h>

#include "coast/estimate/forward_filter.hpp"
#include "coast/estimate/smoother.hpp"
#include "estimate/mission.hpp"
#include "support/support.hpp"

namespace coast {
namespace {

using namespace estimate;

// A tenth of industrial noise everywhere, so that the passes linearise at the same trajectory for all that matters.
constexpr const char* kQuietModel = R"(schema: coast.imu_error_model/1
gyro:
  all: [{process: white_noise, density: 0.02, unit: deg/sqrt(h)}, {process: random_constant, sigma: 3, unit: deg/h},
        {process: gauss_markov, sigma: 0.6, unit: deg/h, correlation_time_s: 100}, {process: scale_factor, sigma: 50, unit: ppm}]
accel:
  all: [{process: white_noise, density: 8, unit: ug/sqrt(Hz)}, {process: random_constant, sigma: 0.2, unit: mg},
        {process: gauss_markov, sigma: 0.01, unit: mg, correlation_time_s: 100}, {process: scale_factor, sigma: 50, unit: ppm}]
)";
// So wide that what is known at either end does not tell the passes apart.
constexpr test::StartSd kWide{.position = 1.0, .velocity = 0.1, .tilt = 0.005, .heading = 0.01};

std::vector<SmoothedKnot> smoothed_mission(const Mission& mission, const noise::ImuErrorModel& model,
                                           const FilterOptions& options, const record::NavState& start) {
  const ForwardFilter filter(mission, model, options);
  KnotStore knots;
  FilterOutputs outputs;
  outputs.knots = &knots;
  (void)filter.run(filter.initial_state(start, Eigen::Vector3d::Constant(kWide.position),
                                        Eigen::Vector3d::Constant(kWide.velocity), kWide.attitude()),
                   outputs);
  return smooth(knots, filter.layout());
}

TEST(Reversal, BackwardPassGivesTheSameSmoothedTrajectory) {
  const auto model = test::error_model(kQuietModel);
  test::RecordingOptions recording_options;
  recording_options.duration = 150.0;
  recording_options.gnss.lever_arm_b = {0.5, 0.2, -1.0};
  recording_options.gnss.sd = {0.001, 0.001, 0.002};
  recording_options.gnss.velocity_sd = Eigen::Vector3d(0.003, 0.003, 0.005);
  const test::Recording recording = test::make_recording(recording_options, &model, 21);
  FilterOptions options;
  options.gate_probability = 0.0;
  options.knot_interval_s = 0.5;
  const geo::GpsTime from = test::mission_start();
  options.withheld.push_back({from + 70.0, from + 90.0});
  const auto forward = smoothed_mission(recording.mission(), model, options, recording.truth(from));

  const geo::GpsTime end = recording.imu.samples.back().t;
  test::Recording backwards = recording;
  ins::reverse(backwards.imu, end);
  ins::reverse(backwards.gnss, end);
  Mission mission = backwards.mission();
  mission.earth_rate = -geo::kEarthRate;
  FilterOptions mirrored = options;
  mirrored.withheld = {{ins::mirrored(from + 90.0, end) + 1e-9, ins::mirrored(from + 70.0, end) + 1e-9}};
  const auto backward = smoothed_mission(mission, model, mirrored, ins::reversed(recording.truth(end), end));

  std::size_t compared = 0;
  for (const SmoothedKnot& a : forward) {
    const double elapsed = a.nav.t - from;
    if (elapsed < 40.0 || elapsed > 110.0) continue;
    for (const SmoothedKnot& b : backward) {
      const record::NavState nav = ins::reversed(b.nav, end);
      if (std::abs(nav.t - a.nav.t) > 1e-6) continue;
      ++compared;
      const Eigen::VectorXd ratio = error_between(a.nav, nav).cwiseAbs().cwiseQuotient(a.sd.head<kNav>());
      EXPECT_LE(ratio.maxCoeff(), 0.1) << elapsed << " s: " << ratio.transpose();
      const Eigen::VectorXd sd_ratio = a.sd.head<kNav>().cwiseQuotient(b.sd.head<kNav>());
      EXPECT_NEAR(sd_ratio.minCoeff(), 1.0, 0.05) << elapsed;
      EXPECT_NEAR(sd_ratio.maxCoeff(), 1.0, 0.05) << elapsed;
      // What a gyro adds changes its sign with the rate, what an accelerometer adds does not.
      EXPECT_NEAR(a.x(kNav), -b.x(kNav), 0.1 * a.sd(kNav));
      EXPECT_NEAR(a.x(kNav + 9), b.x(kNav + 9), 0.1 * a.sd(kNav + 9));
    }
  }
  EXPECT_GE(compared, 60u);
}

}  // namespace
}  // namespace coast
