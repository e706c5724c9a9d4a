#include "double_differences.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "coast/carrier/signals.hpp"

namespace coast::carrier {

namespace {

constexpr double kCodeToPhase = 100.0;  // sd of a code over that of its phase

/// Thermal noise, multipath and what the models of the air leave, m^2.
double phase_variance(double elevation, double cn0) {
  constexpr double kFloor = 0.002;    // m, at the zenith as much again
  constexpr double kThermal = 0.001;  // m at 45 dB-Hz
  constexpr double kStrong = 45.0;    // dB-Hz
  const double sine = std::max(std::sin(elevation), 0.02);
  const double thermal = cn0 > 0.0 ? kThermal * kThermal * std::pow(10.0, 0.1 * (kStrong - cn0)) : 0.0;
  return kFloor * kFloor * (1.0 + 1.0 / (sine * sine)) + thermal;
}

/// One observation on its way into the matrices.
struct Candidate {
  std::tuple<bool, record::SatelliteSystem, char> group;
  Row row;
  double residual = 0.0;  ///< m
  SignalPath path;
};

using Kind = Unknown::Kind;

/// Sd of a code over the nominal sd of its phase.
double code_scale(const SatelliteDifference& satellite, const BandDifference& band, const Weighting& weighting) {
  const Unknown ambiguity{Kind::kAmbiguity, satellite.satellite, band.band, band.arc};
  const double inflation = weighting.known.contains(ambiguity) ? weighting.noise.code_inflation : 1.0;
  return kCodeToPhase * weighting.noise.code * inflation;
}

std::vector<Candidate> candidates(const DifferenceEpoch& epoch, const RelativeState& state, const LeftOut& left_out,
                                  const DifferenceOptions& options, const Weighting& weighting) {
  std::vector<Candidate> all;
  const Eigen::Vector3d r_e = state.x.head<3>();
  const geo::Geodetic rover = geo::geodetic_from_ecef(r_e);
  for (std::size_t s = 0; s < epoch.satellites.size(); ++s) {
    const SatelliteDifference& satellite = epoch.satellites[s];
    const SignalPath path = path_to(satellite.state, r_e, rover, epoch.t, options.air.troposphere);
    if (path.direction.elevation < options.elevation_mask) continue;
    const double modelled = path.modelled(satellite.state);
    for (std::size_t b = 0; b < satellite.bands.size(); ++b) {
      const BandDifference& band = satellite.bands[b];
      double expected = modelled;
      if (options.rover_antenna)
        expected += phase_centre_correction(*options.rover_antenna, satellite.satellite.system, band.band, path.direction);
      for (const bool phase : {true, false}) {
        const std::optional<double>& observed = phase ? band.phase : band.code;
        if (!observed || left_out.contains({s, b, phase})) continue;
        const Unknown ambiguity{Kind::kAmbiguity, satellite.satellite, band.band, band.arc};
        if (phase && state.index(ambiguity) < 0) continue;  // no code has told where to begin
        const double sd = nominal_phase_sd(path.direction.elevation, satellite.base_elevation, band);
        const double scale = phase ? weighting.noise.phase : code_scale(satellite, band, weighting);
        all.push_back({{phase, satellite.satellite.system, band.band},
                       {s, b, phase, scale * sd, path.direction},
                       *observed - expected,
                       path});
      }
    }
  }
  std::ranges::stable_sort(all, {}, &Candidate::group);
  return all;
}

void fill(const Candidate& c, const DifferenceEpoch& epoch, const RelativeState& state, Eigen::Index i, DoubleDifferences& dd) {
  const SatelliteDifference& satellite = epoch.satellites[c.row.satellite];
  const BandDifference& band = satellite.bands[c.row.band];
  const double weight = 1.0 / c.row.sd;
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
  add({Kind::kIonosphere, satellite.satellite, '0', 0}, c.row.phase ? -squared : squared);
  if (c.row.phase) add({Kind::kAmbiguity, satellite.satellite, band.band, band.arc}, band.wavelength());
  dd.residual(i) = weight * residual;
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
  Eigen::Index groups = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Candidate& c = all[static_cast<std::size_t>(i)];
    if (i == 0 || c.group != all[static_cast<std::size_t>(i - 1)].group) ++groups;
    dd.rows.push_back(c.row);
    fill(c, epoch, state, i, dd);
  }
  dd.B.setZero(n - groups, n);
  Eigen::Index difference = 0;
  for (Eigen::Index begin = 0, end = 0; begin < n; begin = end) {
    while (end < n && all[static_cast<std::size_t>(end)].group == all[static_cast<std::size_t>(begin)].group) ++end;
    // Householder's reflection takes the clock's column u to the first axis; its other rows are orthogonal to u.
    Eigen::VectorXd u(end - begin);
    for (Eigen::Index i = begin; i < end; ++i) u(i - begin) = 1.0 / dd.rows[static_cast<std::size_t>(i)].sd;
    u(0) += u.norm();
    const double scale = 2.0 / u.squaredNorm();
    for (Eigen::Index k = 1; k < end - begin; ++k, ++difference) {
      dd.B.row(difference).segment(begin, end - begin) = -scale * u(k) * u.transpose();
      dd.B(difference, begin + k) += 1.0;
    }
  }
  return dd;
}

}  // namespace coast::carrier
