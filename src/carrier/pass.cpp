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
                   const FixedSolution& fixed, const std::vector<Unknown>& contradicted, PpkEpoch& solved) {
  const DoubleDifferences& dd = updated.dd;
  const Eigen::VectorXd left = dd.B.transpose() * (dd.B * (dd.residual - dd.H * step));
  for (std::size_t i = 0; i < dd.rows.size(); ++i) {
    const Row& row = dd.rows[i];
    const SatelliteDifference& satellite = epoch.satellites[row.satellite];
    if (row.observable == Observable::kRate) continue;
    const bool phase = row.observable == Observable::kPhase;
    const BandDifference& band = satellite.bands[row.band];
    const Unknown ambiguity{Unknown::Kind::kAmbiguity, satellite.satellite, band.band, band.arc};
    const bool is_fixed = phase && std::ranges::find(fixed.satellites, satellite.satellite) != fixed.satellites.end();
    const bool is_left_out = phase && std::ranges::find(contradicted, ambiguity) != contradicted.end();
    const auto use = is_left_out ? SignalResidual::Use::kLeftOut
                     : is_fixed  ? SignalResidual::Use::kFixed
                                 : SignalResidual::Use::kFloat;
    solved.residuals.push_back(
        {satellite.satellite, band.band, phase, left(static_cast<Eigen::Index>(i)) * row.sd, row.sd, row.direction, use});
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
/// it is not estimated: effect of one range per satellite with an error of a millimetre per kilometre at the zenith.
Eigen::Matrix3d air_covariance(const std::map<std::size_t, Direction>& satellites, const Eigen::Vector3d& r_e,
                               const DifferenceEpoch& epoch, const PpkOptions& options) {
  constexpr double kPerMetre = 1e-6;
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
  constexpr double kMostPdop = 15.0;
  constexpr double kMostSd = 0.1;  // m, three-dimensional
  return pdop > kMostPdop || !(covariance_e.trace() < kMostSd * kMostSd);
}

int known_among(const std::vector<FixedPair>& fixed, const std::vector<FixedPair>& known) {
  std::set<Unknown> of_known;
  for (const FixedPair& p : known) of_known.insert({p.ambiguity, p.reference});
  return static_cast<int>(std::ranges::count_if(
      fixed, [&](const FixedPair& p) { return of_known.contains(p.ambiguity) && of_known.contains(p.reference); }));
}

/// What an epoch's position is taken from.
struct Chosen {
  bool by_integers = false;
  Eigen::VectorXd step;  ///< of the state, from the linearisation
  Eigen::Matrix3d covariance_e = Eigen::Matrix3d::Zero();
  std::vector<FixedPair> integers;    ///< those that the phases of the epoch agree with
  std::vector<Unknown> contradicted;  ///< ambiguities whose integers they do not agree with
};

bool with_glonass(const FixedSolution& fixed) {
  return std::ranges::any_of(fixed.satellites,
                             [](record::Satellite s) { return s.system == record::SatelliteSystem::kGlonass; });
}

/// @param pdop  of all satellites
Chosen choose(const DifferenceEpoch& epoch, const FloatEpoch& updated, const RelativeState& state, const FixedSolution& fixed,
              double pdop) {
  const auto as_float_with = [&](const Chosen& integers) {
    return Chosen{false, updated.step, state.P.topLeftCorner<3, 3>(), integers.integers, integers.contradicted};
  };
  if (!fixed.fixed) return as_float_with({});
  Chosen chosen{true, fixed.x - (state.x - updated.step), fixed.P.topLeftCorner<3, 3>(), fixed.pairs, {}};
  if (std::optional<IntegerPosition> position = integer_position(epoch, updated, state, fixed)) {
    chosen.contradicted = std::move(position->contradicted);
    std::erase_if(chosen.integers, [&](const FixedPair& pair) {
      return std::ranges::any_of(chosen.contradicted,
                                 [&](const Unknown& u) { return u == pair.ambiguity || u == pair.reference; });
    });
    const bool placed = !badly_placed(position->pdop, position->covariance_e);
    if (placed) {
      chosen.step = std::move(position->step);
      chosen.covariance_e = position->covariance_e;
    }
    if (placed || !with_glonass(fixed)) return placed ? chosen : as_float_with(chosen);
  }
  return badly_placed(pdop, chosen.covariance_e) ? as_float_with(chosen) : chosen;
}

/// A filter on its way through the epochs.
class Passage {
 public:
  Passage(const PpkOptions& options, double interval)
      : options_(options), filter_(options, interval), fixing_(options.fixing) {}

  /// @param known  integers of its phases
  PpkEpoch solve(const DifferenceEpoch& epoch, const std::vector<FixedPair>& known) {
    PpkEpoch solved = alone(epoch);
    updated_ = filter_.step(epoch, known);
    integers_.clear();
    solved.residuals = updated_.left_out;
    solved.shortfall = updated_.shortfall;
    if (!updated_.updated) return solved;
    const RelativeState& state = filter_.state();
    FixedSolution fixed;
    if (options_.fixing.wanted) fixed = fixing_.fix(epoch, updated_, state, known);
    take(fixed, known, solved);
    const std::map<std::size_t, Direction> satellites = directions(updated_);
    solved.satellites = static_cast<int>(satellites.size());
    solved.pdop = pdop_of(satellites);
    Chosen chosen = choose(epoch, updated_, state, fixed, solved.pdop);
    if (fixed.fixed && !chosen.by_integers) solved.shortfall = Shortfall::kBadGeometry;
    solved.quality = chosen.by_integers ? record::FixQuality::kFixed : record::FixQuality::kFloat;
    solved.r_e = (state.x - updated_.step + chosen.step).head<3>();
    solved.covariance_e = chosen.covariance_e + air_covariance(satellites, state.x.head<3>(), epoch, options_);
    add_residuals(epoch, updated_, chosen.step, fixed, chosen.contradicted, solved);
    if (options_.fixing.hold && fixed.fixed) hold(fixed);
    integers_ = std::move(chosen.integers);
    return solved;
  }
  /// Of the last epoch.
  [[nodiscard]] const std::vector<FixedPair>& integers() const { return integers_; }
  [[nodiscard]] const std::vector<Unknown>& restarted() const { return updated_.restarted; }

 private:
  static void take(const FixedSolution& fixed, const std::vector<FixedPair>& known, PpkEpoch& solved) {
    solved.shortfall = fixed.shortfall;
    solved.ratio = fixed.ratio;
    solved.success_rate = fixed.success_rate;
    solved.fixed_ambiguities = fixed.ambiguities;
    solved.known_ambiguities = known_among(fixed.pairs, known);
  }
  void hold(const FixedSolution& fixed) {
    const HeldIntegers agreed = held(hold_.agreed(fixed.pairs), filter_.state());
    if (agreed.nu.size() > 0) filter_.absorb(agreed.H, agreed.nu);
  }

  const PpkOptions& options_;
  RelativeFilter filter_;
  AmbiguityFixing fixing_;
  IntegerHold hold_;
  FloatEpoch updated_;
  std::vector<FixedPair> integers_;
};

}  // namespace

Pass solve_pass(const std::vector<DifferenceEpoch>& epochs, const PpkOptions& options, double interval, bool backward,
                const KnownIntegers& known, const std::function<void(double)>& progress) {
  const std::size_t n = epochs.size();
  Pass solved{std::vector<PpkEpoch>(n), {std::vector<std::vector<FixedPair>>(n), std::vector<std::vector<Unknown>>(n)}};
  Passage passage(options, interval);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t i = backward ? n - 1 - k : k;
    solved.epochs[i] = passage.solve(epochs[i], known.of(epochs[i]));
    solved.ambiguities.fixed[i] = passage.integers();
    solved.ambiguities.restarted[i] = passage.restarted();
    if (progress) progress(static_cast<double>(k + 1) / static_cast<double>(n));
  }
  return solved;
}

}  // namespace coast::carrier
