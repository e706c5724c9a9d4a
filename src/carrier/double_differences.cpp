#include "double_differences.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>

#include "coast/carrier/signals.hpp"
#include "coast/carrier/wind_up.hpp"

namespace coast::carrier {

namespace {

constexpr double kCodeToPhase = 100.0;  // sd of a code over that of its phase

/// Thermal noise, multipath and residual errors of the atmosphere models, m^2.
double phase_variance(double elevation, double cn0) {
  constexpr double kFloor = 0.002;    // m, at the zenith as much again
  constexpr double kThermal = 0.001;  // m at 45 dB-Hz
  constexpr double kStrong = 45.0;    // dB-Hz
  const double sine = std::max(std::sin(elevation), 0.02);
  const double thermal = cn0 > 0.0 ? kThermal * kThermal * std::pow(10.0, 0.1 * (kStrong - cn0)) : 0.0;
  return kFloor * kFloor * (1.0 + 1.0 / (sine * sine)) + thermal;
}

using ClockGroup = std::tuple<Observable, record::SatelliteSystem, char>;

/// One observation before it is added to the matrices.
struct Candidate {
  ClockGroup group;
  Row row;
  double residual = 0.0;  ///< m, m/s
  SignalPath path;
};

using Kind = Unknown::Kind;

double rate_variance(double elevation) {
  constexpr double kZenith = 0.02;  // m/s
  const double sd = kZenith / std::max(std::sin(elevation), 0.1);
  return sd * sd;
}

/// Direction of the satellite for an antenna of this attitude: azimuth from the antenna's forward axis.
Direction seen_by(const Eigen::Matrix3d& C_b_e, const Eigen::Vector3d& to_satellite_e) {
  const Eigen::Vector3d way_b = C_b_e.transpose() * to_satellite_e;
  return {std::atan2(way_b.y(), way_b.x()), std::asin(std::clamp(-way_b.z(), -1.0, 1.0))};
}

/// Index of the velocity in a state; -1: none.
Eigen::Index velocity_in(const RelativeState& state) {
  return state.index(kVelocityUnknowns.front());
}

/// Prediction from a state, and weights of the observations.
class Expectation {
 public:
  Expectation(const DifferenceEpoch& epoch, const RelativeState& state, const DifferenceOptions& options,
              const Weighting& weighting)
      : epoch_(epoch),
        state_(state),
        options_(options),
        weighting_(weighting),
        r_e_(state.x.head<3>()),
        rover_(geo::geodetic_from_ecef(r_e_)) {
    if (const Eigen::Index i = velocity_in(state); i >= 0) v_e_ = state.x.segment<3>(i);
  }

  /// All observations of one satellite; none below the mask.
  void add(std::size_t s, std::vector<Candidate>& all) const {
    const SatelliteDifference& satellite = epoch_.satellites[s];
    const SignalPath path = path_to(satellite.state, r_e_, rover_, epoch_.t, options_.air.troposphere);
    if (path.direction.elevation < options_.elevation_mask) return;
    const Direction at_antenna = state_.C_b_e ? seen_by(*state_.C_b_e, path.to_satellite_e) : path.direction;
    const double wound = state_.C_b_e ? wind_up_by_tilt(path.to_satellite_e, -geo::C_n_e(rover_).col(2), *state_.C_b_e) : 0.0;
    for (std::size_t b = 0; b < satellite.bands.size(); ++b) {
      const BandDifference& band = satellite.bands[b];
      const double sd = nominal_phase_sd(path.direction.elevation, satellite.base_elevation, band);
      const auto candidate = [&](Observable observable, double scaled_sd, double residual) {
        all.push_back({clock_of(observable, satellite.satellite.system, band.band),
                       {s, b, observable, scaled_sd, path.direction},
                       residual,
                       path});
      };
      double expected = path.modelled(satellite.state);
      if (options_.rover_antenna)
        expected += phase_centre_correction(*options_.rover_antenna, satellite.satellite.system, band.band, at_antenna);
      const bool started = state_.index({Kind::kAmbiguity, satellite.satellite, band.band, band.arc}) >= 0;  // from a code
      if (band.code) candidate(Observable::kCode, kCodeToPhase * weighting_.noise.code * sd, *band.code - expected);
      if (band.phase && started)
        candidate(Observable::kPhase, weighting_.noise.phase * sd, *band.phase - expected - wound * band.wavelength());
      if (band.rate && v_e_)
        candidate(Observable::kRate,
                  weighting_.noise.rate *
                      std::sqrt(rate_variance(path.direction.elevation) + rate_variance(satellite.base_elevation)),
                  *band.rate - modelled_rate(satellite.state, r_e_, *v_e_));
    }
  }

 private:
  /// Rows with equal values share a clock.
  [[nodiscard]] ClockGroup clock_of(Observable observable, record::SatelliteSystem system, char band) const {
    const bool one = observable == Observable::kRate || (observable == Observable::kPhase && weighting_.one_phase_clock);
    return one ? ClockGroup{observable, record::SatelliteSystem::kGps, '0'} : ClockGroup{observable, system, band};
  }

  const DifferenceEpoch& epoch_;
  const RelativeState& state_;
  const DifferenceOptions& options_;
  const Weighting& weighting_;
  Eigen::Vector3d r_e_;
  geo::Geodetic rover_;
  std::optional<Eigen::Vector3d> v_e_;
};

std::vector<Candidate> candidates(const DifferenceEpoch& epoch, const RelativeState& state, const LeftOut& left_out,
                                  const DifferenceOptions& options, const Weighting& weighting) {
  std::vector<Candidate> all;
  const Expectation expectation(epoch, state, options, weighting);
  for (std::size_t s = 0; s < epoch.satellites.size(); ++s) expectation.add(s, all);
  std::erase_if(all, [&](const Candidate& c) { return left_out.contains({c.row.satellite, c.row.band, c.row.observable}); });
  std::ranges::stable_sort(all, {}, &Candidate::group);
  return all;
}

void fill(const Candidate& c, const DifferenceEpoch& epoch, const RelativeState& state, Eigen::Index i, DoubleDifferences& dd) {
  const SatelliteDifference& satellite = epoch.satellites[c.row.satellite];
  const BandDifference& band = satellite.bands[c.row.band];
  const double weight = 1.0 / c.row.sd;
  if (c.row.observable == Observable::kRate) {  // the dependence on position, 0.2 mm/s per metre, is neglected
    dd.H.block<1, 3>(i, velocity_in(state)) = -weight * c.path.to_satellite_e.transpose();
    dd.residual(i) = weight * c.residual;
    return;
  }
  const bool phase = c.row.observable == Observable::kPhase;
  double residual = c.residual;
  const auto add = [&](const Unknown& unknown, double factor) {
    const Eigen::Index column = state.index(unknown);
    if (column < 0) return;
    dd.H(i, column) = weight * factor;
    residual -= factor * state.x(column);
  };
  dd.H.block<1, 3>(i, 0) = -weight * c.path.to_satellite_e.transpose();
  add({Kind::kZenithDelay, {}, '0', 0}, c.path.wet_mapping);
  const double squared = kL1Frequency / band.frequency * kL1Frequency / band.frequency;
  add({Kind::kIonosphere, satellite.satellite, '0', 0}, phase ? -squared : squared);
  if (phase && satellite.satellite.system == record::SatelliteSystem::kGlonass)
    add({Kind::kInterFrequencyBias, {}, band.band, 0}, glonass_channel(band.band, band.frequency));
  if (phase) add({Kind::kAmbiguity, satellite.satellite, band.band, band.arc}, band.wavelength());
  dd.residual(i) = weight * residual;
}

/// Columns of a group's nuisance parameters: the clock; for phases that share one, and for their rates, also the
/// antenna's rotation about the vertical, a cycle of each (wind_up).
Eigen::MatrixXd nuisances(std::span<const Row> rows, const DifferenceEpoch& epoch, const Weighting& weighting) {
  const bool turns = weighting.one_phase_clock && rows.front().observable != Observable::kCode;
  Eigen::MatrixXd columns(rows.size(), turns ? 2 : 1);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double wavelength = epoch.satellites[rows[i].satellite].bands[rows[i].band].wavelength();
    const auto row = static_cast<Eigen::Index>(i);
    columns(row, 0) = 1.0 / rows[i].sd;
    if (turns) columns(row, 1) = wavelength / rows[i].sd;
  }
  return columns;
}

/// Orthonormal rows orthogonal to the columns, by Householder's reflections.
Eigen::MatrixXd complement(const Eigen::MatrixXd& columns) {
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns);
  const Eigen::MatrixXd Q = qr.householderQ();
  return Q.rightCols(columns.rows() - qr.rank()).transpose();
}

/// The rows' differences, and B.
void eliminate_clocks(DoubleDifferences& dd, const DifferenceEpoch& epoch, const Weighting& weighting) {
  const std::span<const Row> rows(dd.rows);
  std::vector<Eigen::MatrixXd> complements;
  Eigen::Index differences = 0;
  for (DoubleDifferences::Block& b : dd.blocks) {
    const std::span<const Row> group = rows.subspan(static_cast<std::size_t>(b.first_row), static_cast<std::size_t>(b.rows));
    complements.push_back(complement(nuisances(group, epoch, weighting)));
    b.first_difference = differences;
    b.differences = complements.back().rows();
    differences += b.differences;
  }
  dd.B.setZero(differences, static_cast<Eigen::Index>(rows.size()));
  for (std::size_t k = 0; k < complements.size(); ++k) {
    const DoubleDifferences::Block& b = dd.blocks[k];
    dd.B.block(b.first_difference, b.first_row, b.differences, b.rows) = complements[k];
  }
}

}  // namespace

double nominal_phase_sd(double rover_elevation, double base_elevation, const BandDifference& band) {
  return std::sqrt(phase_variance(rover_elevation, band.rover_cn0) + phase_variance(base_elevation, band.base_cn0));
}

DoubleDifferences double_differences(const DifferenceEpoch& epoch, const RelativeState& state, const LeftOut& left_out,
                                     const DifferenceOptions& options, const Weighting& weighting) {
  const std::vector<Candidate> all = candidates(epoch, state, left_out, options, weighting);
  DoubleDifferences dd;
  const auto n = static_cast<Eigen::Index>(all.size());
  dd.H.setZero(n, state.size());
  dd.residual.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    dd.rows.push_back(all[static_cast<std::size_t>(i)].row);
    fill(all[static_cast<std::size_t>(i)], epoch, state, i, dd);
  }
  for (Eigen::Index begin = 0, end = 0; begin < n; begin = end) {
    while (end < n && all[static_cast<std::size_t>(end)].group == all[static_cast<std::size_t>(begin)].group) ++end;
    dd.blocks.push_back({begin, end - begin, 0, 0});
  }
  eliminate_clocks(dd, epoch, weighting);
  return dd;
}

void inflate_codes(DoubleDifferences& dd, const DifferenceEpoch& epoch, const Weighting& weighting) {
  const double inflation = weighting.noise.code_inflation;
  bool changed = false;
  for (std::size_t i = 0; i < dd.rows.size(); ++i) {
    Row& row = dd.rows[i];
    const SatelliteDifference& satellite = epoch.satellites[row.satellite];
    const BandDifference& band = satellite.bands[row.band];
    if (row.observable != Observable::kCode ||
        !weighting.known.contains({Kind::kAmbiguity, satellite.satellite, band.band, band.arc}))
      continue;
    row.sd *= inflation;
    dd.H.row(static_cast<Eigen::Index>(i)) /= inflation;
    dd.residual(static_cast<Eigen::Index>(i)) /= inflation;
    changed = true;
  }
  if (changed) eliminate_clocks(dd, epoch, weighting);
}

Eigen::MatrixXd DoubleDifferences::without_clocks(const Eigen::MatrixXd& M) const {
  Eigen::MatrixXd product(B.rows(), M.cols());
  for (const Block& b : blocks)
    product.middleRows(b.first_difference, b.differences).noalias() =
        B.block(b.first_difference, b.first_row, b.differences, b.rows) * M.middleRows(b.first_row, b.rows);
  return product;
}

}  // namespace coast::carrier
