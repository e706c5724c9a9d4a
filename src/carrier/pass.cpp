#include "pass.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "integer_position.hpp"

namespace coast::carrier {

namespace {

/// The single-point solution, if there is one.
PpkEpoch alone(const DifferenceEpoch& epoch) {
  PpkEpoch solved;
  solved.shown = solved.t = epoch.t;
  solved.satellites = epoch.seen;
  solved.age_s = epoch.age_s.value_or(0.0);
  solved.r_base_e = epoch.r_base_e;
  if (!epoch.alone) return solved;
  solved.t = epoch.t - epoch.alone->clock_s;
  solved.quality = record::FixQuality::kSingle;
  solved.r_e = epoch.alone->r_e;
  solved.covariance_e = epoch.alone->covariance_e;
  solved.velocity = epoch.alone->velocity;
  solved.satellites = epoch.alone->satellites;
  return solved;
}

/// Rows after adjustment to a state: deviation of each from the mean of its group, which is the clock's.
void add_residuals(const DifferenceEpoch& epoch, const FloatEpoch& updated, const Eigen::VectorXd& step,
                   const FixedSolution& fixed, PpkEpoch& solved) {
  const DoubleDifferences& dd = updated.dd;
  const Eigen::VectorXd left = dd.B.transpose() * (dd.B * (dd.residual - dd.H * step));
  for (std::size_t i = 0; i < dd.rows.size(); ++i) {
    const Row& row = dd.rows[i];
    const SatelliteDifference& satellite = epoch.satellites[row.satellite];
    if (row.observable == Observable::kRate) continue;
    const bool phase = row.observable == Observable::kPhase;
    const bool is_fixed = phase && std::ranges::find(fixed.satellites, satellite.satellite) != fixed.satellites.end();
    solved.residuals.push_back({satellite.satellite, satellite.bands[row.band].band, phase,
                                left(static_cast<Eigen::Index>(i)) * row.sd, row.sd, row.direction,
                                is_fixed ? SignalResidual::Use::kFixed : SignalResidual::Use::kFloat});
  }
}

/// Unit vector to a satellite, north, east, down, and 1 for the clock.
Eigen::Vector4d way_n(const Direction& direction) {
  const double c = std::cos(direction.elevation);
  return {c * std::cos(direction.azimuth), c * std::sin(direction.azimuth), -std::sin(direction.elevation), 1.0};
}

/// Satellites of the double differences, and their directions.
std::map<std::size_t, Direction> directions(const FloatEpoch& updated) {
  std::map<std::size_t, Direction> all;
  for (const Row& row : updated.dd.rows) all.emplace(row.satellite, row.direction);
  return all;
}

/// Covariance, N, E, D, of a position from one range per satellite with these sds; none if the geometry is too poor.
template <class Sd>
std::optional<Eigen::Matrix3d> covariance_n(const std::map<std::size_t, Direction>& satellites, const Sd& sd) {
  constexpr std::size_t kUnknowns = 4;
  if (satellites.size() < kUnknowns) return std::nullopt;
  Eigen::Matrix4d N = Eigen::Matrix4d::Zero();
  for (const auto& [satellite, direction] : satellites) {
    const Eigen::Vector4d way = way_n(direction) / sd(direction);
    N += way * way.transpose();
  }
  const Eigen::Matrix3d covariance = N.inverse().topLeftCorner<3, 3>();
  if (!covariance.allFinite() || !(covariance.diagonal().array() > 0.0).all()) return std::nullopt;
  return covariance;
}

/// Ratio of the sd of the position to that of ranges to these satellites; 0 if it cannot be computed.
double pdop_of(const std::map<std::size_t, Direction>& satellites) {
  const auto covariance = covariance_n(satellites, [](const Direction&) { return 1.0; });
  return covariance ? std::sqrt(covariance->trace()) : 0.0;
}

/// The difference of the atmosphere at both ends moves the position equally in all bands, so that residuals do not show it. If
/// it is not estimated: effect of one range per satellite with an error of 0.7 mm per kilometre at the zenith.
Eigen::Matrix3d air_covariance(const std::map<std::size_t, Direction>& satellites, const Eigen::Vector3d& r_e,
                               const DifferenceEpoch& epoch, const PpkOptions& options) {
  constexpr double kPerMetre = 7e-7;
  if (!options.differences.air.troposphere || (options.air && options.air->ionosphere)) return Eigen::Matrix3d::Zero();
  const double zenith = kPerMetre * (r_e - epoch.r_base_e).norm();
  const auto covariance =
      covariance_n(satellites, [&](const Direction& d) { return zenith / std::max(std::sin(d.elevation), 0.1); });
  if (!covariance) return Eigen::Matrix3d::Zero();
  const Eigen::Matrix3d C_n_e = geo::C_n_e(geo::geodetic_from_ecef(r_e));
  return C_n_e * *covariance * C_n_e.transpose();
}

/// Integers are not accepted as a fix if errors not included in the noise could be decimetres.
bool badly_placed(double pdop, const Eigen::Matrix3d& covariance_e) {
  constexpr double kMostPdop = 10.0;
  constexpr double kMostSd = 0.1;  // m, three-dimensional
  return pdop > kMostPdop || !(covariance_e.trace() < kMostSd * kMostSd);
}

int known_among(const std::vector<FixedPair>& fixed, const std::vector<FixedPair>& known) {
  std::set<Unknown> of_known;
  for (const FixedPair& p : known) of_known.insert({p.ambiguity, p.reference});
  return static_cast<int>(std::ranges::count_if(
      fixed, [&](const FixedPair& p) { return of_known.contains(p.ambiguity) && of_known.contains(p.reference); }));
}

/// What is carried from epoch to epoch.
struct PassState {
  RelativeFilter filter;
  AmbiguityFixing fixing;
  IntegerHold hold;
};

PpkEpoch solve(const DifferenceEpoch& epoch, const PpkOptions& options, const std::vector<FixedPair>& known, PassState& pass,
               std::vector<FixedPair>& integers, std::vector<Unknown>& restarted) {
  RelativeFilter& filter = pass.filter;
  PpkEpoch solved = alone(epoch);
  const FloatEpoch updated = filter.step(epoch, known);
  restarted = updated.restarted;
  solved.residuals = updated.left_out;
  solved.shortfall = updated.shortfall;
  if (!updated.updated) return solved;
  const RelativeState& state = filter.state();
  FixedSolution fixed;
  if (options.fixing.wanted) fixed = pass.fixing.fix(epoch, updated, state, known);
  integers = fixed.pairs;
  solved.shortfall = fixed.shortfall;
  solved.ratio = fixed.ratio;
  solved.success_rate = fixed.success_rate;
  solved.fixed_ambiguities = fixed.ambiguities;
  solved.known_ambiguities = known_among(fixed.pairs, known);
  const std::map<std::size_t, Direction> satellites = directions(updated);
  solved.satellites = static_cast<int>(satellites.size());
  solved.pdop = pdop_of(satellites);
  Eigen::VectorXd step = (fixed.fixed ? fixed.x : state.x) - (state.x - updated.step);
  solved.covariance_e = (fixed.fixed ? fixed.P : state.P).topLeftCorner<3, 3>();
  double pdop = solved.pdop;
  if (fixed.fixed) {
    if (const std::optional<IntegerPosition> alone = integer_position(epoch, updated, state, fixed)) {
      pdop = alone->pdop;
      if (!badly_placed(pdop, alone->covariance_e)) {
        step = alone->step;
        solved.covariance_e = alone->covariance_e;
      }
      std::erase_if(integers, [&](const FixedPair& pair) {
        return std::ranges::any_of(alone->contradicted,
                                   [&](const Unknown& u) { return u == pair.ambiguity || u == pair.reference; });
      });
    }
    if (badly_placed(pdop, solved.covariance_e)) solved.shortfall = Shortfall::kBadGeometry;
  }
  solved.r_e = (state.x - updated.step + step).head<3>();
  const bool precise = fixed.fixed && solved.shortfall == Shortfall::kNone;
  solved.quality = precise ? record::FixQuality::kFixed : record::FixQuality::kFloat;
  solved.covariance_e += air_covariance(satellites, state.x.head<3>(), epoch, options);
  add_residuals(epoch, updated, step, fixed, solved);
  if (options.fixing.hold && fixed.fixed) {
    const HeldIntegers agreed = held(pass.hold.agreed(fixed.pairs), state);
    if (agreed.nu.size() > 0) filter.absorb(agreed.H, agreed.nu);
  }
  return solved;
}

}  // namespace

Pass solve_pass(const std::vector<DifferenceEpoch>& epochs, const PpkOptions& options, double interval, bool backward,
                const KnownIntegers& known, const std::function<void(double)>& progress) {
  const std::size_t n = epochs.size();
  Pass solved{std::vector<PpkEpoch>(n),
              {std::vector<std::vector<FixedPair>>(n), std::vector<std::vector<Unknown>>(n)}};
  PassState pass{RelativeFilter(options, interval), AmbiguityFixing(options.fixing), {}};
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t i = backward ? n - 1 - k : k;
    solved.epochs[i] = solve(epochs[i], options, known.of(epochs[i]), pass, solved.ambiguities.fixed[i],
                             solved.ambiguities.restarted[i]);
    if (progress) progress(static_cast<double>(k + 1) / static_cast<double>(n));
  }
  return solved;
}

}  // namespace coast::carrier
