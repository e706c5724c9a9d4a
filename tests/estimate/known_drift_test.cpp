// Processes of several states in the filter: a drift that is known, a ramp and a flicker that are estimated.

#include <gtest/gtest.h>

#include "coast/estimate/forward_filter.hpp"
#include "coast/geo/units.hpp"
#include "estimate/mission.hpp"
#include "support/support.hpp"

namespace coast {
namespace {

using namespace estimate;

constexpr test::StartSd kStart;

const std::string kPlain = test::kIndustrialModel;

std::string with_entries(const std::string& gyro, const std::string& accel) {
  std::string text = kPlain;
  const auto insert = [&text](const char* section, const std::string& entry) {
    const auto at = text.find("all: [", text.find(section)) + 6;
    text.insert(at, entry + ", ");
  };
  insert("gyro:", gyro);
  insert("accel:", accel);
  return text;
}

FilterState filtered(const Mission& mission, const std::string& model, const record::NavState& start) {
  const ForwardFilter filter(mission, test::error_model(model), {});
  return filter
      .run(filter.initial_state(start, Eigen::Vector3d::Constant(kStart.position), Eigen::Vector3d::Constant(kStart.velocity),
                                kStart.attitude()),
           {})
      .last;
}

const std::string kDrifting = with_entries("{process: drift, slope: -1800, unit: deg/h/h}",
                                           "{process: drift, slope: 90000, unit: ug/h}");  // -0.5 deg/h/s, 25 ug/s

// A drift that is added to the recording and stands in the model changes nothing of the solution. The states are held over a
// fold of 0.05 s: at worst an error of a twentieth of what drifts in a second.
TEST(KnownDrift, IsTakenOffTheRecording) {
  const auto model = test::error_model(kPlain);
  test::Recording recording = test::make_recording({}, &model, 3);
  const FilterState clean = filtered(recording.mission(), kPlain, recording.truth(test::mission_start()));
  for (record::ImuSample& s : recording.imu.samples) {
    const double middle = s.t - test::mission_start() - 0.5 * s.dt;
    s.dtheta.array() += s.dt * middle * -0.5 * geo::unit("deg/h").to_si;
    s.dv.array() += s.dt * middle * 25.0 * geo::unit("ug").to_si;
  }
  const FilterState drifting = filtered(recording.mission(), kDrifting, recording.truth(test::mission_start()));
  const auto d = error_between(drifting.nav, clean.nav);
  const Eigen::VectorXd sd = clean.P.diagonal().head<kNav>().cwiseSqrt();
  EXPECT_LT(d.cwiseAbs().cwiseQuotient(sd).maxCoeff(), 0.01);
  test::expect_near_matrix(drifting.P.topLeftCorner<kNav, kNav>(), clean.P.topLeftCorner<kNav, kNav>(), 1e-5, "P");
  // Without it in the model the same recording is off by far more.
  const FilterState ignored = filtered(recording.mission(), kPlain, recording.truth(test::mission_start()));
  EXPECT_GT(error_between(ignored.nav, clean.nav).cwiseAbs().cwiseQuotient(sd).maxCoeff(), 1.0);
}

// Its state is what it says at any time, whatever is measured, and a start within the mission knows how far it has come.
TEST(KnownDrift, MeanIsCarriedToTheStartAndNeverEstimated) {
  const auto model = test::error_model(kPlain);
  const test::Recording recording = test::make_recording({}, &model, 4);
  Mission mission = recording.mission();
  const ForwardFilter filter(mission, test::error_model(kDrifting), {});
  const auto& block = filter.layout().sensors().front();
  ASSERT_EQ(block.name, "gyro_x drift");
  const double slope = -0.5 * geo::unit("deg/h").to_si;
  const Eigen::Vector3d any = Eigen::Vector3d::Ones();
  const auto at = [&](const ForwardFilter& f, double t) {
    return f.initial_state(recording.truth(test::mission_start() + t), any, any, any).x.segment<2>(block.offset).eval();
  };
  EXPECT_NEAR(at(filter, 0.0)(0), 0.0, 1e-12 * std::abs(slope));
  EXPECT_NEAR(at(filter, 30.0)(0), 30.0 * slope, 1e-9 * std::abs(slope));
  EXPECT_EQ(at(filter, 30.0)(1), slope);
  mission.first_epoch = test::mission_start() - 70.0;
  EXPECT_NEAR(at(ForwardFilter(mission, test::error_model(kDrifting), {}), 30.0)(0), 100.0 * slope, 1e-9 * std::abs(slope));
  const FilterState last = filtered(recording.mission(), kDrifting, recording.truth(test::mission_start()));
  const double elapsed = last.nav.t - test::mission_start();
  EXPECT_NEAR(last.x(block.offset), elapsed * slope, 1e-9 * elapsed * std::abs(slope));
  EXPECT_EQ(last.x(block.offset + 1), slope);
  EXPECT_TRUE(last.P.middleRows(block.offset, 2).isZero(0.0));
}

// Consistency over seeds, as of a model with more than one state a process: the normalised error squared of position, velocity,
// attitude at the end stays within 99.9 % bounds of its mean.
TEST(SeveralStates, EstimateIsConsistent) {
  const std::string text = with_entries(
      "{process: rate_ramp, coefficient: 1800, unit: deg/h/h}, {process: flicker, coefficient: 20, unit: deg/h, "
      "shortest_time_s: 50, longest_time_s: 200}",
      "{process: rate_ramp, coefficient: 36000, unit: ug/h}, {process: ar, coefficients: [1.889, -0.8901], "
      "innovation_sigma: 5, unit: ug, rate_hz: 1}");
  const auto model = test::error_model(text);
  constexpr int runs = 40;
  double sum = 0.0;
  std::mt19937_64 random(12);
  for (std::uint64_t seed = 0; seed < runs; ++seed) {
    const test::Recording recording = test::make_recording({}, &model, 100 + seed);
    const Mission mission = recording.mission();
    FilterOptions options;
    options.withheld.push_back({test::mission_start() + 90.0, test::mission_start() + 1000.0});  // the errors act for 30 s
    const ForwardFilter filter(mission, model, options);
    const FilterState start = test::drawn_start(filter, recording.truth(test::mission_start()), kStart, random);
    const FilterState last = filter.run(start, {}).last;
    const auto d = error_between(last.nav, recording.truth(last.nav.t));
    sum += d.dot(last.P.topLeftCorner<kNav, kNav>().ldlt().solve(d));
  }
  const test::Chi2Bounds bounds = test::chi2_mean_bounds(kNav, runs);
  EXPECT_GT(sum / runs, bounds.lower);
  EXPECT_LT(sum / runs, bounds.upper);
}

}  // namespace
}  // namespace coast
