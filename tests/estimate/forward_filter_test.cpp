// How the forward pass goes through a recording: intervals, gaps, the gate, withheld spans, resumption.

#include "coast/estimate/forward_filter.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "coast/estimate/smoother.hpp"
#include "coast/record/error.hpp"
#include "estimate/mission.hpp"
#include "support/support.hpp"

namespace coast {
namespace {

using namespace estimate;

class ForwardFilterTest : public testing::Test {
 protected:
  ForwardFilterTest() : model_(test::error_model(test::kIndustrialModel)) {
    recording_options_.duration = 40.0;
    recording_options_.gnss.rate_hz = 5.0;
    recording_options_.gnss.lever_arm_b = {0.5, 0.2, -1.0};
  }
  void record() { recording_ = test::make_recording(recording_options_, &model_, 3); }
  FilterResult run(const FilterOutputs& outputs) {
    filter_ = std::make_unique<ForwardFilter>(recording_.mission(), model_, options_);
    std::mt19937_64 random(1);
    return filter_->run(test::drawn_start(*filter_, recording_.truth(test::mission_start()), {}, random), outputs);
  }
  /// Largest error of a state against its standard deviation.
  [[nodiscard]] double worst_ratio(const record::NavState& nav, const Eigen::MatrixXd& P) const {
    const Eigen::Matrix<double, kNav, 1> d = error_between(nav, recording_.truth(nav.t));
    return d.cwiseAbs().cwiseQuotient(P.diagonal().head<kNav>().cwiseSqrt()).maxCoeff();
  }

  noise::ImuErrorModel model_;
  test::RecordingOptions recording_options_;
  FilterOptions options_;
  test::Recording recording_;
  std::unique_ptr<ForwardFilter> filter_;
};

TEST_F(ForwardFilterTest, MeetsFixesAtTheirOwnInstantsAtAnyRate) {
  for (const double rate : {0.2, 1.0, 5.0, 10.0, 20.0}) {
    recording_options_.gnss.rate_hz = rate;
    recording_options_.gnss.phase = 0.00371;  // inside a sample
    record();
    KnotStore knots;
    FilterOutputs outputs;
    outputs.knots = &knots;
    double worst = 0.0;
    outputs.at_knots = [&](const FilterState& state) { worst = std::max(worst, worst_ratio(state.nav, state.P)); };
    const FilterResult result = run(outputs);

    ASSERT_EQ(result.innovations.size(), recording_.gnss.fixes.size()) << rate;
    for (std::size_t i = 0; i < result.innovations.size(); ++i)
      EXPECT_NEAR(result.innovations[i].t - recording_.gnss.fixes[i].t, 0.0, 2e-6) << rate;
    double covered = 0.0;
    for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
      const Knot knot = knots.at(i);
      EXPECT_NEAR(knots.time(i + 1) - knots.time(i), knot.interval, 1e-8) << rate;
      EXPECT_LE(knot.interval, options_.knot_interval_s + 1e-8);
      covered += knot.interval;
    }
    EXPECT_NEAR(covered, recording_options_.duration, 1e-6) << rate;
    EXPECT_EQ(result.last.nav.t, recording_.imu.samples.back().t);
    EXPECT_LT(worst, 5.0) << rate;  // nine states at a few hundred correlated instants
  }
}

// Splitting samples at knots changes nothing but the rounding of the parts and the order of coning terms.
TEST_F(ForwardFilterTest, KnotsInsideSamplesLeaveTheTrajectoryAlone) {
  recording_options_.gnss.rate_hz = 0.01;  // one fix, at the start
  record();
  const FilterResult few = run({});
  options_.knot_interval_s = 0.0537;
  const FilterResult many = run({});
  const Eigen::Matrix<double, kNav, 1> d = error_between(many.last.nav, few.last.nav);
  EXPECT_LE(d.segment<3>(kPos).norm(), 1e-3);  // of 40 s of free inertial navigation
  EXPECT_LE(d.segment<3>(kPsi).norm(), 1e-6);
  const Eigen::VectorXd ratio = many.last.P.diagonal().cwiseQuotient(few.last.P.diagonal());
  EXPECT_NEAR(ratio.minCoeff(), 1.0, 2e-3);  // driving noise within longer intervals
  EXPECT_NEAR(ratio.maxCoeff(), 1.0, 2e-3);
}

TEST_F(ForwardFilterTest, WithheldFixesAreNotUsedAndCostAccuracy) {
  record();
  const Withheld span{test::mission_start() + 20.0, test::mission_start() + 30.0};
  options_.withheld.push_back(span);
  double sd_at_end = 0.0;
  FilterOutputs outputs;
  outputs.at_knots = [&](const FilterState& state) {
    if (span.contains(state.nav.t)) sd_at_end = std::sqrt(state.P(0, 0));
  };
  const FilterResult result = run(outputs);
  for (const InnovationRecord& innovation : result.innovations) EXPECT_FALSE(span.contains(innovation.t));
  EXPECT_EQ(result.innovations.size(), recording_.gnss.fixes.size() - 50u);
  EXPECT_GT(sd_at_end, 0.1);
}

TEST_F(ForwardFilterTest, GateRefusesAWrongFixAndListsIt) {
  record();
  record::GnssFix& wrong = recording_.gnss.fixes[100];
  wrong.r_ea_e += Eigen::Vector3d(3.0, -2.0, 1.0);
  const FilterResult result = run({});
  int refused = 0;
  for (const InnovationRecord& innovation : result.innovations) {
    if (innovation.used) continue;
    ++refused;
    EXPECT_NEAR(innovation.t - wrong.t, 0.0, 2e-6);
    EXPECT_NEAR(innovation.nu.norm(), std::sqrt(14.0), 0.3);
    EXPECT_GT(innovation.nis, 1000.0);
  }
  EXPECT_EQ(refused, 1);
  EXPECT_TRUE(result.events.empty());
  EXPECT_LT(worst_ratio(result.last.nav, result.last.P), 4.5);
}

TEST_F(ForwardFilterTest, GateOpensWhenItIsTheFilterThatIsWrong) {
  record();
  for (record::GnssFix& fix : recording_.gnss.fixes)
    if (fix.t - test::mission_start() > 10.0) fix.r_ea_e += Eigen::Vector3d(4.0, 0.0, 0.0);
  const FilterResult result = run({});
  ASSERT_EQ(result.events.size(), 1u);
  EXPECT_EQ(result.events[0].kind, "gnss_jump");
  EXPECT_NEAR(*result.events[0].time - test::mission_start(), 10.0, 0.5);
  double refused_for = 0.0;
  for (const InnovationRecord& innovation : result.innovations)
    if (!innovation.used) refused_for = std::max(refused_for, innovation.t - test::mission_start() - 10.0);
  EXPECT_LT(refused_for, options_.gate_patience_s + 0.3);
  EXPECT_NEAR((result.last.nav.r_eb_e - recording_.truth(result.last.nav.t).r_eb_e).norm(), 4.0, 0.1);
}

TEST_F(ForwardFilterTest, SaysByHowMuchHeightsHaveJumped) {
  record();
  for (record::GnssFix& fix : recording_.gnss.fixes)
    if (fix.t - test::mission_start() > 10.0) {
      const Eigen::Matrix3d C_n_e = geo::C_n_e(geo::geodetic_from_ecef(fix.r_ea_e));
      fix.r_ea_e += C_n_e * Eigen::Vector3d(0.0, 0.0, -30.0);
    }
  const FilterResult result = run({});
  ASSERT_EQ(result.events.size(), 1u);
  const std::string& text = result.events[0].text;
  const auto up = text.find(" up)");
  ASSERT_NE(up, std::string::npos) << text;
  EXPECT_NEAR(std::stod(text.substr(text.rfind(' ', up - 1))), 30.0, 0.3) << text;  // a centimetre of noise, 3 s of coasting
  EXPECT_NE(text.find("before the jump or those after it"), std::string::npos) << text;
}

TEST_F(ForwardFilterTest, BridgesAGapOfTheImuAndSaysThatItIsUncertain) {
  recording_options_.gnss.rate_hz = 1.0;
  recording_options_.gnss.phase = 0.5;
  for (const double gap : {0.05, 0.4, 2.3}) {
    record();
    auto& samples = recording_.imu.samples;
    const geo::GpsTime from = test::mission_start() + 20.1;
    std::erase_if(samples, [&](const record::ImuSample& s) { return s.t > from && s.t - from < gap; });
    ASSERT_LT(samples.size(), 4000u);
    double before = 0.0, worst = 0.0, sd_after = 0.0;
    FilterOutputs outputs;
    outputs.at_knots = [&](const FilterState& state) {
      if (state.nav.t < from) before = std::sqrt(state.P(kPsi, kPsi));
      if (sd_after == 0.0 && state.nav.t - from >= gap) sd_after = std::sqrt(state.P(kPsi, kPsi));
      worst = std::max(worst, worst_ratio(state.nav, state.P));
    };
    const FilterResult result = run(outputs);
    EXPECT_LT(worst, 5.0) << gap;
    EXPECT_GT(sd_after, 2.0 * before) << gap;
    EXPECT_LT(worst_ratio(result.last.nav, result.last.P), 5.0) << gap;
  }
}

TEST_F(ForwardFilterTest, ARestartForgetsTheAttitudeBeforeItUnlessItSawWhatIsWithheld) {
  record();
  const geo::GpsTime at = test::mission_start() + 20.13;
  Mission mission = recording_.mission();
  mission.restarts = {{recording_.truth(at), Eigen::Vector3d::Ones(), Eigen::Vector3d::Ones(), Eigen::Vector3d::Constant(0.1)}};
  for (const bool withheld : {false, true}) {
    if (withheld) options_.withheld.push_back({at - 1.0, at + 1.0});
    const ForwardFilter filter(mission, model_, options_);
    std::mt19937_64 random(1);
    KnotStore knots;
    FilterOutputs outputs;
    outputs.knots = &knots;
    double sd = 0.0;
    outputs.at_knots = [&](const FilterState& state) {
      if (std::abs(state.nav.t - at) < 1e-5) sd = std::sqrt(state.P(kPsi, kPsi));
    };
    static_cast<void>(filter.run(test::drawn_start(filter, recording_.truth(test::mission_start()), {}, random), outputs));
    if (withheld) {
      EXPECT_EQ(sd, 0.0);  // it is no knot
      continue;
    }
    EXPECT_NEAR(sd, 0.1, 1e-12);
    std::size_t before = 0;
    while (knots.time(before + 1) < at - 1e-5) ++before;
    const Knot knot = knots.at(before);
    EXPECT_TRUE(knot.Phi_n.middleRows<3>(kPsi).isZero(0.0));
    EXPECT_FALSE(knot.Phi_n.middleRows<3>(kPos).isZero(0.0));
  }
}

TEST_F(ForwardFilterTest, ResumesFromAKnotAsIfItHadNotStopped) {
  record();
  KnotStore knots;
  FilterOutputs outputs;
  outputs.knots = &knots;
  const FilterResult whole = run(outputs);
  const Knot knot = knots.at(knots.size() / 3);
  const FilterResult rest = filter_->resume(knot, recording_.imu.samples.back().t, {});
  // The gravity that stands in for the point's is renewed at other points: 2e-9 m/s^2.
  const Eigen::Matrix<double, kNav, 1> d = error_between(rest.last.nav, whole.last.nav);
  EXPECT_LE(d.cwiseAbs().cwiseQuotient(whole.last.P.diagonal().head<kNav>().cwiseSqrt()).maxCoeff(), 1e-5);
  test::expect_near_matrix(rest.last.P, whole.last.P, 1e-8, "P");
  std::size_t after = 0;
  for (const InnovationRecord& innovation : whole.innovations) after += innovation.t > knot.post.nav.t + 1e-3 ? 1u : 0u;
  EXPECT_EQ(rest.innovations.size(), after);
}

// Emptied, be it in memory or spilled, a store is as a new one.
TEST_F(ForwardFilterTest, AnEmptiedStoreTakesAnotherPass) {
  record();
  for (const std::size_t limit : {std::size_t{1} << 14, std::size_t{1} << 26}) {
    KnotStore fresh, used(limit);
    FilterOutputs outputs;
    outputs.knots = &used;
    static_cast<void>(run(outputs));
    used.clear();
    EXPECT_EQ(used.size(), 0u);
    static_cast<void>(run(outputs));
    outputs.knots = &fresh;
    static_cast<void>(run(outputs));
    ASSERT_EQ(used.size(), fresh.size());
    for (std::size_t i = 0; i < fresh.size(); i += 10) {
      EXPECT_EQ(used.time(i), fresh.time(i));
      EXPECT_EQ(used.at(i).P_post, fresh.at(i).P_post) << i;
      EXPECT_EQ(used.nominal_at(i).post.x, fresh.nominal_at(i).post.x) << i;
    }
  }
}

TEST_F(ForwardFilterTest, CompensatedIncrementsLeadToTheSameTrajectory) {
  record();
  const FilterResult raw = run({});
  test::Recording compensated = recording_;
  ins::RawIncrement previous;
  for (record::ImuSample& s : compensated.imu.samples) {
    const ins::RawIncrement current{s.dt, s.dtheta, s.dv};
    const ins::BodyIncrement body = ins::compensate_two_sample(previous, current);
    previous = current;
    s.dtheta = body.phi;
    s.dv = body.u;
  }
  Mission mission = compensated.mission();
  mission.increments = ins::IncrementKind::kCompensated;
  const ForwardFilter filter(mission, model_, options_);
  std::mt19937_64 random(1);
  const FilterResult result = filter.run(test::drawn_start(filter, recording_.truth(test::mission_start()), {}, random), {});
  const Eigen::Matrix<double, kNav, 1> d = error_between(result.last.nav, raw.last.nav);
  EXPECT_LE(d.cwiseAbs().cwiseQuotient(raw.last.P.diagonal().head<kNav>().cwiseSqrt()).maxCoeff(), 0.02);
}

TEST_F(ForwardFilterTest, NamesADivergedState) {
  record();
  recording_.imu.samples[2000].dv.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)run({}), NumericalError);
  options_.knot_interval_s = 0.0;
  EXPECT_THROW(ForwardFilter(recording_.mission(), model_, options_), std::invalid_argument);
}

TEST_F(ForwardFilterTest, VehicleConstraintsApplyWhereTheVehicleDrivesOrStands) {
  recording_options_.gnss.rate_hz = 1.0;
  record();
  options_.vehicle.non_holonomic = NonHolonomic{.sd_lateral_mps = 1.0, .sd_vertical_mps = 1.0};  // this drive bobs by 0.2 m/s
  options_.vehicle.zero_velocity_sd_mps = 0.01;
  const FilterResult result = run({});
  int constraints = 0;
  for (const InnovationRecord& innovation : result.innovations) {
    EXPECT_NE(innovation.kind, UpdateKind::kZeroVelocity);  // never at rest
    if (innovation.kind == UpdateKind::kNonHolonomic) ++constraints;
  }
  EXPECT_NEAR(constraints, recording_options_.duration / options_.vehicle.interval_s, 2.0);
}

}  // namespace
}  // namespace coast
