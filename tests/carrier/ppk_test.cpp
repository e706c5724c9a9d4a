// Carrier-phase positions against the truth of simulated missions. The simulator shares orbits and a mean atmosphere with
// the solver; light times, clocks, ambiguities, noise and slips are its own.

#include "coast/carrier/ppk.hpp"

#include "coast/carrier/base_position.hpp"
#include "coast/carrier/signals.hpp"
#include "coast/carrier/solid_tides.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "coast/record/error.hpp"
#include "io/files.hpp"
#include "simulated.hpp"

namespace coast::carrier {
namespace {

using record::FixQuality;
using record::SatelliteSystem;

TEST(Ppk, MeetsTheTruthToAMillimetreWithoutErrors) {
  const SimulatedBaseline mission("car_roundabout", 400.0, error_free());
  const PpkSolution solution = mission.solve({});
  const Errors e = errors_of(mission, solution);
  EXPECT_EQ(e.fixed, solution.epochs.size());
  // Phases are rounded to 0.001 cycles.
  EXPECT_LT(e.largest_fixed, 2e-3);
  EXPECT_FALSE(solution.air.ionosphere);  // 3 km
}

TEST(Ppk, FixesARealisticCarWithHonestSigmas) {
  simulate::ObservationOptions options;
  options.phase_multipath_sd = 0.001;
  options.slips_per_hour = 20.0;
  std::size_t epochs = 0, fixed = 0, wrong = 0;
  double nees = 0.0;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const SimulatedBaseline mission("car_roundabout", 600.0, options, seed);
    const Errors e = errors_of(mission, mission.solve({}));
    epochs += mission.observed.rover.epochs.size();
    fixed += e.fixed;
    wrong += e.wrong;
    nees += e.fixed_nees / 3.0;
    EXPECT_LT(e.velocity_rms, 0.1) << seed;  // of a car at 1 Hz
  }
  EXPECT_GE(fixed, epochs * 99 / 100);
  EXPECT_EQ(wrong, 0U);
  // Sigmas within a factor of 1.5; errors last (multipath, air), so that three missions are few independent ones.
  EXPECT_GT(nees, 1.0 / (1.5 * 1.5));
  EXPECT_LT(nees, 1.5 * 1.5);
}

TEST(Ppk, FloatsAreAsGoodAsTheySay) {
  PpkOptions options;
  options.fixing.wanted = false;
  options.order = PassOrder::kForward;
  double nees = 0.0;
  constexpr int kSeeds = 6;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const SimulatedBaseline mission("car_roundabout", 400.0, simulate::ObservationOptions{}, seed);
    nees += errors_of(mission, mission.solve(options)).float_nees / kSeeds;
  }
  // One ambiguity solution a mission: 3 x 6 errors, about independent; within a factor of 1.5 in sigma.
  EXPECT_GT(nees, 1.0 / (1.5 * 1.5));
  EXPECT_LT(nees, 1.5 * 1.5);
}

TEST(Ppk, ComesBackBehindBridgesAndSaysWhyItWasGone) {
  simulate::ObservationOptions options;
  options.phase_multipath_sd = 0.001;
  options.obstacles = {{{200.0, 20.0}, 0.0, 6.2831, 80.0 * geo::kDegree},  // a tunnel, nearly
                       {{300.0, 60.0}, 60.0 * geo::kDegree, 240.0 * geo::kDegree, 60.0 * geo::kDegree}};
  const SimulatedBaseline mission("car_roundabout", 500.0, options);
  const PpkSolution solution = mission.solve({});
  const Errors e = errors_of(mission, solution);
  EXPECT_EQ(e.wrong, 0U);
  EXPECT_GE(e.fixed, solution.epochs.size() - 25);
  for (const PpkEpoch& epoch : solution.epochs) {
    const double t = epoch.shown - mission.start;
    const bool in_tunnel = t >= 200.0 && t < 220.0;
    if (in_tunnel) {
      EXPECT_NE(epoch.shortfall, Shortfall::kNone) << t;
    }
    if (epoch.quality != FixQuality::kFixed) {
      EXPECT_NE(epoch.shortfall, Shortfall::kNone) << t;
    }
    if (epoch.quality == FixQuality::kFixed) {
      EXPECT_EQ(epoch.shortfall, Shortfall::kNone) << t;
    }
  }
}

TEST(Ppk, SolvesSystemsOfWhichNoRecordingIsAtHand) {
  simulate::ObservationOptions options;
  options.phase_multipath_sd = 0.001;
  for (const auto& systems :
       {std::vector{SatelliteSystem::kBeidou}, std::vector{SatelliteSystem::kGps, SatelliteSystem::kGlonass},
        std::vector{SatelliteSystem::kGalileo, SatelliteSystem::kBeidou}}) {
    options.systems = systems;
    const SimulatedBaseline mission("car_roundabout", 400.0, options);
    const Errors e = errors_of(mission, mission.solve({}));
    EXPECT_GE(e.fixed, 390U) << record::name_of(systems.back());
    EXPECT_EQ(e.wrong, 0U) << record::name_of(systems.back());
  }
}

// Receivers of two makes: up to 5 cm from one channel to the next (Wanninger 2012), a quarter of a cycle, three cycles over
// all.
TEST(Ppk, IntegersOfGlonassAreFoundWithInterFrequencyBiases) {
  simulate::ObservationOptions options;
  options.systems = {SatelliteSystem::kGps, SatelliteSystem::kGlonass};
  options.phase_multipath_sd = 0.001;
  for (const double bias : {0.0, 0.03, -0.03}) {
    SimulatedBaseline mission("car_roundabout", 400.0, options);
    for (record::ObservationEpoch& epoch : mission.observed.rover.epochs)
      for (record::Observation& o : epoch.observations) {
        if (o.satellite.system != SatelliteSystem::kGlonass || !o.phase_cycles) continue;
        const int channel = mission.observed.rover.glonass_channels.at(o.satellite.number);
        *o.phase_cycles += bias * channel * *carrier_frequency(o.satellite.system, o.signal.band, channel) / kSpeedOfLight;
      }
    const PpkSolution solution = mission.solve({});
    const Errors e = errors_of(mission, solution);
    EXPECT_GE(e.fixed, 390U) << bias;
    EXPECT_EQ(e.wrong, 0U) << bias;
    std::size_t phases = 0, fixed = 0;
    for (const PpkEpoch& epoch : solution.epochs)
      for (const SignalResidual& r : epoch.residuals) {
        if (!r.phase || r.satellite.system != SatelliteSystem::kGlonass) continue;
        ++phases;
        fixed += r.use == SignalResidual::Use::kFixed ? 1 : 0;
      }
    EXPECT_GT(static_cast<double>(fixed), 0.7 * static_cast<double>(phases)) << bias;
  }
}

TEST(Ppk, EstimatesTheIonosphereOverLongBaselines) {
  simulate::ObservationOptions options;
  options.base_n = {25000.0, 0.0, 0.0};
  options.code_multipath_sd = 0.1;
  options.phase_multipath_sd = 0.0005;
  const SimulatedBaseline mission("car_roundabout", 900.0, options);
  PpkOptions with;
  const PpkSolution solution = mission.solve(with);
  EXPECT_TRUE(solution.air.ionosphere);
  EXPECT_TRUE(solution.air.zenith_delay);
  const Errors e = errors_of(mission, solution);
  // Half of a quarter of an hour is what the ambiguities take until they can be told; of those fixed a hundredth may be wrong,
  // as the success rate asked for says.
  EXPECT_GE(e.fixed, solution.epochs.size() / 2);
  EXPECT_LE(e.wrong, solution.epochs.size() / 100);
}

// Nothing is known of the ionosphere beforehand: 25 m of delay over 25 km, a storm, is as good as none.
TEST(Ppk, IonosphereFreeStandsWhateverIonosphere) {
  simulate::ObservationOptions options;
  options.base_n = {25000.0, 0.0, 0.0};
  options.code_multipath_sd = 0.1;
  options.phase_multipath_sd = 0.0005;
  options.wet_zenith_sd = 0.0;
  std::array<double, 2> rms{};
  for (const bool storm : {false, true}) {
    options.ionosphere_gradient = storm ? 1e-3 : 0.0;
    const SimulatedBaseline mission("car_roundabout", 500.0, options);
    PpkOptions ppk;
    ppk.differences.air.ionosphere_free = true;
    ppk.fixing.wanted = false;
    ppk.noise = NoiseScale{};
    const PpkSolution solution = mission.solve(ppk);
    EXPECT_TRUE(solution.air.unbounded);
    double squares = 0.0;
    for (const PpkEpoch& epoch : solution.epochs) squares += (epoch.r_e - mission.truth(epoch.t).r_eb_e).squaredNorm();
    rms.at(storm ? 1 : 0) = std::sqrt(squares / static_cast<double>(solution.epochs.size()));
  }
  EXPECT_LT(rms[0], 1.0);
  EXPECT_NEAR(rms[1], rms[0], 0.05);
}

TEST(Ppk, TakesTheTideOffOverLongBaselines) {
  simulate::ObservationOptions options = error_free();
  options.base_n = {90000.0, 0.0, 0.0};
  const SimulatedBaseline mission("car_roundabout", 360.0, options);
  PpkOptions ppk;
  ppk.noise = NoiseScale{};
  const PpkSolution solution = mission.solve(ppk);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double fixed = 0.0;
  for (const PpkEpoch& epoch : solution.epochs) {
    if (epoch.quality != FixQuality::kFixed) continue;
    mean += epoch.r_e - mission.truth(epoch.t).r_eb_e;
    fixed += 1.0;
  }
  ASSERT_GT(fixed, 100.0);
  mean /= fixed;
  // The simulated Earth is rigid: what is taken off is seen.
  const geo::GpsTime t = mission.start + 150.0;
  const Eigen::Vector3d expected = solid_tide(mission.observed.r_base_e, t) - solid_tide(mission.truth(t).r_eb_e, t);
  EXPECT_GT(expected.norm(), 0.003);
  EXPECT_LT((mean - expected).norm(), 0.0005);
}

TEST(Ppk, NoiseScalesFollowTheNoise) {
  simulate::ObservationOptions quiet;
  quiet.code_multipath_sd = quiet.phase_multipath_sd = quiet.ionosphere_gradient = quiet.wet_zenith_sd = 0.0;
  simulate::ObservationOptions loud = quiet;
  loud.code_sd *= 3.0;
  loud.phase_sd *= 3.0;
  const NoiseScale a = SimulatedBaseline("car_roundabout", 400.0, quiet).solve({}).noise;
  const NoiseScale b = SimulatedBaseline("car_roundabout", 400.0, loud).solve({}).noise;
  // Thousands of residuals know a scale to a percent; phases are quantised, elevations weighted not quite as simulated.
  EXPECT_NEAR(b.phase / a.phase, 3.0, 0.15);
  EXPECT_NEAR(b.code / a.code, 3.0, 0.15);
  EXPECT_NEAR(a.code_inflation, 1.0, 0.1);  // white
}

TEST(Ppk, MovingBaseGivesTheBaseline) {
  const SimulatedBaseline mission("car_roundabout", 400.0, [] {
    simulate::ObservationOptions options;
    options.base_n = {30.0, 10.0, 0.0};
    options.phase_multipath_sd = 0.001;
    return options;
  }());
  const BroadcastOrbits orbits(mission.observed.navigation);
  const KnownBase base = known_base({BaseAt::How::kMoving, {}}, mission.observed.base, orbits, {});
  const PpkSolution solution = solve_ppk(mission.observed.rover, mission.observed.base, orbits, base.at, {});
  std::size_t fixed = 0;
  for (const PpkEpoch& epoch : solution.epochs) {
    if (epoch.quality != FixQuality::kFixed) continue;
    ++fixed;
    const Eigen::Vector3d baseline = epoch.r_e - epoch.r_base_e;
    const Eigen::Vector3d truth = mission.truth(epoch.t).r_eb_e - mission.observed.r_base_e;
    // A base that is some metres off turns the baseline by metres over 20 000 km.
    EXPECT_LT((baseline - truth).norm(), 0.05);
  }
  EXPECT_GE(fixed, 390U);
}

TEST(Ppk, KnowsTheBaseByWhateverTellsIt) {
  SimulatedBaseline mission("car_roundabout", 360.0, error_free());
  record::ObservationRecording& base = mission.observed.base;
  const BroadcastOrbits orbits(mission.observed.navigation);
  const Eigen::Vector3d r_e = mission.observed.r_base_e;
  // Codes are rounded to a millimetre, and broadcast ionosphere and group delays are not there.
  EXPECT_LT((known_base({BaseAt::How::kAverage, {}}, base, orbits, {}).r_e - r_e).norm(), 3e-3);
  base.antenna_offset_enu = {0.1, -0.2, 1.5};
  const auto above = [&](const KnownBase& known) {
    return Eigen::Vector3d(geo::C_n_e(geo::geodetic_from_ecef(r_e)).transpose() * (known.r_e - r_e));
  };
  for (const BaseAt& base_at : {BaseAt{BaseAt::How::kHeader, {}}, BaseAt{BaseAt::How::kGiven, r_e}})
    EXPECT_LT((above(known_base(base_at, base, orbits, {})) - Eigen::Vector3d(-0.2, 0.1, -1.5)).norm(), 1e-8);
  base.approximate_r_e.reset();
  EXPECT_THROW(static_cast<void>(known_base({BaseAt::How::kHeader, {}}, base, orbits, {})), InputError);
}

/// A mission whose base is examined against its own codes.
struct Examined {
  SimulatedBaseline mission;
  BroadcastOrbits orbits;
  DifferenceOptions options;

  Examined() : mission("car_roundabout", 360.0, simulate::ObservationOptions{}), orbits(mission.observed.navigation) {
    options.air.ionosphere = mission.observed.navigation.gps_ionosphere;
  }
  [[nodiscard]] record::Events operator()(const BaseAt& base_at, const record::ObservationRecording& base) const {
    return examine_base(base_at, known_base(base_at, base, orbits, options), base, orbits, options);
  }
  [[nodiscard]] record::Events given(const Eigen::Vector3d& r_e) const {
    return (*this)({BaseAt::How::kGiven, r_e}, mission.observed.base);
  }
  [[nodiscard]] std::string refusal(const BaseAt& base_at, const record::ObservationRecording& base) const {
    return test::refusal([&] { static_cast<void>((*this)(base_at, base)); });
  }
};

TEST(Ppk, BaseThatItsOwnCodesPutElsewhereIsDoubtful) {
  const Examined examine;
  const Eigen::Vector3d r_e = examine.mission.observed.r_base_e;
  EXPECT_TRUE(examine.given(r_e).empty());
  const Eigen::Matrix3d C_n_e = geo::C_n_e(geo::geodetic_from_ecef(r_e));
  const record::Events events = examine.given(r_e + C_n_e * Eigen::Vector3d(65.0, -85.0, 0.0));
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].kind, "base_position_doubtful");
  EXPECT_EQ(events[0].severity, record::Event::Severity::kWarning);
  for (const char* part : {"north 6", "east -8", "sigma", "base_position: {ecef_m"})  // codes are good to metres
    EXPECT_NE(events[0].text.find(part), std::string::npos) << events[0].text;
  record::ObservationRecording base = examine.mission.observed.base;
  EXPECT_TRUE(examine({BaseAt::How::kHeader, {}}, base).empty());
  base.approximate_r_e = r_e + C_n_e * Eigen::Vector3d(0.0, 8.0, 0.0);
  const record::Events header = examine({BaseAt::How::kHeader, {}}, base);
  ASSERT_EQ(header.size(), 1U);
  EXPECT_NE(header[0].text.find("approximate"), std::string::npos) << header[0].text;
  EXPECT_TRUE(examine({BaseAt::How::kAverage, {}}, base).empty());
  // Nobody stated it: it is said where it is from, however near.
  const record::Events unsaid = examine({BaseAt::How::kUnstated, {}}, examine.mission.observed.base);
  ASSERT_EQ(unsaid.size(), 1U);
  EXPECT_NE(unsaid[0].text.find("or base_position: header"), std::string::npos) << unsaid[0].text;
}

TEST(Ppk, BaseOnTheOtherSideOfTheEarthIsRefused) {
  const Examined examine;
  const record::ObservationRecording& base = examine.mission.observed.base;
  const Eigen::Vector3d r_e = examine.mission.observed.r_base_e;
  for (const auto& [sign, name] :
       {std::pair{Eigen::Vector3d(-1.0, -1.0, -1.0), "x, y and z"}, std::pair{Eigen::Vector3d(1.0, 1.0, -1.0), "of z"},
        std::pair{Eigen::Vector3d(-1.0, -1.0, 1.0), "x and y"}}) {
    const BaseAt base_at{BaseAt::How::kGiven, r_e.cwiseProduct(sign)};
    const std::string said = examine.refusal(base_at, base);
    const double km = 1e-3 * (base_at.r_e - r_e).norm();
    EXPECT_NE(said.find(fmt::format("{:.0f} km from where", km)), std::string::npos) << said;
    EXPECT_NE(said.find(fmt::format("{} changed it fits: a sign?", name)), std::string::npos) << said;
  }
  const std::string said = examine.refusal({BaseAt::How::kGiven, r_e + Eigen::Vector3d(0.0, 40e3, 0.0)}, base);
  EXPECT_NE(said.find("40 km from where"), std::string::npos) << said;
  EXPECT_EQ(said.find("sign"), std::string::npos) << said;
  record::ObservationRecording flipped = base;  // where the header is wrong, its position is no start of the codes' solution
  flipped.approximate_r_e = -r_e;
  EXPECT_NE(examine.refusal({BaseAt::How::kHeader, {}}, flipped).find("a sign?"), std::string::npos);
}

TEST(Ppk, BaseThatMovesIsTakenForTheRover) {
  const Examined examine;
  const record::ObservationRecording& rover = examine.mission.observed.rover;
  const BaseAt given{BaseAt::How::kGiven, examine.mission.observed.r_base_e};
  const std::string said = examine.refusal(given, rover);
  EXPECT_NE(said.find("the file given as base moves by"), std::string::npos) << said;
  EXPECT_NE(said.find("Are rover and base exchanged?"), std::string::npos) << said;
  EXPECT_TRUE(examine({BaseAt::How::kMoving, {}}, rover).empty());
}

// A station's sheet states ETRF2000 at 2010; Europe drifts by 2.5 cm a year in ITRF, ETRF by nothing.
TEST(Ppk, BringsTheBaseFromItsFrameAndEpoch) {
  SimulatedBaseline mission("car_roundabout", 360.0, error_free());
  const record::ObservationRecording& base = mission.observed.base;
  const BroadcastOrbits orbits(mission.observed.navigation);
  const Eigen::Vector3d r_e = mission.observed.r_base_e;
  const geo::FrameEpoch sheet{"ETRF2000", 2010.0};
  const double year = 2025.0 + 189.4 / 365.0;  // 8 July 2025, 10 h
  const auto velocity = geo::plate_velocity("EURA", r_e, sheet.frame);
  ASSERT_TRUE(velocity);
  const BaseAt base_at{BaseAt::How::kGiven, r_e, BaseAt::Datum{sheet, *velocity}};
  const Eigen::Vector3d moved = known_base(base_at, base, orbits, {}).r_e - r_e;
  const Eigen::Vector3d expected = geo::transform(r_e, sheet, {"ITRF2020", year}, *velocity) - r_e;
  EXPECT_LT((moved - expected).norm(), 1e-4);  // a day of 2.5 cm a year
  // 36.4 years after 1989, when both were one, at 2.5 cm a year: 0.9 m.
  EXPECT_NEAR(moved.norm(), 0.9, 0.1);
}

TEST(Ppk, SaysWhatIsMissing) {
  const SimulatedBaseline mission("car_roundabout", 360.0, simulate::ObservationOptions{});
  const BroadcastOrbits orbits(mission.observed.navigation);
  const BasePosition position = [&](geo::GpsTime) { return std::optional(mission.observed.r_base_e); };
  record::ObservationRecording later = mission.observed.base;
  for (record::ObservationEpoch& epoch : later.epochs) epoch.t = epoch.t + 86400.0;
  EXPECT_THROW(static_cast<void>(solve_ppk(mission.observed.rover, later, orbits, position, {})), InputError);
  PpkOptions other;
  other.differences.systems = {SatelliteSystem::kBeidou};
  EXPECT_THROW(static_cast<void>(solve_ppk(mission.observed.rover, mission.observed.base, orbits, position, other)),
               InputError);
  record::NavigationRecording none;
  EXPECT_THROW(static_cast<void>(solve_ppk(mission.observed.rover, mission.observed.base, BroadcastOrbits(none), position, {})),
               InputError);
}

TEST(Ppk, FixesBecomeARecordingForTheFilter) {
  const SimulatedBaseline mission("car_roundabout", 360.0, simulate::ObservationOptions{});
  const PpkSolution solution = mission.solve({});
  const record::GnssRecording fixes = to_fixes(solution, "rover.obs");
  ASSERT_EQ(fixes.fixes.size(), solution.epochs.size());
  const record::GnssFix& fix = fixes.fixes[100];
  const PpkEpoch& epoch = solution.epochs[100];
  EXPECT_EQ(fix.r_ea_e, epoch.r_e);
  EXPECT_NEAR(fix.position_cov_n.trace(), epoch.covariance_e.trace(), 1e-12);
  EXPECT_EQ(fix.quality, FixQuality::kFixed);
  ASSERT_TRUE(fix.velocity);
  EXPECT_NEAR(fix.velocity->v_ea_n.norm(), epoch.velocity->v_e.norm(), 1e-9);
}

}  // namespace
}  // namespace coast::carrier
