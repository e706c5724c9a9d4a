// Scores of hypotheses, and statistics of the largest of many.

#include "coast/diagnose/examination.hpp"

#include <gtest/gtest.h>

#include "coast/geo/earth.hpp"
#include "coast/geo/units.hpp"
#include "coast/noise/chi_square.hpp"
#include "coast/study/interpolation.hpp"
#include "coast/study/solution.hpp"
#include "diagnose/concealed.hpp"
#include "evidence/selected_effects.hpp"

namespace coast {
namespace {

using namespace diagnose;

/// A mission filtered and smoothed, and what it says of the catalogue.
class Examined {
 public:
  explicit Examined(const MissionInput& input)
      : input_(input),
        mission_(input.imu, input.gnss, input.setup, {}),
        hypotheses_(mission_.mission(), mission_.options(), Grade::kIndustrial, path_, {}) {
    study::SolutionOutputs outputs;
    outputs.smoothed = [this](const record::TrajectoryEpoch& epoch) { path_.push_back(epoch.nav); };
    solution_ = study::solve(mission_, mission_.options(), true, outputs, {});
    input_.setup.start = mission_.start();
  }
  [[nodiscard]] const Hypotheses& hypotheses() const { return hypotheses_; }
  [[nodiscard]] Eigen::Index find(std::string_view name, Eigen::Index axis) const {
    const auto at =
        std::ranges::find_if(hypotheses_.all(), [&](const Hypothesis& h) { return h.effect->name == name && h.axis == axis; });
    return at - hypotheses_.all().begin();
  }
  [[nodiscard]] Examination examine(Eigen::Index draws, const std::vector<Examination::Started>& started = {}) const {
    return diagnose::examine(mission_.mission(), solution_.filter->layout(), solution_.knots, hypotheses_,
                             {.draws = draws, .started = started});
  }
  /// What its score leaves out.
  [[nodiscard]] double own_noise(Eigen::Index i) const {
    return evidence_of_sizes(mission_.mission(), solution_.filter->layout(), solution_.knots,
                             SelectedAlone(hypotheses_, {{.hypothesis = i}}))
        .own_noise(0);
  }
  /// Of a filter that knows of the effects, from the same start.
  [[nodiscard]] double log_likelihood(const std::vector<SelectedEffect>& taken) const {
    MissionInput with = without(taken, input_, hypotheses_, path_, mission_.mission(), solution_.filter->layout());
    const study::PreparedMission mission(std::move(with.imu), std::move(with.gnss), std::move(with.setup), {});
    const estimate::ForwardFilter filter(mission.mission(), mission.model(), mission.options());
    return filter.run(mission.start_state(filter), {}).log_likelihood;
  }

 private:
  MissionInput input_;
  study::PreparedMission mission_;
  std::vector<record::NavState> path_;
  study::Solution solution_;
  Hypotheses hypotheses_;
};

/// An IMU that is believed to be much noisier than it is, and fixes whose errors last: the filter's velocity follows every fix.
MissionInput mission_led_by_fixes() {
  MissionInput input = test::honest_mission(11);
  for (record::GnssFix& fix : input.gnss.fixes) fix.velocity.reset();
  estimate::NoiseAdjustment noise;
  noise.gnss_scale = {.horizontal = 0.1, .vertical = 0.1, .velocity = 1.0};
  noise.correlated_gnss = {.horizontal_m = 0.02, .vertical_m = 0.04, .time_s = 5.0};
  noise.gyro_factors.setConstant(3.0);
  noise.accel_factors.setConstant(100.0);
  input.setup.model = estimate::adjusted(input.setup.model, noise);
  input.setup.filter = estimate::adjusted(input.setup.filter, noise);
  return input;
}

// Against the log-likelihood of runs with the effect and without it, half a standard deviation to either side. Columns along
// the filter's own velocity have the last innovations in them: a shift of tags would be told wrong by tens of standard
// deviations.
TEST(Examination, ScoresAreSlopesOfTheLogLikelihood) {
  MissionInput input = mission_led_by_fixes();
  input.setup.filter.vehicle.non_holonomic = estimate::NonHolonomic{.point_b = {-0.5, 0.1, 1.0}, .pitch = 0.02, .yaw = -0.03};
  const Examined examined(input);
  const Examination e = examined.examine(0);
  for (const auto& [name, axis] : {std::pair{"imu_timestamp_gap", 0},
                                   {"imu_clock_drift", 0},
                                   {"lever_arm_error", 0},
                                   {"lever_arm_error", 1},
                                   {"vehicle_mounting", 0},
                                   {"vehicle_mounting", 1},
                                   {"accel_scale_factor", 1}}) {
    const Eigen::Index i = examined.find(name, axis);
    const double sd = 1.0 / std::sqrt(e.information(i, i));
    const double slope = examined.log_likelihood({{.hypothesis = i, .value = 0.5 * sd}}) -
                         examined.log_likelihood({{.hypothesis = i, .value = -0.5 * sd}});
    // The smoothed velocity has a little of the innovations in it too: 0.4 standard deviations here, where the filter's has 23.
    const double score = (e.score(i) + examined.own_noise(i)) * sd;
    EXPECT_NEAR(score, slope, 0.5 + 0.03 * std::abs(slope)) << name << " " << axis;
    EXPECT_EQ(examined.own_noise(i) != 0.0, examined.hypotheses().grows_with_own_signal(i)) << name << " " << axis;
  }
}

// What is known of a constant that the filter estimates itself is its prior, 1/s^2, however long it looks: all of it comes back
// as a shift of the prior mean. A rate turns the antenna and the wheels about the IMU too.
TEST(Examination, OfAConstantThatIsAStateTheInformationIsThatOfItsPrior) {
  MissionInput input = test::honest_mission(13);
  input.setup.model =
      test::error_model({.gyro_deg_sqrt_h = 0.6, .gyro_bias_deg_h = 300.0, .accel_ug_sqrt_hz = 200.0, .accel_bias_mg = 10.0});
  input.setup.filter.vehicle.non_holonomic = estimate::NonHolonomic{.point_b = {-1.5, 0.4, 0.8}, .pitch = 0.02, .yaw = -0.03};
  input.setup.start = study::PreparedMission(input.imu, input.gnss, input.setup, {}).start();
  input.setup.start->gyro_bias_sd.reset();  // seen standing still they are known better
  const Examined examined(input);
  const Examination e = examined.examine(0);
  for (const auto& [site, sensor] : {std::pair{Site::kGyro, noise::Sensor::kGyro}, {Site::kAccel, noise::Sensor::kAccel}})
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Index i = examined.hypotheses().bias_step(site, axis);
      // But for the part that the filter does not find in 300 s.
      EXPECT_NEAR(e.information(i, i) * std::pow(input.setup.model.bias_sd(sensor, axis), 2), 1.0, 0.02) << name(site) << axis;
    }
}

// Likewise of what has started, with its information: along a, log L = s a - I a^2 / 2, and between two at a time, by runs that
// have both. A gap of the tags and a step of gyro z in the middle of the mission.
TEST(Examination, WhatHasStartedIsSeenBesideTheOthers) {
  const MissionInput input = test::honest_mission(13);
  const Examined examined(input);
  const geo::GpsTime middle = input.gnss.fixes[input.gnss.fixes.size() / 2].t + 0.5;
  const std::vector<Examination::Started> started{{examined.find("imu_timestamp_gap", 0), middle},
                                                  {examined.find("bias_step", 2), middle + 20.0}};
  const Examination e = examined.examine(0, started);
  const Eigen::Index n = examined.hypotheses().size();
  ASSERT_EQ(e.score.size(), n + 2);
  const auto at = [&](double a, double b) {
    return examined.log_likelihood({{.hypothesis = started[0].hypothesis, .from = started[0].from, .value = a},
                                    {.hypothesis = started[1].hypothesis, .from = started[1].from, .value = b}});
  };
  const Eigen::Vector2d sd = e.information.diagonal().tail<2>().cwiseSqrt().cwiseInverse();
  const Eigen::Vector2d u = 2.0 * sd;
  const double none = at(0.0, 0.0);
  for (int i = 0; i < 2; ++i) {
    const double up = at(i == 0 ? u(0) : 0.0, i == 1 ? u(1) : 0.0) - none;
    const double down = at(i == 0 ? -u(0) : 0.0, i == 1 ? -u(1) : 0.0) - none;
    // Two standard deviations away a quadratic has 2 of -log L; what the samples' grid shifts an onset by is of the order of 1
    // %.
    EXPECT_NEAR(e.score(n + i) * u(i), 0.5 * (up - down), 0.1 + 0.03 * std::abs(up - down)) << i;
    EXPECT_NEAR(-(up + down) / 4.0, 1.0, 0.05) << i;
  }
  const double mixed = at(u(0), u(1)) - at(u(0), -u(1)) - at(-u(0), u(1)) + at(-u(0), -u(1));
  EXPECT_NEAR(-mixed / (4.0 * u(0) * u(1)) * sd(0) * sd(1), e.information(n, n + 1) * sd(0) * sd(1), 0.02);
  // The others are what they are without: but for the rounding of sums, which may be grouped otherwise.
  const Eigen::MatrixXd without = examined.examine(0).information;
  EXPECT_LT((e.information.topLeftCorner(n, n) - without).norm(), 1e-9 * without.norm());
}

// Against differences of the true antenna's positions over a tenth of a second. Gyros that shake have half a metre per second
// at the antenna at any one instant.
TEST(Hypotheses, AShiftOfTheTimeMovesAFixAsTheAntennaGoesAndNotAsItShakes) {
  constexpr double kRate = 0.5;        // rad/s
  constexpr double kFrequency = 14.7;  // Hz
  constexpr double kHalf = 0.05;       // s
  test::MissionWithTruth made = test::honest_mission_with_truth(18, 220.0);
  MissionInput& input = made.input;
  const geo::GpsTime start = input.imu.samples.front().t;
  for (record::ImuSample& sample : input.imu.samples)
    sample.dtheta.x() += kRate * sample.dt * std::sin(2.0 * geo::kPi * kFrequency * (sample.t - start));
  const study::PreparedMission mission(input.imu, input.gnss, input.setup, {});
  const std::vector<record::NavState>& path = made.truth.states;
  const Hypotheses hypotheses(mission.mission(), mission.options(), Grade::kIndustrial, path, {});
  const auto offset =
      std::ranges::find_if(hypotheses.all(), [](const Hypothesis& h) { return h.effect->name == "gnss_time_offset"; });
  const estimate::StateLayout layout(input.setup.model, input.setup.C_s_b, input.setup.filter.auxiliary);
  const auto at = [&](geo::GpsTime t) {
    const auto behind = std::ranges::lower_bound(path, t, {}, &record::NavState::t);
    return study::interpolate(*std::prev(behind), *behind, t);
  };
  const auto antenna = [&](geo::GpsTime t) -> Eigen::Vector3d { return at(t).r_eb_e + at(t).q_b_e * input.setup.lever_arm_b; };
  double largest_shake = 0.0;
  double farthest = 0.0;
  for (const record::GnssFix& fix : mission.mission().gnss.fixes) {
    if (fix.t - start < 1.0 || path.back().t - fix.t < 1.0) continue;
    const record::NavState nav = at(fix.t);
    const auto sample = std::ranges::upper_bound(mission.mission().imu.samples, fix.t, {}, &record::ImuSample::t);
    const Eigen::Vector3d omega_b = sample->dtheta / sample->dt;
    const estimate::UpdateContext context{layout, input.setup.lever_arm_b, omega_b,
                                          geo::C_n_e(geo::geodetic_from_ecef(nav.r_eb_e))};
    Eigen::MatrixXd D = Eigen::MatrixXd::Zero(3, hypotheses.size());
    hypotheses.add_measurement_errors({estimate::UpdateKind::kGnssPosition,
                                       static_cast<std::size_t>(sample - mission.mission().imu.samples.begin()), nav, context},
                                      D);
    const Eigen::Vector3d v = (antenna(fix.t + kHalf) - antenna(fix.t - kHalf)) / (2.0 * kHalf);
    farthest = std::max(farthest, (D.col(offset - hypotheses.all().begin()) + v).norm());
    largest_shake = std::max(largest_shake, (nav.v_eb_e + nav.q_b_e * omega_b.cross(input.setup.lever_arm_b) - v).norm());
  }
  EXPECT_GT(largest_shake, 0.4);
  // Of 14.7 Hz a mean over four samples of 50 Hz has sin(4 x)/(4 sin x) left, x = pi 14.7/50: 0.16 of 0.57 m/s.
  EXPECT_LT(farthest, 0.13);
}

// Of a jump of fixes every instant between two of them is as good. In the middle it stays between them when tags shift a
// little.
TEST(Suspicions, WhatOnlyFixesSeeBeginsInTheMiddleBetweenTwo) {
  MissionInput input = test::honest_mission(15, 240.0);
  input.setup.filter.gate_probability = 0.0;
  std::vector<record::GnssFix>& fixes = input.gnss.fixes;
  const std::size_t first = fixes.size() / 2;
  const Eigen::Vector3d jump = geo::C_n_e(geo::geodetic_from_ecef(fixes.front().r_ea_e)) * Eigen::Vector3d(0.3, 0.0, 0.0);
  for (std::size_t i = first; i < fixes.size(); ++i) fixes[i].r_ea_e += jump;
  const Examined examined(input);
  const std::vector<Suspicion> all = suspicions(examined.examine(20), examined.hypotheses(), {}).all;
  const auto wrong = std::ranges::find(all, examined.find("gnss_wrong_fix", 0), &Suspicion::hypothesis);
  ASSERT_NE(wrong, all.end());
  EXPECT_NEAR(wrong->estimate, 0.3, 4.0 * wrong->sd);
  const double interval = fixes[first].t - fixes[first - 1].t;
  EXPECT_NEAR(*wrong->from - fixes[first - 1].t, 0.5 * interval, 1e-6);
}

TEST(CovarianceOf, IsTheInverseWhereThereIsOne) {
  // Units as far apart as those of rates and distances.
  const Eigen::Vector3d units(1e6, 1.0, 1e-4);
  Eigen::Matrix3d correlated;
  correlated << 1.0, 0.6, 0.1, 0.6, 1.0, -0.3, 0.1, -0.3, 1.0;
  const Eigen::Matrix3d information = units.asDiagonal() * correlated * units.asDiagonal();
  const Eigen::Matrix3d back = units.asDiagonal() * covariance_of(information) * units.asDiagonal();
  EXPECT_LT((back * correlated - Eigen::Matrix3d::Identity()).norm(), 1e-12);
}

TEST(CovarianceOf, SharesWhatCannotBeToldApart) {
  Eigen::Matrix2d same;
  same << 4.0, 4.0, 4.0, 4.0;
  EXPECT_LT((covariance_of(same) * Eigen::Vector2d(8.0, 8.0) - Eigen::Vector2d(1.0, 1.0)).norm(), 1e-12);
}

TEST(Examination, DrawsHoldWhereCovariancesDo) {
  const MissionInput input = test::honest_mission(12);
  const Examination drawn = Examined(input).examine(20);
  MissionInput other = input;
  other.setup.lever_arm_b.y() += 0.05;
  Examination same = Examined(other).examine(0);
  ASSERT_TRUE(same.take_draws_of(drawn));
  EXPECT_EQ(same.null_score, drawn.null_score);
  ASSERT_EQ(same.tracks.size(), drawn.tracks.size());
  EXPECT_EQ(same.tracks.front().null_largest, drawn.tracks.front().null_largest);
  EXPECT_EQ(same.disturbances.score[0].bottomRows(20), drawn.disturbances.score[0].bottomRows(20));
  EXPECT_NE(same.disturbances.score[0].row(0), drawn.disturbances.score[0].row(0));
  other.setup.model =
      estimate::adjusted(other.setup.model, {.gnss_scale = {}, .correlated_gnss = {}, .gyro_factors = {2.0, 2.0, 2.0}});
  Examination noisier = Examined(other).examine(0);
  EXPECT_FALSE(noisier.take_draws_of(drawn));
  EXPECT_EQ(noisier.null_score.cols(), 0);
}

// The largest of n independent squares: 1 - (1 - p)^n, p from the table of chi-square(1): P(X > 3.841) = 0.05.
TEST(LargestByChance, IsThatOfIndependentSquares) {
  const LargestByChance one{1.0};
  EXPECT_NEAR(one.p_value(3.8415), 0.05, 1e-4);
  const LargestByChance ten{10.0};
  EXPECT_NEAR(ten.p_value(3.8415), 1.0 - std::pow(0.95, 10.0), 1e-4);
  EXPECT_NEAR(ten.p_value(ten.quantile(0.05)), 0.05, 1e-12);
  EXPECT_NEAR(LargestByChance{57.0}.quantile(0.05), noise::chi2_upper_quantile(1.0, 1.0 - std::pow(0.95, 1.0 / 57.0)), 1e-9);
}

// The integral of Cauchy prior times likelihood, by the trapezoid rule over the angle: c = plausible tan(angle). The tolerance
// is the mixture's, 40 normal priors.
TEST(LogBayesFactor, IsTheIntegralOverACauchyPrior) {
  for (const double plausible : {0.1, 1.0, 30.0})
    for (const double sigmas : {0.0, 2.0, 8.0, 40.0})
      for (const double information : {0.04, 1.0, 25.0}) {
        constexpr int kSteps = 1'000'000;
        const double score = sigmas * std::sqrt(information);
        const double largest = 0.5 * score * score / information;
        double sum = 0.0;
        for (int i = 0; i < kSteps; ++i) {
          const double c = plausible * std::tan(geo::kPi * ((i + 0.5) / kSteps - 0.5));
          sum += std::exp(score * c - 0.5 * information * c * c - largest);
        }
        EXPECT_NEAR(log_bayes_factor(score, information, plausible), largest + std::log(sum / kSteps), 0.05)
            << plausible << " " << score << " " << information;
      }
}

// Geodesy: noncentrality 17.07 at alpha = 0.1 % and power 80 % (Baarda 1968).
TEST(MinimalDetectable, IsBaardas) {
  EXPECT_NEAR(minimal_detectable(1.0, noise::chi2_upper_quantile(1.0, 0.001)), std::sqrt(17.07), 2e-3);
  EXPECT_NEAR(minimal_detectable(3.0, 10.8), 3.0 * minimal_detectable(1.0, 10.8), 1e-12);
}

}  // namespace
}  // namespace coast
