// Carrier phases in the navigation filter: against the textbook's smoother, against the truth, and with few satellites.

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "coast/carrier/base_position.hpp"
#include "coast/estimate/smoother.hpp"
#include "coast/simulate/observations.hpp"
#include "estimate/mission.hpp"

namespace coast {
namespace {

using namespace estimate;

constexpr double kTightDuration = 60.0;

simulate::ObservationOptions white_noise_alone() {
  simulate::ObservationOptions options;
  options.code_multipath_sd = options.phase_multipath_sd = 0.0;
  options.ionosphere_gradient = options.wet_zenith_sd = 0.0;
  options.lever_arm_b = {0.5, 0.2, -1.0};
  return options;
}

/// A drive whose GNSS are observations of rover and base.
struct TightMission {
  noise::ImuErrorModel model = test::error_model(test::kIndustrialModel);
  test::Recording recording;
  CarrierObservations observations;
  std::unique_ptr<ForwardFilter> filter;
  FilterState start;

  explicit TightMission(std::uint64_t seed, const simulate::ObservationOptions& options = white_noise_alone(),
                        const FilterOptions& filtering = {}) {
    simulate::GnssOptions gnss;
    gnss.lever_arm_b = options.lever_arm_b;
    recording = test::make_recording({.duration = kTightDuration, .gnss = gnss}, &model, seed);
    const auto observed = simulate::simulate_observations(test::weaving(kTightDuration), test::mission_start(), options, seed);
    carrier::PpkOptions ppk;
    ppk.air = carrier::AirStates{};
    const auto base = [&observed](geo::GpsTime) { return std::optional(observed.r_base_e); };
    observations = carrier_observations(
        carrier::solve_ppk(observed.rover, observed.base, carrier::BroadcastOrbits(observed.navigation), base, ppk), ppk);
    Mission mission = recording.mission();
    mission.carrier = &observations;
    filter = std::make_unique<ForwardFilter>(mission, model, filtering);
    std::mt19937_64 random(seed + 100);
    start = test::drawn_start(*filter, recording.truth(test::mission_start()), {}, random);
  }
  TightMission(const TightMission&) = delete;
  TightMission& operator=(const TightMission&) = delete;

  [[nodiscard]] FilterResult run(KnotStore* knots) const {
    FilterOutputs outputs;
    outputs.knots = knots;
    return filter->run(start, outputs);
  }
};

Eigen::MatrixXd dense_transition(const StateLayout& layout, const Knot& knot) {
  const Eigen::Index n = layout.size();
  Eigen::MatrixXd Phi = Eigen::MatrixXd::Identity(n, n);
  Eigen::MatrixXd D = Eigen::MatrixXd::Identity(n - kNav, n - kNav);
  BlockTransitions(layout).over(knot.interval).apply(D);
  Phi.bottomRightCorner(n - kNav, n - kNav) = D;
  Phi.topLeftCorner(kNav, knot.Phi_n.cols()) = knot.Phi_n;
  return Phi;
}

// Rauch, Tung, Striebel (1965), with unknowns that begin and end: F is the transition and then the change of the slots, and
// the covariance before the updates follows from the one behind them.
TEST(TightCoupling, SmootherEqualsTheTextbookRecursionThroughChangingUnknowns) {
  simulate::ObservationOptions options = white_noise_alone();
  options.slips_per_hour = 60.0;
  options.obstacles = {{{20.0, 12.0}, 0.0, 3.0, 1.0}};
  const TightMission mission(3, options);
  KnotStore store;
  static_cast<void>(mission.run(&store));
  const StateLayout& layout = mission.filter->layout();
  const std::vector<SmoothedKnot> smoothed = smooth(store, layout);
  std::size_t last = store.size() - 1;
  Eigen::VectorXd s = Eigen::VectorXd::Zero(layout.size());
  Eigen::MatrixXd P_s = store.at(last).P_post;
  int changes = 0;
  for (std::size_t k = last; k-- > 0;) {
    const Knot knot = store.at(k), next = store.at(k + 1);
    Eigen::MatrixXd F = dense_transition(layout, knot);
    if (next.slot_factors.size() > 0) {
      F.bottomRows(next.slot_factors.size()).array().colwise() *= next.slot_factors.array();
      changes += static_cast<int>((next.slot_factors.array() == 0.0).count());
    }
    Eigen::MatrixXd P_pred = next.P_post;
    for (auto u = next.updates.rbegin(); u != next.updates.rend(); ++u) P_pred += u->K * u->S_inv.inverse() * u->K.transpose();
    Eigen::MatrixXd invertible = P_pred;  // free slots are nothing
    for (Eigen::Index i = 0; i < invertible.rows(); ++i)
      if (invertible(i, i) == 0.0) invertible(i, i) = 1.0;
    const Eigen::MatrixXd G = invertible.ldlt().solve(F * knot.P_post).transpose();
    for (const AppliedUpdate& u : next.updates) s += u.K * u.y;
    s = (G * s).eval();
    P_s = (knot.P_post + G * (P_s - P_pred) * G.transpose()).eval();
    // Rounding of P_pred, put together again, times its condition: variances of ambiguities go from 1e4 to 1e-6 in an epoch.
    const Eigen::VectorXd sd = P_s.diagonal().cwiseMax(0.0).cwiseSqrt();
    const Eigen::Matrix<double, kNav, 1> removed = error_between(knot.post.nav, smoothed[k].nav);
    EXPECT_LE((removed - s.head<kNav>()).cwiseAbs().cwiseQuotient(sd.head<kNav>()).maxCoeff(), 1e-4) << k;
    EXPECT_LE((smoothed[k].sd.head<kNav>() - sd.head<kNav>()).cwiseQuotient(sd.head<kNav>()).cwiseAbs().maxCoeff(), 1e-4) << k;
  }
  EXPECT_GT(changes, 30);
}

// Errors against covariance at the end of independent missions: 20 times 9 degrees of freedom, within the 99.9 % interval of
// chi-square over its degrees of freedom.
TEST(TightCoupling, ErrorsHaveTheSizeThatTheFilterSays) {
  constexpr int kMissions = 20;
  double nees = 0.0;
  for (std::uint64_t seed = 1; seed <= kMissions; ++seed) {
    const TightMission mission(seed);
    const FilterState last = mission.run(nullptr).last;
    const auto d = error_between(last.nav, mission.recording.truth(last.nav.t));
    nees += d.dot(last.P.topLeftCorner<kNav, kNav>().ldlt().solve(d));
  }
  const double mean = nees / (9.0 * kMissions);
  EXPECT_GT(mean, 0.69);
  EXPECT_LT(mean, 1.38);
}

// GNSS is cut down to some satellites half-way; 20 s to 30 s later an inertial position of this IMU is metres off.
TEST(TightCoupling, FewerSatellitesThanAFixNeedsHelp) {
  std::map<int, double> drift;
  for (const int satellites : {0, 1, 2, 3}) {
    double squares = 0.0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      FilterOptions options;
      options.withheld.push_back({test::mission_start() + 30.0, test::mission_start() + kTightDuration + 1.0, satellites});
      const TightMission mission(seed, white_noise_alone(), options);
      const FilterState last = mission.run(nullptr).last;
      squares += (last.nav.r_eb_e - mission.recording.truth(last.nav.t).r_eb_e).squaredNorm();
    }
    drift[satellites] = std::sqrt(squares / 6.0);
  }
  EXPECT_NEAR(drift[1] / drift[0], 1.0, 1e-9);  // the clocks take what one satellite tells
  EXPECT_LT(drift[2], 0.8 * drift[0]);          // a third of the directions is held to centimetres
  EXPECT_LT(drift[3], 0.5 * drift[0]);
}

}  // namespace
}  // namespace coast
