// Gaps of the IMU from a tenth of a second to minutes: at the start, in the middle, at the end, many, at rest and in a turn,
// with fixes inside and without.

#include <gtest/gtest.h>

#include <algorithm>

#include "coast/geo/earth.hpp"
#include "coast/study/comparison.hpp"
#include "coast/study/solution.hpp"
#include "simulated.hpp"

namespace coast::study {
namespace {

struct Gap {
  double from_s = 0.0;  ///< after the first sample
  double length_s = 0.0;
};

struct Case {
  const char* name;
  std::vector<Gap> gaps;
  bool fixes_inside = true;
};

// As the reader leaves it: the sample behind a gap bridges it by its mean rate.
void cut(record::ImuRecording& imu, const Gap& gap) {
  const geo::GpsTime from = imu.samples.front().t + gap.from_s, to = from + gap.length_s;
  std::erase_if(imu.samples, [&](const record::ImuSample& s) { return s.t > from && s.t <= to; });
  for (std::size_t i = 1; i < imu.samples.size(); ++i) {
    record::ImuSample& s = imu.samples[i];
    const double step = s.t - imu.samples[i - 1].t;
    if (step < 1.5 * s.dt) continue;
    s.dtheta *= step / s.dt;
    s.dv *= step / s.dt;
    s.dt = step;
  }
}

class ImuGap : public testing::TestWithParam<Case> {};

TEST_P(ImuGap, IsPassedAndTheTrajectoryIsRightOutsideIt) {
  const Case& param = GetParam();
  const simulate::Scenario scenario = test::drive(360.0, 21);
  simulate::SimulatedMission recording = simulate::simulate(scenario);
  const record::Trajectory truth = recording.truth;
  const geo::GpsTime begin = recording.imu.samples.front().t;
  for (const Gap& gap : param.gaps) {
    cut(recording.imu, gap);
    if (!param.fixes_inside)
      std::erase_if(recording.gnss.fixes, [&](const record::GnssFix& fix) {
        return fix.t > begin + gap.from_s && fix.t < begin + gap.from_s + gap.length_s;
      });
  }
  const auto near_a_gap = [&](geo::GpsTime t) {  // heading and velocity are found again within a minute
    return std::ranges::any_of(param.gaps, [&](const Gap& gap) {
      return t - begin > gap.from_s - 2.0 && t - begin < gap.from_s + gap.length_s + 60.0;
    });
  };
  const PreparedMission mission(std::move(recording.imu), std::move(recording.gnss), test::setup_of(scenario), {});
  double largest = 0.0;
  std::size_t compared = 0;
  Comparison comparison(truth, Eigen::Vector3d::Zero(), [&](const ErrorSample& e) {
    if (near_a_gap(e.t)) return;
    ++compared;
    largest = std::max(largest, e.position_n.head<2>().norm());
  });
  SolutionOutputs outputs;
  outputs.smoothed = [&](const record::TrajectoryEpoch& epoch) {
    ASSERT_TRUE(epoch.nav.r_eb_e.allFinite() && epoch.cov.position.allFinite());
    comparison.add(epoch);
  };
  static_cast<void>(solve(mission, mission.options(), true, outputs, {}));
  ASSERT_GT(compared, 1000U);
  // 1 cm of white noise per fix, 5 Hz, smoothed: millimetres; ten standard deviations of a fix are another trajectory.
  EXPECT_LT(largest, 0.1);
}

INSTANTIATE_TEST_SUITE_P(Gaps, ImuGap,
                         testing::Values(Case{"tenth", {{150.0, 0.1}}}, Case{"half_second", {{150.0, 0.5}}},
                                         Case{"second_at_rest", {{10.0, 1.0}}}, Case{"three_seconds", {{200.0, 3.0}}},
                                         Case{"three_seconds_without_fixes", {{200.0, 3.0}}, false},
                                         Case{"start", {{0.5, 10.0}}}, Case{"end", {{345.0, 14.0}}},
                                         Case{"several_long", {{60.0, 5.0}, {130.0, 20.0}, {230.0, 10.0}}, false},
                                         Case{"many", {{100.0, 0.3}, {110.0, 0.6}, {120.0, 1.2}, {130.0, 0.5}}},
                                         Case{"minute", {{150.0, 60.0}}}, Case{"minute_without_fixes", {{150.0, 60.0}}, false}),
                         [](const auto& tested) { return std::string(tested.param.name); });

class HourWithoutImu : public testing::TestWithParam<double> {};

// The rest of the mission comes an hour later: the clock moves on, the vehicle does not.
TEST_P(HourWithoutImu, EndsInANewStart) {
  const simulate::Scenario scenario = test::drive(360.0, 22);
  simulate::SimulatedMission recording = simulate::simulate(scenario);
  constexpr double kPause = 3600.0;
  const geo::GpsTime parting = recording.imu.samples.front().t + GetParam();
  for (record::ImuSample& s : recording.imu.samples)
    if (s.t > parting) s.t = s.t + kPause;
  cut(recording.imu, {GetParam(), kPause});
  for (record::GnssFix& fix : recording.gnss.fixes)
    if (fix.t > parting) fix.t = fix.t + kPause;
  const PreparedMission mission(std::move(recording.imu), std::move(recording.gnss), test::setup_of(scenario), {});
  const Solution solution = solve(mission, mission.options(), true, {}, {});
  const record::NavState& truth = recording.truth.states.back();
  EXPECT_LT((solution.forward.last.nav.r_eb_e - truth.r_eb_e).norm(), 0.1);
  EXPECT_TRUE(solution.forward.last.P.allFinite());
}

INSTANTIATE_TEST_SUITE_P(RestDriveAndTurn, HourWithoutImu, testing::Values(15.0, 150.0, 200.0));

}  // namespace
}  // namespace coast::study
