// Findings in plain words.

#include "coast/diagnose/sentence.hpp"

#include <gtest/gtest.h>

namespace coast {
namespace {

using namespace diagnose;

Finding of(std::string_view name, Site site, Eigen::Index axis, double value, double sd) {
  const auto effect = std::ranges::find_if(catalogue(), [&](const Effect& e) { return e.name == name && e.site == site; });
  EXPECT_NE(effect, catalogue().end()) << name;
  Finding finding;
  finding.hypothesis = {&*effect, axis, 1e3};
  finding.value = value;
  finding.sd = sd;
  return finding;
}

// Sizes in the units of results turned into those that people say, by hand: 1 rad/s = 206264.8 deg/h, 9.80665 m/s^2 = 1000 mg.
TEST(Sentence, SaysSizeAndDirection) {
  EXPECT_EQ(sentence(of("lever_arm_error", Site::kAntenna, 1, 0.28, 0.012)),
            "The antenna is 28.0 +- 1.2 cm further right than stated.");
  EXPECT_EQ(sentence(of("lever_arm_error", Site::kAntenna, 2, -1.234, 0.03)),
            "The antenna is 1.23 +- 0.03 m further up than stated.");
  EXPECT_EQ(sentence(of("gnss_time_offset", Site::kClock, 0, -0.0702, 0.0009)),
            "The fixes are valid 70.2 +- 0.9 ms later than their tags say.");
  EXPECT_EQ(sentence(of("gyro_scale_factor", Site::kGyro, 2, -0.0123, 0.0004)),
            "Gyro z measures rotations 1.23 +- 0.04 % too small.");
  EXPECT_EQ(sentence(of("gyro_misalignment", Site::kGyro, 4, 0.01745329, 0.0017)),
            "Gyro z leans towards axis x by 1.00 +- 0.10 deg.");
  EXPECT_EQ(sentence(of("bias_step", Site::kAccel, 0, 0.0490333, 0.00294)),
            "The bias of accelerometer x jumped by 5.0 +- 0.3 mg.");
  EXPECT_EQ(sentence(of("rate_ramp", Site::kGyro, 1, 1.0 / 206264.806 / 3600.0, 0.0)),
            "The bias of gyro y grows by 1.00 deg/h each hour.");
  EXPECT_EQ(sentence(of("gyro_g_sensitivity", Site::kGyro, 7, 1.0 / 206264.806 / 9.80665, 0.0)),
            "Gyro z answers to forces along y with 1.00 deg/h for each g.");
  EXPECT_EQ(sentence(of("imu_clock_drift", Site::kClock, 0, 2.5e-5, 1e-6)),
            "The clock of the IMU runs 25.0 +- 1.0 ppm too fast.");
  EXPECT_EQ(sentence(of("gravity_disturbance", Site::kGravity, 0, -3e-4, 2e-5)),
            "Gravity pulls 30 +- 2 mGal further south than the ellipsoid's.");
}

TEST(Sentence, SaysWhen) {
  Finding slip = of("gnss_wrong_fix", Site::kGnss, 0, -0.4, 0.02);
  slip.from = geo::GpsTime::from_week(2374, 1234.5);
  EXPECT_EQ(sentence(slip), "The fixes are 40 +- 2 cm too far south, from 1234.5 s of week on.");
  slip.to = geo::GpsTime::from_week(2374, 1300.0);
  EXPECT_EQ(sentence(slip), "The fixes are 40 +- 2 cm too far south, from 1234.5 to 1300.0 s of week.");
}

TEST(Sentence, SaysHowOften) {
  const auto fix = [](Eigen::Index axis, double value, double second) {
    Finding f = of("gnss_wrong_fix", Site::kGnss, axis, value, 0.01);
    f.from = geo::GpsTime::from_week(2374, second);
    return f;
  };
  Finding all = fix(0, 0.14, 1000.0);
  all.further = {fix(1, -0.20, 1300.0), fix(2, 0.10, 1000.4)};
  EXPECT_EQ(sentence(all), "The fixes are wrong 2 times, by up to 20.0 +- 1.0 cm.");  // components of one jump count once
  all.further.erase(all.further.begin());
  EXPECT_EQ(sentence(all), "The fixes are wrong once, by up to 14.0 +- 1.0 cm.");
  const std::vector<Finding> times = times_of(all);
  ASSERT_EQ(times.size(), 2U);
  EXPECT_EQ(sentence_of_one(times[1]), "The fixes are 10.0 +- 1.0 cm too far down, from 1000.4 s of week on.");
  EXPECT_TRUE(times[0].further.empty());
}

TEST(Sentence, SaysWhatIsImplausible) {
  Finding scale = of("accel_scale_factor", Site::kAccel, 2, 0.544, 0.015);
  scale.hypothesis.plausible = 0.01;
  EXPECT_EQ(sentence(scale),
            "Accelerometer z measures forces 54.4 +- 1.5 % too large. So much is implausible: look for another cause too.");
  scale.value = 0.29;
  EXPECT_EQ(sentence(scale), "Accelerometer z measures forces 29.0 +- 1.5 % too large.");
  Finding arm = of("lever_arm_error", Site::kAntenna, 0, 5.0, 0.1);  // whoever measured it may have read another scale
  arm.hypothesis.plausible = 0.1;
  EXPECT_EQ(sentence(arm), "The antenna is 5.00 +- 0.10 m further forward than stated.");
}

TEST(Sentence, OfEveryEffectIsComplete) {
  for (const Effect& effect : catalogue()) {
    EXPECT_TRUE(effect.ways.size() <= 1 || effect.ways.size() == effect.axes.size()) << effect.name;
    for (Eigen::Index axis = 0; axis < static_cast<Eigen::Index>(effect.axes.size()); ++axis)
      for (const double value : {1e-3, -1e-3}) {
        const std::string text = sentence(of(effect.name, effect.site, axis, value, 1e-4));
        EXPECT_EQ(text.find_first_of("{}"), std::string::npos) << text;
        EXPECT_TRUE(text.ends_with('.')) << text;
        EXPECT_NE(text.find("+-"), std::string::npos) << text;
      }
  }
  for (const EffectPtr& form :
       {harmonic_disturbance(Site::kGyro, 1, 0.25, 0.1), unknown_relation(Site::kAccel, 0, "omega_z*f_x")}) {
    Finding finding;
    finding.hypothesis = {form.get(), 0, 1.0};
    finding.value = 0.01;
    finding.sd = 0.001;
    const std::string text = sentence(finding);
    EXPECT_EQ(text.find_first_of("{}"), std::string::npos) << text;
  }
}

TEST(Sentence, OfNoiseSaysWhatErrs) {
  NoiseFinding factor{
      .name = "gnss_sd_optimistic", .sensor = "gnss", .axis = "d", .parameter = "factor", .unit = "1", .value = 1.84};
  EXPECT_EQ(sentence(factor), "The vertical errors of the fixes are 1.8 times what is stated.");
  NoiseFinding wandering{.name = "extra_gauss_markov_bias",
                         .sensor = "gyro",
                         .axis = "y",
                         .parameter = "sigma",
                         .unit = "rad/s",
                         .value = 4.848137e-5,
                         .sd = 4.9e-6,
                         .time_s = 30.0,
                         .meaning = "The bias wanders."};
  EXPECT_EQ(sentence(wandering), "Gyro y: The bias wanders (sigma 10.0 +- 1.0 deg/h over about 30 s).");
}

// Only what the paired outages show counts as a gain.
TEST(Sentence, TellsTheGainOfOutages) {
  Diagnosis d;
  EXPECT_EQ(consequence(d), "");
  d.findings.push_back(of("lever_arm_error", Site::kAntenna, 0, 0.1, 0.01));
  EXPECT_EQ(consequence(d), "");  // no outages
  d.before.outage_rms_m = 0.74;
  d.after.outage_rms_m = 0.51;
  d.outage_change = {.count = 9, .mean = -0.2, .sd = 0.05};
  EXPECT_EQ(consequence(d), "With all of this corrected, outages of 20 s drift 0.51 m and not 0.74 m.");
  d.outage_change.sd = 0.15;
  EXPECT_EQ(consequence(d), "With all of this corrected, outages of 20 s drift 0.51 m, before 0.74 m: within chance the same.");
  d.after.outage_rms_m = 0.9;
  d.outage_change = {.count = 9, .mean = 0.2, .sd = 0.05};
  EXPECT_EQ(consequence(d), "With all of this corrected, outages of 20 s drift 0.90 m and not 0.74 m: farther.");
}

}  // namespace
}  // namespace coast
