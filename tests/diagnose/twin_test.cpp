// Twins: the same motion, errors as the model says.

#include "coast/diagnose/twin.hpp"

#include <gtest/gtest.h>

#include "coast/study/solution.hpp"
#include "diagnose/concealed.hpp"

namespace coast {
namespace {

using namespace diagnose;

/// A mission, its smoothed trajectory at IMU epochs, and its innovations.
struct Solved {
  std::vector<record::NavState> path;
  double nis = 0.0;
};
Solved solved(const MissionInput& input) {
  const study::PreparedMission mission(input.imu, input.gnss, input.setup, {});
  Solved result;
  study::SolutionOutputs outputs;
  outputs.smoothed = [&](const record::TrajectoryEpoch& epoch) { result.path.push_back(epoch.nav); };
  const study::Solution solution = study::solve(mission, mission.options(), true, outputs, {});
  double sum = 0.0, dof = 0.0;
  for (const estimate::InnovationRecord& r : solution.forward.innovations) {
    sum += r.nis;
    dof += r.dof;
  }
  result.nis = sum / dof;
  return result;
}

// Over 1700 innovations of three components the mean of NIS/dof has a standard deviation of sqrt(2/5100) = 0.02.
TEST(Twin, ErrsAsTheModelSays) {
  const MissionInput input = test::honest_mission(21);
  const Solved recording = solved(input);
  const MissionInput one = twin(recording.path, input, 5);
  EXPECT_EQ(one.imu.samples.size(), recording.path.size() - 1);
  EXPECT_NEAR(solved(one).nis, 1.0, 0.08);
}

// A state behind a gap that was found with the recording's fixes says nothing of the twin's.
TEST(Twin, FindsItsStateBehindGapsItself) {
  MissionInput input = test::honest_mission(21, 220.0);
  const std::vector<record::NavState> path = solved(input).path;
  input.setup.restarts = {{path[path.size() / 2], Eigen::Vector3d::Ones(), Eigen::Vector3d::Ones(), {}}};
  EXPECT_FALSE(twin(path, input, 5).setup.restarts);
}

// Sensors without errors and fixes of a nanometre: the filter has nothing to correct, so increments and fixes belong together.
TEST(Twin, IsOneMotion) {
  MissionInput input = test::honest_mission(22);
  const Solved recording = solved(input);
  for (record::GnssFix& fix : input.gnss.fixes) {
    fix.position_cov_n = 1e-18 * Eigen::Matrix3d::Identity();
    fix.velocity->cov_n = 1e-18 * Eigen::Matrix3d::Identity();
  }
  input.setup.model = noise::ImuErrorModel::of("perfect", 50.0, {}, {});
  const MissionInput one = twin(recording.path, input, 1);
  record::NavState nav = recording.path.front();
  ins::Strapdown strapdown(nav);
  ins::RawIncrement before;
  std::size_t fix = 0;
  while (fix < one.gnss.fixes.size() && one.gnss.fixes[fix].t <= nav.t) ++fix;
  double largest = 0.0;
  for (const record::ImuSample& sample : one.imu.samples) {
    const record::NavState last = strapdown.state();
    const ins::RawIncrement now{sample.dt, sample.dtheta, sample.dv};
    strapdown.step(ins::compensate_two_sample(before, now));
    strapdown.set_time(sample.t);
    before = now;
    while (fix < one.gnss.fixes.size() && one.gnss.fixes[fix].t <= sample.t) {
      const double s = (one.gnss.fixes[fix].t - last.t) / sample.dt;
      const record::NavState& next = strapdown.state();
      const Eigen::Vector3d r = (1.0 - s) * last.r_eb_e + s * next.r_eb_e;
      const Eigen::Matrix3d C = last.q_b_e.slerp(s, next.q_b_e).toRotationMatrix();
      largest = std::max(largest, (one.gnss.fixes[fix].r_ea_e - r - C * input.setup.lever_arm_b).norm());
      ++fix;
    }
  }
  // The straight line between epochs leaves a T^2/8 = 0.15 mm at 3 m/s^2 and 50 Hz.
  EXPECT_LT(largest, 3e-4);
  // Attitude and velocity are those of the path, however far.
  EXPECT_LT((strapdown.state().v_eb_e - recording.path.back().v_eb_e).norm(), 1e-6);
  EXPECT_LT(strapdown.state().q_b_e.angularDistance(recording.path.back().q_b_e), 1e-8);
}

}  // namespace
}  // namespace coast
