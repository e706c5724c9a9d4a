// Aiding sensors: design matrices against finite differences, the held heading against the dense joint Gaussian and against
// Monte Carlo, scale and delay of an odometer against what was simulated.

#include "coast/estimate/aid.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "coast/estimate/smoother.hpp"
#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "coast/io/yaml.hpp"
#include "coast/noise/chi_square.hpp"
#include "coast/record/error.hpp"
#include "coast/simulate/aids.hpp"
#include "coast/simulate/motions.hpp"
#include "estimate/mission.hpp"
#include "support/support.hpp"

namespace coast {
namespace {

using namespace estimate;
using geo::kDegree;

struct ConfiguredAid {
  std::string name;
  std::shared_ptr<const Aid> aid;
};

ConfiguredAid aid_of(const std::string& yaml) {
  const config::Node node = io::parse_yaml(yaml, "run.yaml");
  const std::string name = node.at("kind").text();
  const auto kind = std::ranges::find(aid_kinds(), name, &AidKind::name);
  return {name, kind->from(node)};
}

/// A kind, and what it measures in the test's state, roughly.
struct Measured {
  const char* yaml;
  Eigen::Vector3d value;
  Eigen::Vector3d sd;
};

AuxiliaryStates with_states_of(const ConfiguredAid& aid) {
  AuxiliaryStates states;
  states.aids = {{aid.name, aid.aid->states()}};
  return states;
}

class Aids : public testing::TestWithParam<Measured> {
 protected:
  Aids()
      : aid_(aid_of(GetParam().yaml)),
        layout_(test::error_model(test::kFullModel), geo::rotation_matrix({0.2, 2.8, -0.7}), with_states_of(aid_)) {}

  [[nodiscard]] FilterState random_state(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    FilterState state;
    state.nav = test::weaving(60.0).nav_state(test::mission_start(), 5.0 + static_cast<double>(seed));
    state.nav.q_b_e =
        state.nav.q_b_e * geo::quaternion_from_rotation_vector(0.2 * Eigen::Vector3d(test::normal_vector(3, random)));
    state.P = layout_.initial_covariance();
    state.x = state.P.diagonal().cwiseSqrt().cwiseProduct(test::normal_vector(layout_.size(), random));
    omega_ = 0.8 * test::normal_vector(3, random);
    C_n_e_ = geo::C_n_e(geo::geodetic_from_ecef(state.nav.r_eb_e));
    return state;
  }
  [[nodiscard]] Linearised linearised(const FilterState& state, const Eigen::VectorXd& x0) const {
    const Eigen::Vector3d omega = test::rate_at(layout_, omega_, x0, state);
    const UpdateContext context{layout_, {0.4, -0.6, -1.3}, omega, C_n_e_};
    const record::AidSample sample{state.nav.t, GetParam().value, GetParam().sd};
    return *aid_.aid->linearise(sample, state, context, layout_.aids().front());
  }

  ConfiguredAid aid_;
  StateLayout layout_;
  Eigen::Vector3d omega_;
  Eigen::Matrix3d C_n_e_;
};

TEST_P(Aids, DesignAgreesWithFiniteDifferencesOfTheInnovation) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const FilterState state = random_state(seed);
    const Linearised m = linearised(state, state.x);
    Eigen::VectorXd step = Eigen::VectorXd::Constant(layout_.size(), 1e-3);
    step.segment<3>(kPos).setConstant(1.0);
    step.segment<3>(kPsi).setConstant(1e-4);
    const auto innovation_with = [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
      FilterState moved = state;
      remove_error(-step.cwiseProduct(d), moved.nav, moved.x);
      return linearised(moved, state.x).nu;
    };
    const Eigen::MatrixXd numeric =
        -test::finite_difference(innovation_with, layout_.size(), 1.0) * step.cwiseInverse().asDiagonal();
    for (int column = 0; column < layout_.size(); ++column) {
      // Third order of the step, and the rounding of coordinates of 4e6 m.
      const double rounding = (column < kVel ? 4e-9 : 2e-9) / step(column);
      const double allowed = 2e-6 * numeric.norm() + rounding;
      EXPECT_LE((m.H.col(column) - numeric.col(column)).norm(), allowed) << aid_.name << " column " << column;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, Aids,
    testing::Values(Measured{"{kind: odometer, point_m: [-1.1, 0.3, 0.9]}", {12.0, 0.0, 0.0}, {0.1, 0.0, 0.0}},
                    Measured{"{kind: odometer, point_m: [-0.9, 0.2, 0.7]}", {0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}},
                    Measured{
                        "{kind: heading, baseline_m: [1, 0.4, -0.1], offset_sd_deg: 3}", {0.7, 0.0, 0.0}, {0.01, 0.0, 0.0}},
                    Measured{"{kind: baseline, baseline_m: [1.2, 0.4, -0.1]}", {0.7, 0.9, 0.1}, {0.01, 0.01, 0.02}},
                    Measured{"{kind: height, point_m: [0.2, 0.3, -1.5]}", {402.0, 0.0, 0.0}, {0.3, 0.0, 0.0}},
                    Measured{"{kind: position, point_m: [0.2, 0.3, -1.5]}", {4.35e6, 5e5, 4.6e6}, {0.05, 0.05, 0.05}}),
    [](const auto& kind) {
      const std::string yaml = kind.param.yaml;
      return yaml.substr(7, yaml.find_first_of(",}") - 7) + (kind.param.value.isZero() ? "_standing" : "");
    });

// An innovation is a rotation vector, and H its derivative where it is small: there nu = -psi and H = I to first order. The
// errors of second order are the squares of these angles, 2e-9.
TEST(AttitudeAid, InnovationOfASmallErrorIsThatErrorAndHIsItsDerivative) {
  const ConfiguredAid attitude = aid_of("{kind: attitude}");
  const StateLayout layout(test::error_model(test::kIndustrialModel), Eigen::Matrix3d::Identity(), {});
  FilterState truth;
  truth.nav = test::weaving(60.0).nav_state(test::mission_start(), 17.0);
  truth.x = Eigen::VectorXd::Zero(layout.size());
  const Eigen::Matrix3d C_n_e = geo::C_n_e(geo::geodetic_from_ecef(truth.nav.r_eb_e));
  const Eigen::Matrix3d C_b_n = C_n_e.transpose() * truth.nav.q_b_e.toRotationMatrix();
  // Euler angles by their definition, without the functions of the room geo.
  const record::AidSample sample{
      truth.nav.t,
      {std::atan2(C_b_n(2, 1), C_b_n(2, 2)), -std::asin(C_b_n(2, 0)), std::atan2(C_b_n(1, 0), C_b_n(0, 0))},
      {0.01, 0.01, 0.01}};
  const UpdateContext context{layout, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), C_n_e};
  for (const Eigen::Vector3d& psi : {Eigen::Vector3d(3e-5, 0.0, 0.0), Eigen::Vector3d(0.0, -3e-5, 0.0),
                                     Eigen::Vector3d(0.0, 0.0, 3e-5), Eigen::Vector3d(2e-5, -3e-5, 1e-5)}) {
    FilterState state = truth;
    Eigen::VectorXd d = Eigen::VectorXd::Zero(layout.size());
    d.segment<3>(kPsi) = psi;
    remove_error(-d, state.nav, state.x);
    const auto m = attitude.aid->linearise(sample, state, context, 0);
    EXPECT_LE((m->nu + psi).norm(), 2e-9);
    EXPECT_LE((m->nu + m->H * d).norm(), 2e-9);
  }
}

// The interval's noise is in the state too: covariance and gain from the joint Gaussian of the state before, the noise and the
// random walk that the heading is allowed.
TEST(HeadingHold, GainAndCovarianceAreThoseOfTheJointGaussian) {
  const StateLayout layout(test::error_model(test::kIndustrialModel), Eigen::Matrix3d::Identity(), {});
  const int n = layout.size();
  std::mt19937_64 random(3);
  const Eigen::MatrixXd before = 1e-4 * test::random_covariance(n, random);
  const Eigen::Quaterniond q(Eigen::Vector4d(test::normal_vector(4, random)).normalized());
  constexpr double kSeconds = 0.5;
  // psi_k = Phi psi + T C x_gyro + w: biases stay, the rest of the transition does not matter here.
  Eigen::MatrixXd Phi = Eigen::MatrixXd::Identity(n, n);
  Phi.block<3, 3>(kPsi, kPsi) -= kSeconds * geo::skew({0.0, 0.0, geo::kEarthRate});
  Phi.block(kPsi, kNav, 3, 3) = kSeconds * q.toRotationMatrix();
  Eigen::Matrix<double, kNav, kNav> Q = 1e-6 * test::random_covariance(kNav, random);
  const Eigen::Matrix3d C_n_e = geo::C_n_e({0.8, 0.1, 0.0});
  const Eigen::RowVector3d u = C_n_e.col(2).transpose();
  constexpr double kWalk = 3e-4;  // rad/sqrt(s)

  // Everything as linear functions of s = (d_{k-1}, w, v).
  Eigen::MatrixXd joint = Eigen::MatrixXd::Zero(n + kNav + 1, n + kNav + 1);
  joint.topLeftCorner(n, n) = before;
  joint.block<kNav, kNav>(n, n) = Q;
  joint(n + kNav, n + kNav) = kWalk * kWalk * kSeconds;
  Eigen::MatrixXd of_d = Eigen::MatrixXd::Zero(n, n + kNav + 1);
  of_d.leftCols(n) = Phi;
  of_d.block<kNav, kNav>(0, n).setIdentity();
  Eigen::MatrixXd of_nu = -u * of_d.middleRows<3>(kPsi);
  of_nu.block<1, 3>(0, kPsi) += u;
  of_nu(0, n + kNav) = 1.0;
  const Eigen::MatrixXd S = of_nu * joint * of_nu.transpose();
  const Eigen::MatrixXd gain = -of_d * joint * of_nu.transpose() * S.inverse();

  FilterState state;
  state.nav.q_b_e = geo::quaternion_from_rotation_vector(1e-4 * Eigen::Vector3d(u)) * q;
  state.x = Eigen::VectorXd::Zero(n);
  state.P = of_d * joint * of_d.transpose();
  const RestInterval interval{q, kSeconds, Phi.middleRows<3>(kPsi), Q.middleCols<3>(kPsi)};
  const Linearised m = heading_hold(state, {layout, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), C_n_e}, interval, kWalk);
  EXPECT_NEAR(m.nu(0), -1e-4, 1e-12);
  const Innovation step = innovation(state, m);
  EXPECT_NEAR(step.S(0, 0), S(0, 0), 1e-12 * S(0, 0));
  const Eigen::MatrixXd P = state.P;
  const AppliedUpdate applied = apply(m, step, state);
  test::expect_near_matrix(applied.K, gain, 1e-10, "K");
  test::expect_near_matrix(state.P, P - gain * S * gain.transpose(), 1e-12, "P");
}

test::StartSd free_heading() {
  test::StartSd sd;
  sd.heading = 0.02;
  return sd;
}

/// Ten minutes at rest with a consumer gyro. If nothing holds the heading it drifts by 0.4 deg with the white noise and by 17
/// deg for each sigma of the bias, which nothing shows at rest.
struct AtRest {
  noise::ImuErrorModel model = test::error_model(R"(
schema: coast.imu_error_model/1
gyro:
  all:
    - {process: white_noise, density: 1.0, unit: deg/sqrt(h)}
    - {process: random_constant, sigma: 100, unit: deg/h}
    - {process: gauss_markov, sigma: 20, unit: deg/h, correlation_time_s: 300}
accel:
  all:
    - {process: white_noise, density: 200, unit: ug/sqrt(Hz)}
    - {process: random_constant, sigma: 2, unit: mg}
)");
  simulate::MotionParameters parameters;
  simulate::AnalyticTrajectory motion = [this] {
    parameters.duration = 600.0;
    parameters.static_start = 0.0;
    parameters.origin = {0.8, 0.1, 300.0};
    return simulate::make_motion("at_rest", parameters);
  }();
  FilterOptions options;

  /// Errors of the heading over their sigmas at the end, and the change of the heading: filtered, smoothed.
  struct Outcome {
    double filtered_sigmas = 0.0;
    double smoothed_sigmas = 0.0;
    double smoothed_change = 0.0;  ///< rad, from the first to the last knot
  };
  [[nodiscard]] Outcome run(std::uint64_t seed) const {
    test::Recording recording;
    recording.motion = &motion;
    simulate::ImuSampling sampling;
    sampling.start = test::mission_start();
    sampling.rate_hz = 50.0;
    recording.imu = simulate::with_errors(simulate::true_increments(motion, sampling, {}, 1), model, seed);
    recording.gnss = simulate::gnss_fixes(motion, test::mission_start(), {}, seed);
    Mission mission = recording.mission();
    mission.standstill = {{test::mission_start(), test::mission_start() + 600.0}};
    const ForwardFilter filter(mission, model, options);
    std::mt19937_64 random(seed);
    const record::NavState truth = recording.truth(test::mission_start());
    KnotStore knots;
    FilterOutputs outputs;
    outputs.knots = &knots;
    const FilterState last = filter.run(test::drawn_start(filter, truth, free_heading(), random), outputs).last;
    const SmoothedKnot first = smooth(knots, filter.layout()).front();
    const Eigen::Vector3d down = geo::C_n_e(parameters.origin).col(2);
    const Eigen::Vector3d at_end = error_between(last.nav, recording.truth(last.nav.t)).segment<3>(kPsi);
    const Eigen::Vector3d at_begin = error_between(first.nav, recording.truth(first.nav.t)).segment<3>(kPsi);
    const double sd = std::sqrt(down.dot(last.P.block<3, 3>(kPsi, kPsi) * down));
    return {down.dot(at_end) / sd, down.dot(at_begin) / std::sqrt(first.cov.attitude(2, 2)), down.dot(at_end - at_begin)};
  }
};

TEST(HeadingHold, AHeadingAtRestStaysAndItsSigmaHolds) {
  AtRest rest;
  rest.options.vehicle.zero_velocity_sd_mps = 0.01;
  constexpr int kRuns = 30;
  double largest_free = 0.0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
    largest_free = std::max(largest_free, std::abs(rest.run(seed).smoothed_change));
  rest.options.vehicle.heading_hold_sd = 1e-4 * kDegree;  // this simulated vehicle does not move at all
  double filtered = 0.0, smoothed = 0.0, largest = 0.0;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const AtRest::Outcome outcome = rest.run(seed);
    filtered += outcome.filtered_sigmas * outcome.filtered_sigmas;
    smoothed += outcome.smoothed_sigmas * outcome.smoothed_sigmas;
    largest = std::max(largest, std::abs(outcome.smoothed_change));
  }
  RecordProperty("free_deg", std::to_string(largest_free / kDegree));
  RecordProperty("held_deg", std::to_string(largest / kDegree));
  EXPECT_LT(largest, 0.1 * kDegree);
  EXPECT_GT(largest_free, 3.0 * largest);
  // Chi-square with as many degrees of freedom as runs; one test in a thousand is outside by chance.
  EXPECT_LT(filtered, noise::chi2_upper_quantile(kRuns, 5e-4));
  EXPECT_GT(filtered, noise::chi2_upper_quantile(kRuns, 1.0 - 5e-4));
  EXPECT_LT(smoothed, noise::chi2_upper_quantile(kRuns, 5e-4));
}

class OdometerTest : public testing::Test {
 protected:
  OdometerTest() {
    test::RecordingOptions options;
    options.duration = 300.0;
    options.gnss.rate_hz = 5.0;
    recording_ = test::make_recording(options, &model_, 4);
    truth_.rate_hz = 50.0;
    truth_.sd = 0.02;
    truth_.point_b = {-1.2, 0.1, 0.5};
    truth_.scale = 1.03;
    truth_.delay_s = 0.12;
  }
  [[nodiscard]] record::AidRecording rows(std::uint64_t seed = 4) const {
    return simulate::aid_rows(test::weaving(300.0), test::mission_start(), truth_, seed, 0);
  }
  [[nodiscard]] AidStream stream(const std::string& keys, record::Events& told) const {
    const ConfiguredAid odometer = aid_of("{kind: odometer, point_m: [-1.2, 0.1, 0.5], " + keys + "}");
    return {odometer.name, odometer.aid,
            std::make_shared<const std::vector<record::AidSample>>(odometer.aid->samples(rows(), recording_.gnss, told))};
  }
  [[nodiscard]] FilterResult run(const std::vector<AidStream>& aids, const FilterOptions& options) const {
    Mission mission = recording_.mission();
    mission.aids = aids;
    const ForwardFilter filter(mission, model_, options);
    std::mt19937_64 random(1);
    return filter.run(test::drawn_start(filter, recording_.truth(test::mission_start()), {}, random), {});
  }

  noise::ImuErrorModel model_ = test::error_model(test::kIndustrialModel);
  test::Recording recording_;
  simulate::AidOptions truth_;
};

double number_behind(const std::string& text, const std::string& key) {
  const auto at = text.find(key);
  return at == std::string::npos ? std::nan("") : std::stod(text.substr(at + key.size()));
}

// 190 chords of 15 m between fixes of 1 cm determine the scale to 1.5 cm / 15 m / sqrt(190) = 7e-5, and with accelerations of 1
// m/s^2 the delay to 1 ms; curvature of the path and the antenna's own arm are common to both and allow three times that.
TEST_F(OdometerTest, ScaleAndDelayAreFoundFromTheFixes) {
  for (const bool pulses : {false, true}) {
    if (pulses) truth_.metres_per_pulse = 0.05;
    record::Events told;
    const AidStream found = stream(pulses ? "unit: pulses" : "unit: m/s", told);
    ASSERT_EQ(told.size(), 1U);
    const double scale = number_behind(told[0].text, "`scale: ");
    EXPECT_NEAR(scale, pulses ? 1.03 * 0.05 : 1.03, 2e-3 * (pulses ? 0.05 : 1.0)) << told[0].text;
    EXPECT_NEAR(number_behind(told[0].text, "`delay_s: "), 0.12, 5e-3) << told[0].text;
    EXPECT_GT(found.samples->size(), 1000U);
  }
}

TEST_F(OdometerTest, GrossErrorsOfFixesAndSlipDoNotMatter) {
  truth_.slips = {{{40.0, 10.0}, 0.3}};
  for (std::size_t i = 0; i < recording_.gnss.fixes.size(); i += 17) recording_.gnss.fixes[i].r_ea_e.x() += 30.0;
  record::Events told;
  static_cast<void>(stream("unit: m/s", told));
  EXPECT_NEAR(number_behind(told[0].text, "`scale: "), 1.03, 3e-3);
  EXPECT_NEAR(number_behind(told[0].text, "`delay_s: "), 0.12, 0.01);
}

TEST_F(OdometerTest, RowsInAnotherTimeScaleAreFoundWithAWarning) {
  truth_.delay_s = 18.0;
  record::Events told;
  static_cast<void>(stream("unit: m/s", told));
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].severity, record::Event::Severity::kWarning);
  EXPECT_NEAR(number_behind(told[0].text, "`delay_s: "), 18.0, 5e-3) << told[0].text;
}

TEST_F(OdometerTest, WhatDoesNotFollowTheFixesIsRefused) {
  const auto refusal = [this](double (*wrong)(double), const std::string& keys) -> std::string {
    record::AidRecording spoiled = rows();
    for (record::AidSample& row : spoiled.samples) row.value.x() = wrong(row.value.x());
    const ConfiguredAid odometer = aid_of("{kind: odometer, point_m: [-1.2, 0.1, 0.5]" + keys + "}");
    record::Events told;
    try {
      static_cast<void>(odometer.aid->samples(spoiled, recording_.gnss, told));
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  const auto dead = [](double) { return 0.0; };
  const auto reversed = [](double v) { return std::max(0.0, 22.0 - v); };  // what grows as the speed falls
  EXPECT_NE(refusal(dead, "").find("whatever its scale and delay"), std::string::npos);
  EXPECT_NE(refusal(reversed, "").find("whatever its scale and delay"), std::string::npos);
  EXPECT_EQ(refusal(dead, ", scale: 1, delay_s: 0"), "");
}

// 0 for less than a second before or behind is a wheel that creeps below what its sensor sees.
TEST_F(OdometerTest, AStandstillIsAZeroThatLasts) {
  record::AidRecording rows;
  for (int i = 0; i < 200; ++i) {
    const bool zero = (i >= 40 && i < 47) || (i >= 100 && i < 140);  // 0.7 s, 4 s
    rows.samples.push_back({test::mission_start() + 0.1 * i, {zero ? 0.0 : 5.0, 0.0, 0.0}, Eigen::Vector3d::Zero()});
  }
  const ConfiguredAid odometer = aid_of("{kind: odometer, scale: 1, delay_s: 0, interval_s: 0.1}");
  record::Events told;
  std::vector<double> zeros;
  for (const record::AidSample& sample : odometer.aid->samples(rows, recording_.gnss, told))
    if (sample.value.x() == 0.0) zeros.push_back(sample.t - test::mission_start());
  ASSERT_FALSE(zeros.empty());
  EXPECT_NEAR(zeros.front(), 10.9, 0.11);
  EXPECT_NEAR(zeros.back(), 13.0, 0.11);
}

TEST_F(OdometerTest, SlipIsRefusedAndNothingElse) {
  truth_.slips = {{{100.0, 5.0}, 0.1}};
  record::Events told;
  const FilterResult result = run({stream("scale: 1.03, delay_s: 0.12", told)}, {});
  int refused_in_slip = 0, in_slip = 0, refused_elsewhere = 0;
  for (const InnovationRecord& r : result.innovations) {
    if (r.kind != UpdateKind::kAid) continue;
    const double t = r.t - test::mission_start();
    const bool slips = t > 99.9 && t < 105.1;  // a mean over 0.2 s may have a part of it
    in_slip += slips ? 1 : 0;
    (slips ? refused_in_slip : refused_elsewhere) += r.used ? 0 : 1;
  }
  EXPECT_GE(in_slip, 24);
  EXPECT_GE(refused_in_slip, in_slip - 3);
  EXPECT_EQ(refused_elsewhere, 0);
  EXPECT_TRUE(told.empty());
}

// Samples at the filter's interval with their true sigma: NIS of one degree of freedom, mean 1 within what a thousand white
// ones allow (sqrt(2 / 1200) = 0.04), four sigmas.
TEST_F(OdometerTest, InnovationsAreWhatTheirSigmaSays) {
  truth_.rate_hz = 5.0;
  truth_.sd = 0.1;
  record::Events told;
  const FilterResult result = run({stream("scale: 1.03, delay_s: 0.12, sd_mps: 0.1", told)}, {});
  double nis = 0.0, count = 0.0;
  for (const InnovationRecord& r : result.innovations)
    if (r.kind == UpdateKind::kAid && r.t - test::mission_start() > 20.0) {
      nis += r.nis;
      count += 1.0;
    }
  ASSERT_GT(count, 1000.0);
  EXPECT_NEAR(nis / count, 1.0, 4.0 * std::sqrt(2.0 / count));
}

TEST_F(OdometerTest, AnOutageOfTwoMinutesDriftsLess) {
  record::Events told;
  const AidStream odometer = stream("unit: m/s", told);
  FilterOptions options;
  options.withheld = {{test::mission_start() + 180.0, test::mission_start() + 301.0}};
  const auto position_error = [&](const FilterResult& result) {
    return (result.last.nav.r_eb_e - recording_.truth(result.last.nav.t).r_eb_e).norm();
  };
  const FilterResult free = run({}, options);
  const FilterResult aided = run({odometer}, options);
  EXPECT_LT(position_error(aided), 0.3 * position_error(free));
  EXPECT_LT(aided.last.P.diagonal().head<3>().sum(), 0.1 * free.last.P.diagonal().head<3>().sum());
}

TEST_F(OdometerTest, AWrongScaleIsToldAsRefusedSamples) {
  record::Events told;
  const FilterResult result = run({stream("scale: 1.3, delay_s: 0.12", told)}, {});
  EXPECT_TRUE(std::ranges::any_of(result.events, [](const auto& event) { return event.kind == "aid_refused"; }));
}

TEST_F(OdometerTest, PulsesWithoutFixesInMotionNeedAScale) {
  recording_.gnss.fixes.resize(20);
  record::Events told;
  EXPECT_THROW(static_cast<void>(stream("unit: pulses", told)), InputError);
}

TEST(AidStreams, TimeReversalIsItsOwnInverse) {
  const Eigen::Vector3d sd(0.1, 0.0, 0.0);
  const auto samples = std::make_shared<const std::vector<record::AidSample>>(std::vector<record::AidSample>{
      {test::mission_start() + 1.0, {1.0, 0.0, 0.0}, sd}, {test::mission_start() + 3.0, {2.0, 0.0, 0.0}, sd}});
  const std::vector<AidStream> streams{{"odometer", aid_of("{kind: odometer}").aid, samples}};
  const geo::GpsTime mirror = test::mission_start() + 10.0;
  const std::vector<AidStream> once = reversed(streams, mirror);
  EXPECT_EQ(once[0].samples->front().t, test::mission_start() + 17.0);
  EXPECT_EQ(once[0].samples->front().value.x(), 2.0);
  const std::vector<AidStream> twice = reversed(once, mirror);
  EXPECT_EQ(twice[0].samples->front().t, samples->front().t);
  EXPECT_EQ(twice[0].samples->back().t, samples->back().t);
}

}  // namespace
}  // namespace coast
