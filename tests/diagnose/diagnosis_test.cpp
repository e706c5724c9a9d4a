// The search on missions in which something is concealed, by means that share no code with it: what is falsified is the
// configuration, or the recording sample by sample.

#include "coast/diagnose/diagnosis.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "diagnose/concealed.hpp"

namespace coast {
namespace {

using namespace diagnose;

/// The one effect found, by name and axis; nothing where there are more or others.
const Finding* only(const Diagnosis& d, std::string_view name, std::string_view axis) {
  if (d.findings.size() != 1) return nullptr;
  const Finding& f = d.findings.front();
  return f.hypothesis.effect->name == name && f.hypothesis.axis_name() == axis ? &f : nullptr;
}

std::string names(const Diagnosis& d) {
  std::string text;
  for (const Finding& f : d.findings)
    text += fmt::format("{} {} {} +- {}; ", f.hypothesis.effect->name, f.hypothesis.axis_name(), f.value, f.sd);
  return text;
}

TEST(Diagnosis, NothingIsMissingFromAnHonestMission) {
  const Diagnosis d = diagnose::diagnose(test::honest_mission(1), {}, {});
  EXPECT_TRUE(d.findings.empty()) << names(d);
  EXPECT_TRUE(d.noise.empty());
  EXPECT_GT(d.detectable_not_found.size(), 30U);
  EXPECT_FALSE(d.not_observable.empty());  // the base's coordinates at least
  EXPECT_NEAR(d.before.nis, 1.0, 0.1);
}

TEST(Diagnosis, AWrongLeverArmIsFoundAndItsSizeToo) {
  MissionInput input = test::honest_mission(2);
  input.setup.lever_arm_b.y() += 0.15;
  const Diagnosis d = diagnose::diagnose(input, {}, {});
  const Finding* f = only(d, "lever_arm_error", "y");
  ASSERT_NE(f, nullptr) << names(d);
  EXPECT_NEAR(f->value, -0.15, 4.0 * f->sd);
  EXPECT_GT(f->delta_log_likelihood, 100.0);
  EXPECT_GT(d.after.log_likelihood_per_epoch, d.before.log_likelihood_per_epoch);
  EXPECT_NEAR(d.modelled.setup.lever_arm_b.y(), -0.2, 4.0 * f->sd);
}

TEST(Diagnosis, ATimeOffsetIsFound) {
  MissionInput input = test::honest_mission(3);
  input.setup.time_offset_s = 0.03;
  const Diagnosis d = diagnose::diagnose(input, {}, {});
  const Finding* f = only(d, "gnss_time_offset", "");
  ASSERT_NE(f, nullptr) << names(d);
  EXPECT_NEAR(f->value, -0.03, 4.0 * f->sd);
}

TEST(Diagnosis, AScaleFactorOfAGyroIsFound) {
  MissionInput input = test::honest_mission(4);
  for (record::ImuSample& sample : input.imu.samples) sample.dtheta.z() *= 1.01;
  const Diagnosis d = diagnose::diagnose(input, {}, {});
  const Finding* f = only(d, "gyro_scale_factor", "z");
  ASSERT_NE(f, nullptr) << names(d);
  EXPECT_NEAR(f->value, 0.01, 4.0 * f->sd + 1e-4);  // 1.01 - 1 of what was measured, not of the truth
}

TEST(Diagnosis, ABiasThatJumpsIsFoundWithItsInstant) {
  MissionInput input = test::honest_mission(5);
  const geo::GpsTime jump = input.imu.samples.front().t + 170.0;
  for (record::ImuSample& sample : input.imu.samples)
    if (sample.t > jump) sample.dtheta.z() += 1e-3 * sample.dt;
  const Diagnosis d = diagnose::diagnose(input, {}, {});
  const Finding* f = only(d, "bias_step", "z");
  ASSERT_NE(f, nullptr) << names(d);
  EXPECT_EQ(f->hypothesis.effect->site, Site::kGyro);
  EXPECT_NEAR(f->value, 1e-3, 4.0 * f->sd);
  EXPECT_NEAR(*f->from - jump, 0.0, 2.0);
}

TEST(Diagnosis, AWrongFixIsFoundWithBothItsEnds) {
  MissionInput input = test::honest_mission(6);
  const geo::GpsTime from = input.gnss.fixes.front().t + 150.0;
  for (record::GnssFix& fix : input.gnss.fixes)
    if (fix.t >= from && fix.t < from + 30.0) fix.r_ea_e += Eigen::Vector3d(0.0, 0.0, 0.4);  // up and north here
  const Diagnosis d = diagnose::diagnose(input, {}, {});
  ASSERT_FALSE(d.findings.empty());
  for (const Finding& f : d.findings) {
    EXPECT_EQ(f.hypothesis.effect->name, "gnss_wrong_fix") << names(d);
    ASSERT_TRUE(f.from && f.to) << names(d);
    EXPECT_NEAR(*f.from - from, 0.0, 1.0);
    EXPECT_NEAR(*f.to - from, 30.0, 1.0);
  }
}

}  // namespace
}  // namespace coast
