#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>

#include "coast/estimate/combination.hpp"
#include "coast/geo/earth.hpp"
#include "coast/geo/units.hpp"
#include "simulated.hpp"
#include "support/support.hpp"

namespace coast::study {
namespace {

constexpr double kGap = 150.0;  // s after the start
constexpr double kGapEnd = 180.0;

/// A drive with 30 s without GNSS, solved forward, smoothed and combined.
struct Solved {
  record::Trajectory truth;
  geo::GpsTime start;
  Solution rts;
  std::vector<estimate::SmoothedKnot> combined;
  record::Events events;
  std::size_t without_backward = 0;  ///< knots
};

Solved solve_both_ways(simulate::SimulatedMission recording, const Setup& setup) {
  Solved solved;
  solved.truth = std::move(recording.truth);
  PreparedMission mission(std::move(recording.imu), std::move(recording.gnss), setup, {});
  solved.start = mission.start().nav.t;
  estimate::FilterOptions options = mission.options();
  options.withheld.push_back({solved.start + kGap, solved.start + kGapEnd});
  solved.rts = solve(mission, options, true, {}, {});
  const estimate::BackwardKnots backward = backward_knots(mission, options, {}, {});
  for (std::size_t i = 0; i < backward.size(); ++i)
    if (!backward.at(i)) ++solved.without_backward;
  Solution combined = solve(mission, options, true, {}, {}, {}, &backward);
  solved.combined = std::move(combined.smoothed);
  solved.events = std::move(combined.forward.events);
  return solved;
}

const record::NavState* truth_at(const record::Trajectory& truth, geo::GpsTime t) {
  const auto at = std::ranges::lower_bound(truth.states, t + -1e-6, {}, &record::NavState::t);
  return at != truth.states.end() && at->t - t < 1e-5 ? &*at : nullptr;
}

/// Errors of positions, summed up.
struct PositionErrors {
  double squares = 0.0;
  double nees = 0.0;
  double count = 0.0;
  void add(const record::NavState& nav, const Eigen::Matrix3d& cov_n, const record::NavState& truth) {
    const Eigen::Vector3d d = geo::C_n_e(geo::geodetic_from_ecef(truth.r_eb_e)).transpose() * (nav.r_eb_e - truth.r_eb_e);
    squares += d.squaredNorm();
    nees += d.dot(cov_n.ldlt().solve(d));
    ++count;
  }
  [[nodiscard]] double rms() const { return std::sqrt(squares / count); }
};

/// By what is asked of them: outside the gap, in it, and at instants so far apart that they are independent.
struct Tally {
  PositionErrors open;
  PositionErrors gap;
  PositionErrors open_apart;
  PositionErrors gap_middle;
  void add(double elapsed, const record::NavState& nav, const Eigen::Matrix3d& cov_n, const record::NavState& truth) {
    const auto near = [elapsed](double second) { return std::abs(elapsed - second) < 0.05; };
    if (elapsed < kGap || elapsed >= kGapEnd) open.add(nav, cov_n, truth);
    if (elapsed > kGap && elapsed < kGapEnd) gap.add(nav, cov_n, truth);
    for (const double second : {60.0, 90.0, 120.0, 210.0, 240.0, 270.0, 300.0})
      if (near(second)) open_apart.add(nav, cov_n, truth);
    if (near(0.5 * (kGap + kGapEnd))) gap_middle.add(nav, cov_n, truth);
  }
};

Eigen::Matrix3d position_cov_n(const estimate::Knot& knot) {
  return estimate::nav_covariance_n(knot.P_post.topLeftCorner<estimate::kNav, estimate::kNav>(), knot.post.nav.r_eb_e).position;
}

void expect_consistent(const PositionErrors& errors, const char* what) {
  const test::Chi2Bounds bounds = test::chi2_mean_bounds(3.0, errors.count);
  EXPECT_GT(errors.nees / errors.count, bounds.lower) << what;
  EXPECT_LT(errors.nees / errors.count, bounds.upper) << what;
}

TEST(CombinedSolution, IsNearlyAsGoodAsTheSmootherAndItsSigmasHold) {
  constexpr int kSeeds = 12;
  std::map<std::string, Tally> tally;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const simulate::Scenario scenario = test::drive(360.0, 100 + seed);
    const Solved s = solve_both_ways(simulate::simulate(scenario), test::setup_of(scenario));
    EXPECT_EQ(s.without_backward, 0U);
    for (const record::Event& event : s.events) EXPECT_NE(event.kind, "combination_refused") << event.text;
    ASSERT_EQ(s.combined.size(), s.rts.smoothed.size());
    for (std::size_t i = 0; i < s.combined.size(); ++i) {
      const record::NavState* truth = truth_at(s.truth, s.combined[i].nav.t);
      if (truth == nullptr) continue;
      const double elapsed = truth->t - s.start;
      const estimate::Knot knot = s.rts.knots.at(i);
      tally["forward"].add(elapsed, knot.post.nav, position_cov_n(knot), *truth);
      tally["rts"].add(elapsed, s.rts.smoothed[i].nav, s.rts.smoothed[i].cov.position, *truth);
      tally["combined"].add(elapsed, s.combined[i].nav, s.combined[i].cov.position, *truth);
    }
  }
  EXPECT_LT(tally["combined"].open.rms(), 1.05 * tally["rts"].open.rms());
  // Biases are known well after minutes: what the combination loses of them is little even here (3 %, of 20 seeds).
  EXPECT_LT(tally["combined"].gap.rms(), 1.15 * tally["rts"].gap.rms());
  EXPECT_LT(tally["combined"].gap.rms(), 0.15 * tally["forward"].gap.rms());
  expect_consistent(tally["combined"].open_apart, "outside the gap");
  expect_consistent(tally["combined"].gap_middle, "in the middle of the gap");
}

// Without sensor states nothing but the two ends is approximate: there both filters begin with something.
TEST(CombinedSolution, EqualsTheSmootherWhereNavigationStatesAreAll) {
  simulate::Scenario scenario = test::drive(360.0, 5);
  scenario.error_model = noise::ImuErrorModel::from(io::parse_yaml(R"(
schema: coast.imu_error_model/1
gyro: {all: [{process: white_noise, density: 0.1, unit: deg/sqrt(h)}]}
accel: {all: [{process: white_noise, density: 60, unit: ug/sqrt(Hz)}]}
)",
                                                                   "model.yaml"));
  const Solved s = solve_both_ways(simulate::simulate(scenario), test::setup_of(scenario));
  for (std::size_t i = 0; i < s.combined.size(); ++i) {
    const auto d = estimate::error_between(s.combined[i].nav, s.rts.smoothed[i].nav);
    for (Eigen::Index k = 0; k < estimate::kNav; ++k) {
      // A hundredth of the forward filter's information counts twice at the end: 0.5 % of a sigma. Beside it the filters
      // linearise about trajectories of their own.
      EXPECT_NEAR(s.combined[i].sd(k) / s.rts.smoothed[i].sd(k), 1.0, 0.01) << i << " " << k;
      EXPECT_LT(std::abs(d(k)), 0.1 * s.rts.smoothed[i].sd(k)) << i << " " << k;
    }
  }
}

// GNSS errors that last are a state of both filters and would count twice by themselves.
TEST(CombinedSolution, LastingErrorsOfGnssCountOnce) {
  simulate::Scenario scenario = test::drive(360.0, 6);
  scenario.gnss.correlated = simulate::GnssOptions::Correlated{Eigen::Vector3d(0.5, 0.5, 1.0), 60.0};
  scenario.gnss.stated_sd = Eigen::Vector3d(0.01, 0.01, 0.02);
  study::Setup setup = test::setup_of(scenario);
  setup.filter.auxiliary.correlated_gnss = {.horizontal_m = 0.5, .vertical_m = 1.0, .time_s = 60.0};
  const Solved s = solve_both_ways(simulate::simulate(scenario), setup);
  for (std::size_t i = 0; i < s.combined.size(); ++i) {
    const double elapsed = s.combined[i].nav.t - s.start;
    if (elapsed < 60.0 || elapsed > 300.0) continue;
    const double ratio = std::sqrt(s.combined[i].cov.position.trace() / s.rts.smoothed[i].cov.position.trace());
    // Weighted without the errors' state it would be 0.7; better than the optimum it cannot be but by what counts twice of the
    // biases.
    EXPECT_GT(ratio, 0.95) << elapsed;
    EXPECT_LT(ratio, 1.4) << elapsed;
  }
  // At the far end the backward filter knows nothing: what is delivered there is the forward filter's, a hundredth of whose
  // information counts twice.
  const estimate::SmoothedKnot &at_end = s.combined.back(), &forward = s.rts.smoothed.back();
  for (Eigen::Index i = estimate::kNav; i < at_end.x.size(); ++i) {
    EXPECT_NEAR(at_end.x(i), forward.x(i), 0.02 * forward.sd(i)) << i;
    EXPECT_NEAR(at_end.sd(i) / forward.sd(i), 1.0, 0.01) << i;
  }
}

// Knots of both coincide whatever is missing: samples of the IMU, with a gap that ends between knots, and fixes beside it.
TEST(CombinedSolution, KnotsCoincideInGapsOfTheImu) {
  const simulate::Scenario scenario = test::drive(360.0, 7);
  simulate::SimulatedMission recording = simulate::simulate(scenario);
  const geo::GpsTime first = recording.imu.samples.front().t;
  std::erase_if(recording.imu.samples, [&](const record::ImuSample& s) {
    const double t = s.t - first;
    return (t > 100.003 && t < 102.427) || (t > 160.0 && t < 160.3) || (t > 250.11 && t < 250.14);
  });
  std::erase_if(recording.gnss.fixes, [&](const record::GnssFix& fix) {
    const double t = fix.t - first;
    return (t > 99.5 && t < 103.1) || (t > 220.05 && t < 228.13);
  });
  study::Setup setup = test::setup_of(scenario);
  setup.filter.knot_interval_s = 0.37;
  const Solved s = solve_both_ways(std::move(recording), setup);
  EXPECT_EQ(s.without_backward, 0U);
  for (const estimate::SmoothedKnot& knot : s.combined) {
    const record::NavState* truth = truth_at(s.truth, knot.nav.t);
    if (truth == nullptr) continue;
    const auto d = estimate::error_between(knot.nav, *truth);
    for (Eigen::Index k = 0; k < estimate::kNav; ++k)
      EXPECT_LT(std::abs(d(k)), 6.0 * knot.sd(k)) << knot.nav.t - s.start << " s, state " << k;  // 1e-9 each, 2e4 of them
  }
}

/// A drive of whose fixes those of the last third are metres away: forward and backward filter disagree within the gap between
/// good and bad ones.
TEST(CombinedSolution, WhereTheFiltersContradictEachOtherItIsOneOfThem) {
  const simulate::Scenario scenario = test::drive(360.0, 8);
  simulate::SimulatedMission recording = simulate::simulate(scenario);
  const geo::GpsTime first = recording.imu.samples.front().t;
  for (record::GnssFix& fix : recording.gnss.fixes)
    if (fix.t - first > 165.0) fix.r_ea_e.x() += 30.0;
  study::Setup setup = test::setup_of(scenario);
  PreparedMission mission(std::move(recording.imu), std::move(recording.gnss), setup, {});
  const geo::GpsTime start = mission.start().nav.t;
  estimate::FilterOptions options = mission.options();
  options.withheld.push_back({start + kGap, start + kGapEnd});
  const estimate::BackwardKnots backward = backward_knots(mission, options, {}, {});
  const Solution combined = solve(mission, options, true, {}, {}, {}, &backward);
  std::size_t forward_alone = 0, backward_alone = 0;
  for (std::size_t i = 0; i < combined.smoothed.size(); ++i) {
    const double elapsed = combined.smoothed[i].nav.t - start;
    if (elapsed < kGap + 1.0 || elapsed > kGapEnd - 1.0) continue;
    const auto backward_state = backward.at(i);
    ASSERT_TRUE(backward_state.has_value());
    const estimate::Knot forward = combined.knots.at(i);
    const Eigen::Vector3d r = combined.smoothed[i].nav.r_eb_e;
    const bool is_forward = r == forward.post.nav.r_eb_e, is_backward = r == backward_state->nav.r_eb_e;
    EXPECT_TRUE(is_forward || is_backward) << elapsed;
    (is_forward ? forward_alone : backward_alone) += 1;
    const double trace = combined.smoothed[i].cov.position.trace();
    const double trace_f = forward.P_post.topLeftCorner<3, 3>().trace(),
                 trace_b = backward_state->P.topLeftCorner<3, 3>().trace();
    EXPECT_NEAR(trace / (is_forward ? trace_f : trace_b), 1.0, 1e-9);
    EXPECT_LE(trace, 2.0 * std::min(trace_f, trace_b) * (1.0 + 1e-9)) << elapsed;
  }
  EXPECT_GT(forward_alone, 10U);
  EXPECT_GT(backward_alone, 10U);
  const record::Events& events = combined.forward.events;
  const auto refused = std::ranges::find(events, "combination_refused", &record::Event::kind);
  ASSERT_NE(refused, events.end());
  EXPECT_GE(refused->count, static_cast<long>(forward_alone + backward_alone));
  ASSERT_TRUE(refused->time.has_value());
  EXPECT_LE(*refused->time - (start + kGap), 1.0);
}

// What the backward filter begins with: sensor errors as uncertain as they are after the mission without a measurement.
TEST(CombinedSolution, TheFarEndIsAsUncertainAsTheErrorModel) {
  simulate::Scenario scenario = test::drive(360.0, 9);
  scenario.error_model = noise::ImuErrorModel::from(io::parse_yaml(R"(
schema: coast.imu_error_model/1
gyro:
  all: [{process: white_noise, density: 0.1, unit: deg/sqrt(h)}, {process: random_constant, sigma: 5, unit: deg/h},
        {process: random_walk, density: 3, unit: deg/h/sqrt(h)}]
accel:
  all: [{process: white_noise, density: 60, unit: ug/sqrt(Hz)}, {process: gauss_markov, sigma: 0.2, unit: mg, correlation_time_s: 50}]
)",
                                                                   "model.yaml"));
  simulate::SimulatedMission recording = simulate::simulate(scenario);
  const PreparedMission mission(std::move(recording.imu), std::move(recording.gnss), test::setup_of(scenario), {});
  const Solution forward = solve(mission, mission.options(), false, {}, {});
  const estimate::FilterState& last = forward.forward.last;
  const estimate::FilterState end = mission.ignorant_end(last);
  const double hours = (last.nav.t - mission.start().nav.t) / 3600.0;
  for (const auto& block : forward.filter->layout().sensors()) {
    const double sd = std::sqrt(end.P(block.offset, block.offset));
    const double expected = block.process->name() == "random_walk"       ? geo::unit("deg/h").to_si * 3.0 * std::sqrt(hours)
                            : block.process->name() == "random_constant" ? geo::unit("deg/h").to_si * 5.0
                                                                         : geo::unit("mg").to_si * 0.2;
    EXPECT_NEAR(sd / expected, 1.0, 1e-9) << block.name;
    EXPECT_EQ(end.x(block.offset), last.x(block.offset)) << block.name;
  }
  for (Eigen::Index i = 0; i < estimate::kNav; ++i) EXPECT_GE(end.P(i, i), 100.0 * last.P(i, i)) << i;
  EXPECT_EQ(end.nav.r_eb_e, last.nav.r_eb_e);
}

TEST(CombinedSolution, IsRefusedAfterSeveralPasses) {
  const simulate::Scenario scenario = test::drive(360.0, 1);
  simulate::SimulatedMission recording = simulate::simulate(scenario);
  PreparedMission mission(std::move(recording.imu), std::move(recording.gnss), test::setup_of(scenario), {});
  const estimate::FilterState carried = carried_start(mission, mission.options(), 3, {});
  const estimate::BackwardKnots backward = backward_knots(mission, mission.options(), {}, {});
  EXPECT_THROW(static_cast<void>(solve(mission, mission.options(), true, {}, {}, carried, &backward)), std::invalid_argument);
}

}  // namespace
}  // namespace coast::study
