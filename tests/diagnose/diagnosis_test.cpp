// The search on missions in which something is concealed, by means that share no code with it: what is falsified is the
// configuration, or the recording sample by sample.

#include "coast/diagnose/diagnosis.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "coast/geo/earth.hpp"
#include "diagnose/concealed.hpp"

namespace coast {
namespace {

using namespace diagnose;

using test::kWithoutTwins;
using test::names;
using test::only;

TEST(Diagnosis, NothingIsMissingFromAnHonestMission) {
  const Diagnosis d = diagnose::diagnose(test::honest_mission(1), kWithoutTwins, {});
  EXPECT_TRUE(d.findings.empty()) << names(d);
  EXPECT_TRUE(d.noise.empty());
  EXPECT_GT(d.detectable_not_found.size(), 30U);
  EXPECT_FALSE(d.not_observable.empty());  // the base's coordinates at least
  // Of what may begin at any time no smallest size is that of an instant by chance: a step in the mission's last second would
  // have to be hundreds of times as large.
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  for (const diagnose::Detectable& one : d.detectable_not_found) {
    if (one.hypothesis.effect->name != "bias_step" || one.hypothesis.effect->site != diagnose::Site::kAccel) continue;
    least = std::min(least, one.minimal);
    most = std::max(most, one.minimal);
  }
  EXPECT_GT(most, 0.0);
  EXPECT_LT(most, 10.0 * least);
  EXPECT_NEAR(d.before.nis, 1.0, 0.1);
}

TEST(Diagnosis, AWrongLeverArmIsFoundAndItsSizeToo) {
  MissionInput input = test::honest_mission(2);
  input.setup.lever_arm_b.y() += 0.15;
  const Diagnosis d = diagnose::diagnose(input, kWithoutTwins, {});
  const Finding* f = only(d, "lever_arm_error", "y");
  ASSERT_NE(f, nullptr) << names(d);
  EXPECT_NEAR(f->value, -0.15, 4.0 * f->sd);
  EXPECT_GT(f->delta_log_likelihood, 100.0);
  EXPECT_GT(d.after.log_likelihood_per_epoch, d.before.log_likelihood_per_epoch);
  EXPECT_NEAR(d.modelled.setup.lever_arm_b.y(), -0.2, 4.0 * f->sd);
}

// A receiver that is wrong for three seconds while the antenna is not where it is said to be: the jump back by itself looks
// like a slip of the antenna, and what comes after it too.
TEST(Diagnosis, AWrongLeverArmIsNotASlipBehindAWrongFix) {
  MissionInput input = test::honest_mission(14);
  input.setup.lever_arm_b.y() += 0.15;
  const geo::GpsTime begin = input.gnss.fixes.front().t + 60.0;
  for (record::GnssFix& fix : input.gnss.fixes)
    if (fix.t >= begin && fix.t < begin + 3.0)
      fix.r_ea_e += geo::C_n_e(geo::geodetic_from_ecef(fix.r_ea_e)) * Eigen::Vector3d(0.1, -0.1, 0.0);
  const Diagnosis d = diagnose::diagnose(input, kWithoutTwins, {});
  const auto lever_arm =
      std::ranges::find(d.findings, "lever_arm_error", [](const Finding& f) { return f.hypothesis.effect->name; });
  ASSERT_NE(lever_arm, d.findings.end()) << names(d);
  EXPECT_EQ(lever_arm->hypothesis.axis_name(), "y");
  EXPECT_NEAR(lever_arm->value, -0.15, 4.0 * lever_arm->sd);
  for (const Finding& f : d.findings) EXPECT_NE(f.hypothesis.effect->name, "antenna_mount_slip") << names(d);
}

// The first ten seconds on the move the receiver is behind by what the clocks differ at 0.7 times the speed then reached. A gap
// of the tags where that ends explains most of it with one number; what is there are the offset all the time and two jumps of
// the fixes.
TEST(Diagnosis, ATimeOffsetIsNotAGapWhereWrongFixesEnd) {
  test::MissionWithTruth mission = test::honest_mission_with_truth(21);
  MissionInput& input = mission.input;
  constexpr double kOffset = 0.05;  // s
  constexpr double kWrong = 10.0;   // s
  input.setup.time_offset_s = kOffset;
  const auto moves =
      std::ranges::find_if(mission.truth.states, [](const record::NavState& s) { return s.v_eb_e.norm() > 0.5; });
  const auto then = std::ranges::find_if(mission.truth.states, [&](const auto& s) { return s.t >= moves->t + kWrong; });
  ASSERT_NE(then, mission.truth.states.end());
  for (record::GnssFix& fix : input.gnss.fixes)
    if (fix.t >= moves->t && fix.t < then->t) fix.r_ea_e -= 0.7 * kOffset * then->v_eb_e;
  const Diagnosis d = diagnose::diagnose(input, kWithoutTwins, {});
  const auto offset =
      std::ranges::find(d.findings, "gnss_time_offset", [](const Finding& f) { return f.hypothesis.effect->name; });
  ASSERT_NE(offset, d.findings.end()) << names(d);
  EXPECT_NEAR(offset->value, -kOffset, 4.0 * offset->sd);
  for (const Finding& f : d.findings) EXPECT_NE(f.hypothesis.effect->name, "imu_timestamp_gap") << names(d);
  EXPECT_LT(d.runs, 300U);  // 149; several times as many where a relation that bends its own trajectory is kept
}

// By hand: differences 3, 1, 2: mean 2, sd of the mean 1 / sqrt(3).
TEST(Drift, IsFartherWhereItIsByHalfAndNotByChance) {
  const auto fit = [](const std::vector<double>& outages) {
    double squares = 0.0;
    for (const double d : outages) squares += d * d;
    return Fit{.outage_rms_m = std::sqrt(squares / static_cast<double>(outages.size())), .outages_m = outages};
  };
  const Fit before = fit({2.0, 3.0, 1.0});
  const Fit after = fit({5.0, 4.0, 3.0});
  const PairedDifference d = outage_difference(before, after);
  EXPECT_EQ(d.count, 3);
  EXPECT_NEAR(d.mean, 2.0, 1e-12);
  EXPECT_NEAR(d.sd, 1.0 / std::sqrt(3.0), 1e-12);
  EXPECT_TRUE(drifts_farther(before, after));
  EXPECT_FALSE(drifts_farther(after, before));
  EXPECT_FALSE(drifts_farther(before, fit({9.0, 1.0, 1.0})));  // one of them alone
  EXPECT_FALSE(drifts_farther(before, fit({2.5, 3.5, 1.5})));  // each of them, and little
  EXPECT_FALSE(drifts_farther(before, fit({9.0})));            // not the same outages
}

// Fixes of few satellites err three times as far as they say.
TEST(Diagnosis, AMisfitIsLocatedWhereSatellitesAreFew) {
  MissionInput input = test::honest_mission(17, 220.0);
  std::mt19937 generator(3);
  std::normal_distribution<double> error(0.0, 0.03);  // m
  for (std::size_t i = 0; i < input.gnss.fixes.size(); ++i) {
    record::GnssFix& fix = input.gnss.fixes[i];
    fix.satellites = i / 40 % 2 == 0 ? 12 : 5;  // by stretches of 20 s
    if (*fix.satellites == 5) fix.r_ea_e += Eigen::Vector3d(error(generator), error(generator), error(generator));
  }
  const Diagnosis d = diagnose::diagnose(input, {.twins = 5}, {});
  const auto at = [&](std::string_view name) { return std::ranges::find(d.twins, name, &TwinStatistic::name); };
  const auto satellites = at("NIS with more satellites less that with less");
  ASSERT_NE(satellites, d.twins.end());
  EXPECT_LT(satellites->real, satellites->q05);
  EXPECT_LT(satellites->p_adjusted, 0.2);  // 1/6 is the least that five twins can tell
  const auto north = at("NIS with more heading to the north less that with less");
  ASSERT_NE(north, d.twins.end());
  EXPECT_GT(std::abs(satellites->real), std::abs(north->real));
}

// The vehicle of the simulation rolls along its body's x axis; the configuration says elsewhere, and does not estimate it.
TEST(Diagnosis, AVehicleThatRollsElsewhereIsFound) {
  MissionInput input = test::honest_mission(16);
  input.setup.filter.vehicle.non_holonomic =
      estimate::NonHolonomic{.sd_lateral_mps = 0.1, .sd_vertical_mps = 1.0, .yaw = 0.08};  // it bobs by 0.2 m/s
  const Diagnosis d = diagnose::diagnose(input, kWithoutTwins, {});
  const Finding* f = only(d, "vehicle_mounting", "z");
  ASSERT_NE(f, nullptr) << names(d);
  EXPECT_NEAR(f->value, -0.08, 4.0 * f->sd);
  EXPECT_NEAR(d.modelled.setup.filter.vehicle.non_holonomic->yaw, 0.0, 4.0 * f->sd);
}

TEST(Diagnosis, ATimeOffsetIsFound) {
  MissionInput input = test::honest_mission(3);
  input.setup.time_offset_s = 0.03;
  const Diagnosis d = diagnose::diagnose(input, kWithoutTwins, {});
  const Finding* f = only(d, "gnss_time_offset", "");
  ASSERT_NE(f, nullptr) << names(d);
  EXPECT_NEAR(f->value, -0.03, 4.0 * f->sd);
}

// 0.3 s are beyond what is linear: lever arms and relations of signals explain some of it.
TEST(Diagnosis, ATimeOffsetThatIsFarOffIsFoundFromWhatTurnsTell) {
  MissionInput input = test::honest_mission(3);
  input.setup.time_offset_s = 0.3;
  const Diagnosis d = diagnose::diagnose(input, {.twins = 0, .time_offset_s = 0.02}, {});
  const Finding* f = only(d, "gnss_time_offset", "");
  ASSERT_NE(f, nullptr) << names(d);
  EXPECT_NEAR(f->value, -0.3, 4.0 * f->sd);
}

// With the stated noise every offset contradicts the fixes, and a wrong one may do so less.
TEST(Diagnosis, AWrongGuessOfTheOffsetIsNotTakenWhereNoiseIsStatedTooSmall) {
  MissionInput input = test::honest_mission(3);
  for (const noise::Sensor sensor : {noise::Sensor::kGyro, noise::Sensor::kAccel})
    input.setup.model = input.setup.model.with_white_noise_scaled(sensor, Eigen::Vector3d::Constant(0.02));
  input.setup.filter.auxiliary.time_offset_sd_s = 0.1;
  const Diagnosis d = diagnose::diagnose(input, {.twins = 0, .time_offset_s = 1.5}, {});
  EXPECT_TRUE(d.findings.empty()) << names(d);
  EXPECT_EQ(d.noise.size(), 2U) << names(d);
}

// A wandering bias explains a ramp nearly as well as a ramp does, and takes its place where it comes first.
TEST(Diagnosis, ARampAndALeverArmAreBothFound) {
  MissionInput input = test::honest_mission(12);
  constexpr double kSlope = 3e-6;  // rad/s^2: fifty times what is plausible of this grade
  for (record::ImuSample& sample : input.imu.samples)
    sample.dtheta.y() += kSlope * (sample.t - input.imu.samples.front().t) * sample.dt;
  input.setup.lever_arm_b.x() += 0.1;
  const Diagnosis d = diagnose::diagnose(input, kWithoutTwins, {});
  ASSERT_EQ(d.findings.size(), 2U) << names(d);
  EXPECT_TRUE(d.noise.empty());
  for (const Finding& f : d.findings) {
    const bool is_ramp = f.hypothesis.effect->name == "rate_ramp" && f.hypothesis.axis_name() == "y";
    EXPECT_TRUE(is_ramp || (f.hypothesis.effect->name == "lever_arm_error" && f.hypothesis.axis_name() == "x")) << names(d);
    EXPECT_NEAR(f.value, is_ramp ? kSlope : -0.1, 4.0 * f.sd);
  }
}

TEST(Diagnosis, AScaleFactorOfAGyroIsFound) {
  MissionInput input = test::honest_mission(4);
  for (record::ImuSample& sample : input.imu.samples) sample.dtheta.z() *= 1.01;
  const Diagnosis d = diagnose::diagnose(input, kWithoutTwins, {});
  const Finding* f = only(d, "gyro_scale_factor", "z");
  ASSERT_NE(f, nullptr) << names(d);
  EXPECT_NEAR(f->value, 0.01, 4.0 * f->sd + 1e-4);  // 1.01 - 1 of what was measured, not of the truth
}

TEST(Diagnosis, ABiasThatJumpsIsFoundWithItsInstant) {
  MissionInput input = test::honest_mission(5, 240.0);
  const geo::GpsTime jump = input.imu.samples.front().t + 120.0;
  for (record::ImuSample& sample : input.imu.samples)
    if (sample.t > jump) sample.dtheta.z() += 1e-3 * sample.dt;
  const Diagnosis d = diagnose::diagnose(input, kWithoutTwins, {});
  const Finding* f = only(d, "bias_step", "z");
  ASSERT_NE(f, nullptr) << names(d);
  EXPECT_EQ(f->hypothesis.effect->site, Site::kGyro);
  EXPECT_NEAR(f->value, 1e-3, 4.0 * f->sd);
  EXPECT_NEAR(*f->from - jump, 0.0, 2.0);
}

TEST(Diagnosis, AWrongFixIsFoundWithBothItsEnds) {
  MissionInput input = test::honest_mission(6, 240.0);
  const geo::GpsTime from = input.gnss.fixes.front().t + 100.0;
  for (record::GnssFix& fix : input.gnss.fixes)
    if (fix.t >= from && fix.t < from + 30.0) fix.r_ea_e += Eigen::Vector3d(0.0, 0.0, 0.4);  // up and north here
  const Diagnosis d = diagnose::diagnose(input, kWithoutTwins, {});
  ASSERT_EQ(d.findings.size(), 1U) << names(d);
  EXPECT_EQ(d.findings[0].hypothesis.effect->name, "gnss_wrong_fix") << names(d);
  for (const Finding& f : times_of(d.findings[0])) {
    ASSERT_TRUE(f.from && f.to) << names(d);
    EXPECT_NEAR(*f.from - from, 0.0, 1.0);
    EXPECT_NEAR(*f.to - from, 30.0, 1.0);
  }
}

/// The noise found, by name, sensor and axis.
const NoiseFinding* noise_named(const Diagnosis& d, std::string_view name, std::string_view sensor, std::string_view axis) {
  for (const NoiseFinding& f : d.noise)
    if (f.name == name && f.sensor == sensor && f.axis == axis) return &f;
  return nullptr;
}

// The factor by which a scale factor moves what is measured, on data that its size was not estimated from.
TEST(Diagnosis, WhatIsFoundHoldsOnHeldOutBlocks) {
  MissionInput input = test::honest_mission(15);
  for (record::ImuSample& sample : input.imu.samples) sample.dv.x() *= 1.01;
  // The receiver was on ten minutes before the IMU was: of those no block tells anything.
  std::vector<record::GnssFix> before(1200, input.gnss.fixes.front());
  for (std::size_t i = 0; i < before.size(); ++i) before[i].t = before[i].t + -0.5 * static_cast<double>(before.size() - i);
  input.gnss.fixes.insert(input.gnss.fixes.begin(), before.begin(), before.end());
  const Diagnosis d = diagnose::diagnose(input, kWithoutTwins, {});
  ASSERT_NE(only(d, "accel_scale_factor", "x"), nullptr) << names(d);
  ASSERT_TRUE(d.held_out.has_value());
  EXPECT_EQ(d.held_out->blocks, 10);  // 300 s
  EXPECT_GT(d.held_out->gain, 3.0 * d.held_out->gain_sd);
  EXPECT_GT(d.held_out->after_per_epoch, d.held_out->before_per_epoch);
  ASSERT_TRUE(d.findings.front().held_out_gain.has_value());
  EXPECT_NEAR(*d.findings.front().held_out_gain, d.held_out->gain, 1e-6);  // there is no other
}

// Vibration shakes one axis more than another. With one factor for all three the rest of it would be told as something else.
TEST(Diagnosis, NoiseOfOneAxisIsFoundAsNoiseOfThatAxis) {
  MissionInput input = test::honest_mission(12);
  constexpr double kTimes = 6.0;
  const double density = std::sqrt(input.setup.model.white_density(noise::Sensor::kGyro, 1).value);
  std::mt19937_64 engine(12);
  std::normal_distribution<double> normal;
  for (record::ImuSample& sample : input.imu.samples)
    sample.dtheta.y() += density * std::sqrt((kTimes * kTimes - 1.0) * sample.dt) * normal(engine);
  const Diagnosis d = diagnose::diagnose(input, kWithoutTwins, {});
  EXPECT_TRUE(d.findings.empty()) << names(d);
  const NoiseFinding* f = noise_named(d, "imu_white_noise", "gyro", "");
  ASSERT_NE(f, nullptr) << names(d);
  ASSERT_TRUE(f->by_axis.has_value());
  EXPECT_NEAR(f->by_axis->y() / kTimes, 1.0, 0.3);
  EXPECT_LT(f->by_axis->x(), 2.0);
  EXPECT_LT(f->by_axis->z(), 0.5 * kTimes);  // hardly seen: a drive turns the heading's error into little
  EXPECT_NEAR(d.after.nis, 1.0, 0.1);
}

// A stationary first-order process by its difference equation, sigma 2e-3 rad/s over 30 s: ten times the white noise's density.
TEST(Diagnosis, AWanderingBiasIsFoundAsNoise) {
  MissionInput input = test::honest_mission(8);
  std::mt19937_64 engine(8);
  std::normal_distribution<double> normal;
  constexpr double kSigma = 2e-3;
  const double phi = std::exp(-1.0 / 50.0 / 30.0);
  double bias = kSigma * normal(engine);
  for (record::ImuSample& sample : input.imu.samples) {
    bias = phi * bias + kSigma * std::sqrt(1.0 - phi * phi) * normal(engine);
    sample.dtheta.x() += bias * sample.dt;
  }
  const Diagnosis d = diagnose::diagnose(input, kWithoutTwins, {});
  const NoiseFinding* f = noise_named(d, "extra_gauss_markov_bias", "gyro", "x");
  if (f == nullptr) f = noise_named(d, "flicker_noise", "gyro", "x");  // 300 s hardly tell them apart
  ASSERT_NE(f, nullptr) << names(d);
  EXPECT_GT(f->delta_log_likelihood, 50.0);
  EXPECT_GT(f->value, kSigma / 4.0);
  EXPECT_LT(f->value, kSigma * 4.0);
  EXPECT_NEAR(d.after.nis, 1.0, 0.1);
  if (f->name != "extra_gauss_markov_bias") return;
  EXPECT_NEAR(std::log(f->value / kSigma), 0.0, 4.0 * f->sd / f->value);
  ASSERT_GT(f->time_sd_s, 0.0);
  EXPECT_NEAR(std::log(f->time_s / 30.0), 0.0, 4.0 * f->time_sd_s / f->time_s);
}

TEST(Diagnosis, AnOscillationIsFoundWithItsFrequency) {
  MissionInput input = test::honest_mission(9, 240.0);
  constexpr double kAmplitude = 0.05, kFrequency = 0.11;
  for (record::ImuSample& sample : input.imu.samples)
    sample.dv.y() += kAmplitude * std::sin(2.0 * geo::kPi * kFrequency * (sample.t - input.imu.samples.front().t)) * sample.dt;
  const Diagnosis d = diagnose::diagnose(input, kWithoutTwins, {});
  const Finding* f = only(d, "harmonic_disturbance", "y");
  ASSERT_NE(f, nullptr) << names(d);
  EXPECT_EQ(f->hypothesis.effect->site, Site::kAccel);
  EXPECT_NEAR(f->value, kAmplitude, 4.0 * f->sd);
  EXPECT_NEAR(f->hypothesis.effect->fixed.front().value, kFrequency, 0.5 / 240.0);  // half a line's width
}

TEST(Diagnosis, ARelationWithoutANameIsTold) {
  MissionInput input = test::honest_mission(10);
  for (record::ImuSample& sample : input.imu.samples)
    sample.dtheta.x() += 0.02 * (sample.dtheta.z() / sample.dt) * (sample.dv.x() / sample.dt) * sample.dt;
  const Diagnosis d = diagnose::diagnose(input, kWithoutTwins, {});
  const Finding* f = only(d, "unknown", "x");
  ASSERT_NE(f, nullptr) << names(d);
  EXPECT_EQ(f->hypothesis.effect->relation, "omega_z*f_x");
  EXPECT_NEAR(f->value, 0.02, 4.0 * f->sd);
  ASSERT_TRUE(f->stability.has_value());
  EXPECT_GT(*f->stability, 0.5);
}

// Far beyond what is plausible, so it is not looked for by name; but what is found is nothing else.
TEST(Diagnosis, ARelationThatHasANameIsToldByIt) {
  MissionInput input = test::honest_mission(12);
  constexpr double kCoefficient = 2e-4;
  for (record::ImuSample& sample : input.imu.samples)
    sample.dtheta.x() += kCoefficient * std::pow(sample.dv.x() / sample.dt, 2) * sample.dt;
  const Diagnosis d = diagnose::diagnose(input, kWithoutTwins, {});
  const Finding* f = only(d, "gyro_g2_sensitivity", "xx");
  ASSERT_NE(f, nullptr) << names(d);
  EXPECT_NEAR(f->value, kCoefficient, 4.0 * f->sd);
  const auto is_it = [&](const auto& one) {
    return one.hypothesis.effect == f->hypothesis.effect && one.hypothesis.axis == f->hypothesis.axis;
  };
  EXPECT_TRUE(std::ranges::none_of(d.not_observable, is_it));
  EXPECT_TRUE(std::ranges::none_of(d.detectable_not_found, is_it));
}

/// The base 0.3 m too far north and 0.2 m too high, the reference free of errors.
TEST(Diagnosis, AReferenceShowsThatTheBaseIsOff) {
  test::MissionWithTruth recorded = test::honest_mission_with_truth(13, 420.0);
  const DiagnosisOptions options{.twins = 0, .reference = Reference{&recorded.truth, Eigen::Vector3d::Zero()}};
  const Diagnosis honest = diagnose::diagnose(recorded.input, options, {});
  EXPECT_TRUE(honest.reference_used);
  EXPECT_TRUE(honest.findings.empty()) << names(honest);
  const auto is_base = [](const auto& one) { return one.hypothesis.effect->name == "base_coordinate_offset"; };
  EXPECT_EQ(std::ranges::count_if(honest.detectable_not_found, is_base), 3);
  EXPECT_EQ(std::ranges::count_if(honest.not_observable, is_base), 0);

  const Eigen::Vector3d off_n(0.3, 0.0, -0.2);
  for (record::GnssFix& fix : recorded.input.gnss.fixes) fix.r_ea_e += geo::C_n_e(geo::geodetic_from_ecef(fix.r_ea_e)) * off_n;
  const Diagnosis d = diagnose::diagnose(recorded.input, options, {});
  ASSERT_EQ(d.findings.size(), 2U) << names(d);
  for (const Finding& f : d.findings) {
    EXPECT_TRUE(is_base(f));
    EXPECT_NEAR(f.value, off_n(f.hypothesis.axis), 4.0 * f.sd);
    EXPECT_LT(f.sd, 0.01);
  }
  EXPECT_FALSE(diagnose::diagnose(recorded.input, kWithoutTwins, {}).reference_used);

  // SelectedEffect out as a file names it.
  std::vector<NamedEffect> named;
  for (const Finding& f : d.findings)
    named.push_back({.effect = f.hypothesis.effect, .axis = f.hypothesis.axis, .value = f.value, .from_s = {}, .to_s = {}});
  const MissionInput mended = without(named, recorded.input, {});
  for (std::size_t i = 0; i < mended.gnss.fixes.size(); ++i) {
    const Eigen::Vector3d& r_e = mended.gnss.fixes[i].r_ea_e;
    const Eigen::Vector3d moved_n =
        geo::C_n_e(geo::geodetic_from_ecef(r_e)).transpose() * (recorded.input.gnss.fixes[i].r_ea_e - r_e);
    ASSERT_LT((moved_n - off_n).norm(), 0.02);
  }
}

// Steps of fourteen times the noise: as long as the car drives evenly the force stays within one, and the error wanders.
TEST(Diagnosis, WhatWandersBetweenCoarseStepsIsToldAsThem) {
  MissionInput input = test::honest_mission(15);
  constexpr double kStep = 0.06;
  for (record::ImuSample& sample : input.imu.samples)
    sample.dv.x() = kStep * std::round(sample.dv.x() / sample.dt / kStep) * sample.dt;
  const Diagnosis d = diagnose::diagnose(input, kWithoutTwins, {});
  const NoiseFinding* f = noise_named(d, "quantisation", "accel", "x");
  ASSERT_NE(f, nullptr) << names(d);
  EXPECT_NEAR(f->value, kStep, 1e-6);
  EXPECT_GT(f->delta_log_likelihood, 20.0);
  EXPECT_EQ(noise_named(d, "extra_gauss_markov_bias", "accel", "x"), nullptr);
  EXPECT_EQ(noise_named(d, "flicker_noise", "accel", "x"), nullptr);
  for (const Finding& found : d.findings) {
    if (found.hypothesis.effect->site != Site::kAccel || !found.hypothesis.axis_name().starts_with('x')) continue;
    ASSERT_FALSE(found.alternatives.empty());
    EXPECT_EQ(found.alternatives.front().name, "quantisation");
  }
}

TEST(Diagnosis, ASaturatedGyroIsFoundAndMended) {
  MissionInput input = test::honest_mission(11);
  double largest = 0.0;
  for (const record::ImuSample& sample : input.imu.samples)
    largest = std::max(largest, std::abs(sample.dtheta.z() / sample.dt));
  const double limit = 0.7 * largest;
  for (record::ImuSample& sample : input.imu.samples)
    sample.dtheta.z() = std::clamp(sample.dtheta.z() / sample.dt, -limit, limit) * sample.dt;
  const Diagnosis d = diagnose::diagnose(input, kWithoutTwins, {});
  const NoiseFinding* f = noise_named(d, "saturation", "gyro", "z");
  ASSERT_NE(f, nullptr) << names(d);
  EXPECT_NEAR(std::abs(f->value), limit, 1e-9);
  EXPECT_GT(f->delta_log_likelihood, 100.0);
  EXPECT_LT(d.after.outage_rms_m, d.before.outage_rms_m);
}

}  // namespace
}  // namespace coast
