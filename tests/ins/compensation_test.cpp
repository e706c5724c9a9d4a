#include "coast/ins/compensation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <stdexcept>
#include <vector>

#include "coast/geo/rotation.hpp"
#include "ins/motion.hpp"

namespace coast {
namespace {

record::ImuRecording recording(const test::Motion& motion, double rate_hz, double duration_s) {
  record::ImuRecording recording;
  const double dt = 1.0 / rate_hz;
  const auto n = static_cast<int>(std::lround(duration_s * rate_hz));
  for (int i = 0; i < n; ++i) {
    const ins::RawIncrement raw = motion.increment(i * dt, (i + 1) * dt);
    recording.samples.push_back({geo::GpsTime::from_week(2200, 100.0 + (i + 1) * dt), dt, raw.dtheta, raw.dv});
  }
  return recording;
}

ins::RawIncrement raw(const record::ImuSample& sample) {
  return {sample.dt, sample.dtheta, sample.dv};
}

struct Errors {
  double attitude = 0.0;  // rad, largest
  double velocity = 0.0;  // m/s, largest
};

// Chains the increments of intervals first..last from the truth at the start of `first`.
Errors chain(const test::Motion& motion, double dt, std::size_t first, std::size_t last,
             const std::function<ins::BodyIncrement(std::size_t)>& increment) {
  const auto start = static_cast<double>(first) * dt;
  Eigen::Quaterniond q = motion.q_b_i(start);
  Eigen::Vector3d v = motion.v_i(start);
  Errors errors;
  for (std::size_t i = first; i <= last; ++i) {
    const ins::BodyIncrement body = increment(i);
    const double t = static_cast<double>(i + 1) * dt;
    v += q * body.u;
    q = (q * geo::quaternion_from_rotation_vector(body.phi)).normalized();
    errors.attitude = std::max(errors.attitude, geo::rotation_vector(motion.q_b_i(t).conjugate() * q).norm());
    errors.velocity = std::max(errors.velocity, (v - motion.v_i(t)).norm());
  }
  return errors;
}

Errors two_sample_errors(const test::Motion& motion, double rate_hz, double duration_s) {
  const record::ImuRecording body = recording(motion, rate_hz, duration_s);
  return chain(motion, 1.0 / rate_hz, 1, body.samples.size() - 1,
               [&](std::size_t i) { return ins::compensate_two_sample(raw(body.samples[i - 1]), raw(body.samples[i])); });
}

// Without the ends, whose one-sided windows have errors of their own.
Errors chebyshev_errors(const test::Motion& motion, double rate_hz, double duration_s) {
  record::ImuRecording body = recording(motion, rate_hz, duration_s);
  ins::compensate_chebyshev(body);
  return chain(motion, 1.0 / rate_hz, ins::kCompensationWindow, body.samples.size() - ins::kCompensationWindow,
               [&](std::size_t i) {
                 return ins::BodyIncrement{body.samples[i].dt, body.samples[i].dtheta, body.samples[i].dv};
               });
}

TEST(TwoSample, ConstantRateAndForceAreExactAtAnySpeedOfTurn) {
  // 1 to 300 rad/s at 100 Hz: series and closed form of J(th). Rz(w t) f integrated by hand.
  for (double rate : {1e-9, 1.0, 20.0, 25.0, 300.0}) {
    const double th = rate * 0.01;
    const ins::RawIncrement current{0.01, {0.0, 0.0, th}, {0.1, 0.0, -0.2}};
    const ins::BodyIncrement body = ins::compensate_two_sample({0.01, current.dtheta, current.dv}, current);
    const double half = std::sin(th / 2.0) / (th / 2.0);
    EXPECT_NEAR((body.phi - current.dtheta).norm(), 0.0, 1e-16);
    // sin(th)/th and (1 - cos th)/th = sin(th/2)^2/(th/2); c (th' x dv + dv' x th) cancels for equal intervals.
    EXPECT_NEAR(body.u.x(), 0.1 * std::sin(th) / th, 1e-15) << rate;
    EXPECT_NEAR(body.u.y(), 0.1 * half * half * th / 2.0, 1e-15) << rate;
    EXPECT_NEAR(body.u.z(), -0.2, 1e-16);
  }
}

TEST(TwoSample, LinearRatesInUnequalIntervalsLeaveOnlyTheThirdOrder) {
  // Rates and forces linear in time: the error of an interval falls as T^5 (the next term of the Magnus series).
  const auto error = [](double T) {
    const auto omega = [](double t) { return Eigen::Vector3d(0.3 + 2.0 * t, -0.5 + 1.0 * t, 0.2 - 3.0 * t); };
    const auto force = [](double t) { return Eigen::Vector3d(1.0 - 4.0 * t, 2.0 + 5.0 * t, 9.0 + 3.0 * t); };
    const double before = 0.7 * T;
    const ins::RawIncrement previous{before, before * omega(-before / 2), before * force(-before / 2)};
    const ins::RawIncrement current{T, T * omega(T / 2), T * force(T / 2)};
    const ins::BodyIncrement body = ins::compensate_two_sample(previous, current);
    Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
    Eigen::Vector3d u = Eigen::Vector3d::Zero();
    const int n = 4000;  // midpoint rule: error near T^3 |b| / (24 n^2), far below what is tested
    for (int i = 0; i < n; ++i) {
      const double t = (i + 0.5) * T / n;
      const Eigen::Vector3d step = omega(t) * T / n;
      u += (q * geo::quaternion_from_rotation_vector(0.5 * step)) * (force(t) * T / n);
      q = q * geo::quaternion_from_rotation_vector(step);
    }
    return Errors{(geo::rotation_vector(q) - body.phi).norm(), (u - body.u).norm()};
  };
  const Errors coarse = error(0.2);
  const Errors fine = error(0.1);
  EXPECT_GT(coarse.attitude / fine.attitude, 20.0);  // 2^5 less what higher orders take; third-order error would give 8
  EXPECT_GT(coarse.velocity / fine.velocity, 12.0);  // th x (c..) terms: T^4
}

TEST(TwoSample, SplitPartsAddUpAndFollowTheLine) {
  const ins::RawIncrement previous{0.01, {0.01, -0.02, 0.03}, {0.1, 0.2, -0.1}};
  const ins::RawIncrement current{0.02, {0.03, -0.01, 0.02}, {0.3, 0.1, -0.2}};
  const ins::SplitIncrement parts = ins::split(previous, current, 0.3);
  EXPECT_NEAR((parts.first.dtheta + parts.second.dtheta - current.dtheta).norm(), 0.0, 1e-17);
  EXPECT_NEAR((parts.first.dv + parts.second.dv - current.dv).norm(), 0.0, 1e-16);
  EXPECT_DOUBLE_EQ(parts.first.dt + parts.second.dt, current.dt);
  // Integral of the line through the means at -5 ms and +10 ms over [0, 6 ms], x of dtheta: slope (1.5 - 1)/0.015.
  const double slope = (0.03 / 0.02 - 0.01 / 0.01) / 0.015;
  EXPECT_NEAR(parts.first.dtheta.x(), 0.006 * (0.03 / 0.02 + slope * (0.003 - 0.010)), 1e-17);
  // Without a previous interval, shares of a constant.
  EXPECT_NEAR((ins::split({}, current, 0.3).first.dv - 0.3 * current.dv).norm(), 0.0, 1e-17);
}

TEST(TwoSample, ClassicalConingLeavesTheKnownDriftAndChebyshevNone) {
  // Axis turning at 2 pi 5 rad/s, half-cone angle 2 deg: body z-rate must integrate to no net rotation.
  // Without compensation the drift is that of the cone, 2 zeta sin^2(a/2).
  const double a = 2.0 * M_PI / 180.0;
  const double zeta = 2.0 * M_PI * 5.0;
  const double dt = 0.01;
  const auto q_b_i = [&](double t) {
    return Eigen::Quaterniond(std::cos(a / 2), 0.0, std::sin(a / 2) * std::cos(zeta * t), std::sin(a / 2) * std::sin(zeta * t));
  };
  // Wu (2018): omega = zeta [-2 sin^2(a/2), -sin a sin(zeta t), sin a cos(zeta t)], integrated by hand.
  const auto dtheta = [&](double t0, double t1) {
    return Eigen::Vector3d(-2.0 * zeta * std::pow(std::sin(a / 2), 2) * (t1 - t0),
                           std::sin(a) * (std::cos(zeta * t1) - std::cos(zeta * t0)),
                           std::sin(a) * (std::sin(zeta * t1) - std::sin(zeta * t0)));
  };
  record::ImuRecording body;
  for (int i = 0; i < 1000; ++i)
    body.samples.push_back(
        {geo::GpsTime::from_week(2200, (i + 1) * dt), dt, dtheta(i * dt, (i + 1) * dt), Eigen::Vector3d::Zero()});
  const record::ImuRecording original = body;
  ins::compensate_chebyshev(body);
  Eigen::Quaterniond plain = q_b_i(0.2), two = plain, high = plain;
  double high_error = 0.0;
  for (std::size_t i = 20; i < 980; ++i) {
    plain = plain * geo::quaternion_from_rotation_vector(original.samples[i].dtheta);
    two = two * geo::quaternion_from_rotation_vector(
                    ins::compensate_two_sample(raw(original.samples[i - 1]), raw(original.samples[i])).phi);
    high = (high * geo::quaternion_from_rotation_vector(body.samples[i].dtheta)).normalized();
    high_error = std::max(high_error, geo::rotation_vector(q_b_i(static_cast<double>(i + 1) * dt).conjugate() * high).norm());
  }
  const auto drift = [&](const Eigen::Quaterniond& q) { return geo::rotation_vector(q_b_i(9.8).conjugate() * q).norm() / 9.6; };
  // Uncompensated: relative error of the coning integral is 1 - sin(x)/x with x = zeta dt (Savage 1998), first order in a^2.
  const double x = zeta * dt;
  EXPECT_NEAR(drift(plain), 2.0 * zeta * std::pow(std::sin(a / 2), 2) * (1.0 - std::sin(x) / x), 2e-3 * drift(plain));
  // Two samples leave 8 (f/F)^2 of that, the window of eleven (2.85 f/F)^10: f/F = 0.05.
  EXPECT_NEAR(drift(two) / drift(plain), 8.0 * 0.05 * 0.05, 0.002);
  EXPECT_LT(high_error, 2.0 * std::pow(2.85 * 0.05, 10) * 9.6 * drift(plain));
}

TEST(Chebyshev, ErrorsFallWithTheOrderOfTheMethod) {
  const test::Motion motion = test::shaking(5.0);
  const Errors two_100 = two_sample_errors(motion, 100.0, 10.0);
  const Errors two_200 = two_sample_errors(motion, 200.0, 10.0);
  EXPECT_NEAR(std::log2(two_100.attitude / two_200.attitude), 3.0, 0.5);
  EXPECT_NEAR(std::log2(two_100.velocity / two_200.velocity), 3.0, 0.5);
  const Errors high_50 = chebyshev_errors(motion, 50.0, 10.0);
  const Errors high_100 = chebyshev_errors(motion, 100.0, 10.0);
  EXPECT_GT(std::log2(high_50.attitude / high_100.attitude),
            9.5);  // 11 increments: 12th order, 10th while 0.3 samples per radian
  EXPECT_GT(std::log2(high_50.velocity / high_100.velocity), 9.5);
}

TEST(Chebyshev, SkiLikeMotionAt100HzIsExactForNavigation) {
  // A cap of 1e-6 rad and 1 mm/s after 600 s, shared out to 20 s, with a tenth of it for safety.
  const Errors errors = chebyshev_errors(test::shaking(5.0), 100.0, 20.0);
  EXPECT_LT(errors.attitude, 3e-9);
  EXPECT_LT(errors.velocity, 3e-6);
}

TEST(Chebyshev, EveryPositionInTheWindowIsCompensated) {
  const test::Motion motion = test::shaking(2.0);
  std::vector<ins::RawIncrement> window;
  for (int i = 0; i < 11; ++i) window.push_back(motion.increment(0.01 * i, 0.01 * (i + 1)));
  for (std::size_t i = 0; i < window.size(); ++i) {
    const ins::BodyIncrement body = ins::compensate_chebyshev(window, i);
    const double t = 0.01 * static_cast<double>(i);
    // One-sided ends: interpolation error of degree 11 near (0.13 rad per sample)^11/11 = 1.6e-11, times coupling below 0.1.
    EXPECT_LT((body.phi - geo::rotation_vector(motion.rotation(t, t + 0.01))).norm(), 1e-11) << i;
    EXPECT_LT((body.u - motion.velocity_change(t, t + 0.01)).norm(), 1e-10) << i;
  }
  EXPECT_THROW((void)ins::compensate_chebyshev(window, 11), std::invalid_argument);
  window.pop_back();
  EXPECT_THROW((void)ins::compensate_chebyshev(window, 0), std::invalid_argument);
}

TEST(Chebyshev, InPlaceEqualsTheFunctionOnEachWindow) {
  const record::ImuRecording original = recording(test::shaking(5.0), 100.0, 0.5);
  record::ImuRecording body = original;
  ins::compensate_chebyshev(body);
  const std::size_t n = original.samples.size();
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t start = std::clamp<std::size_t>(i < 5 ? 0 : i - 5, 0, n - 11);
    std::vector<ins::RawIncrement> window;
    for (std::size_t j = 0; j < 11; ++j) window.push_back(raw(original.samples[start + j]));
    const ins::BodyIncrement expected = ins::compensate_chebyshev(window, i - start);
    EXPECT_EQ(body.samples[i].dtheta, expected.phi) << i;
    EXPECT_EQ(body.samples[i].dv, expected.u) << i;
  }
}

TEST(Chebyshev, GapsAndChangesOfRateFallBackToTwoSamples) {
  record::ImuRecording original = recording(test::shaking(5.0), 100.0, 1.0);
  original.samples[30].dt = 0.02;  // a sample of another length
  for (std::size_t i = 30; i < 100; ++i) original.samples[i].t = original.samples[i].t + 0.01;
  for (std::size_t i = 60; i < 100; ++i) original.samples[i].t = original.samples[i].t + 5.0;  // missing time
  record::ImuRecording body = original;
  ins::compensate_chebyshev(body);
  const ins::BodyIncrement bridged = ins::compensate_two_sample(raw(original.samples[29]), raw(original.samples[30]));
  EXPECT_EQ(body.samples[30].dtheta, bridged.phi);
  EXPECT_EQ(body.samples[30].dv, bridged.u);
  // Behind the gap a run of its own: equal to the same 40 samples alone.
  record::ImuRecording alone;
  alone.samples.assign(original.samples.begin() + 60, original.samples.end());
  ins::compensate_chebyshev(alone);
  for (std::size_t i = 60; i < 100; ++i) EXPECT_EQ(body.samples[i].dtheta, alone.samples[i - 60].dtheta) << i;
  // Too short for a window: two samples throughout, the first alone.
  record::ImuRecording few = original;
  few.samples.resize(5);
  ins::compensate_chebyshev(few);
  EXPECT_EQ(few.samples[0].dv, ins::compensate_two_sample({}, raw(original.samples[0])).u);
  EXPECT_EQ(few.samples[4].dv, ins::compensate_two_sample(raw(original.samples[3]), raw(original.samples[4])).u);
}

TEST(Chebyshev, WhiteNoiseIsNotRectified) {
  // Independent noise of 0.01 rad/s and 0.1 m/s^2 a sample (a poor MEMS): the high-order terms must not turn it into a drift.
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal;
  record::ImuRecording body;
  const int n = 200000;
  Eigen::Vector3d sum_dtheta = Eigen::Vector3d::Zero(), sum_dv = Eigen::Vector3d::Zero();
  for (int i = 0; i < n; ++i) {
    const Eigen::Vector3d dtheta = 1e-4 * Eigen::Vector3d(normal(generator), normal(generator), normal(generator));
    const Eigen::Vector3d dv = 1e-3 * Eigen::Vector3d(normal(generator), normal(generator), normal(generator));
    body.samples.push_back({geo::GpsTime::from_week(2200, (i + 1) * 0.01), 0.01, dtheta, dv});
    sum_dtheta += dtheta;
    sum_dv += dv;
  }
  ins::compensate_chebyshev(body);
  for (const record::ImuSample& sample : body.samples) {
    sum_dtheta -= sample.dtheta;
    sum_dv -= sample.dv;
  }
  // Coning of independent noises has mean 0 and, per sample, sd below 1e-4 x 1e-4: over n samples 4 sd are 4 sqrt(n) 1e-8.
  EXPECT_LT(sum_dtheta.norm(), 4.0 * std::sqrt(n) * 1e-8);
  EXPECT_LT(sum_dv.norm(), 4.0 * std::sqrt(n) * 1e-7);
}

TEST(Chebyshev, BiasesComeOutAfterwards) {
  const test::Motion motion = test::shaking(3.0);
  const Eigen::Vector3d gyro_bias(0.01, -0.02, 0.015), accel_bias(0.2, -0.1, 0.3);
  record::ImuRecording clean = recording(motion, 200.0, 1.0);
  record::ImuRecording biased = clean;
  for (record::ImuSample& sample : biased.samples) {
    sample.dtheta += sample.dt * gyro_bias;
    sample.dv += sample.dt * accel_bias;
  }
  ins::compensate_chebyshev(clean);
  ins::compensate_chebyshev(biased);
  for (std::size_t i = 0; i < clean.samples.size(); ++i) {
    const record::ImuSample& with = biased.samples[i];
    const ins::BodyIncrement body = ins::without_bias({with.dt, with.dtheta, with.dv}, gyro_bias, accel_bias);
    // What is left: bias dt x (change of rate in the interval) / 12 and third-order terms. The first-order terms that
    // the correction holds are near b dt |dv| / 2 = 1e-5 m/s.
    EXPECT_LT((body.phi - clean.samples[i].dtheta).norm(), 2e-7) << i;
    EXPECT_LT((body.u - clean.samples[i].dv).norm(), 1e-6) << i;
  }
}

}  // namespace
}  // namespace coast
