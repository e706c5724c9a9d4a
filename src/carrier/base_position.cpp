#include "coast/carrier/base_position.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>

#include "coast/geo/units.hpp"
#include "coast/record/error.hpp"
#include "quantile.hpp"

namespace coast::carrier {

namespace {

using record::ObservationRecording;
using Positions = std::map<geo::GpsTime, Eigen::Vector3d>;

Eigen::Vector3d antenna(const ObservationRecording& receiver, const Eigen::Vector3d& r_marker_e) {
  const Eigen::Vector3d& enu = receiver.antenna_offset_enu;
  return r_marker_e + geo::C_n_e(geo::geodetic_from_ecef(r_marker_e)) * Eigen::Vector3d(enu.y(), enu.x(), -enu.z());
}

/// Single-point positions of a receiver, by epoch.
Positions own_positions(const ObservationRecording& receiver, const Orbits& orbits, const DifferenceOptions& options) {
  Positions positions;
  const auto points = single_points(receiver, orbits, options);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i]) positions[receiver.epochs[i].t] = points[i]->r_e;
  if (positions.empty())
    throw InputError({receiver.source, 0, "no epoch with a position of its own", "codes of four satellites or more",
                      "Give base_position: {ecef_m: [x, y, z]}."});
  return positions;
}

KnownBase at_rest(const Eigen::Vector3d& r_e, std::string from) {
  return {[r_e](geo::GpsTime) { return std::optional(r_e); }, r_e, std::move(from)};
}

/// A decimal year gives the date to half a day: a twentieth of a millimetre for plate motion of 4 cm a year.
double decimal_year(geo::GpsTime t) {
  constexpr double kYear = 365.25 * 86400.0;
  return 1980.0137 + (t - geo::GpsTime::from_week(0, 0.0)) / kYear;
}

KnownBase in_orbits_frame(const Eigen::Vector3d& r_e, const BaseAt::Datum& datum, const ObservationRecording& base) {
  const geo::FrameEpoch target{"ITRF2020", decimal_year(base.epochs.front().t)};
  const Eigen::Vector3d moved_e = geo::transform(r_e, datum.at, target, datum.velocity_mpy);
  return at_rest(antenna(base, moved_e),
                 fmt::format("given in {} at {:.2f}; {:.3f} m from there in {} at {:.2f}", datum.at.frame, datum.at.year,
                             (moved_e - r_e).norm(), target.frame, target.year));
}

/// Up to 30 epochs, spread over the file. The header's position is not their start value: it may be wrong.
ObservationRecording sample_of(const ObservationRecording& base) {
  constexpr std::size_t kEpochs = 30;
  ObservationRecording sample;
  sample.source = base.source;
  sample.glonass_channels = base.glonass_channels;
  const std::size_t n = std::min(kEpochs, base.epochs.size());
  for (std::size_t i = 0; i < n; ++i) sample.epochs.push_back(base.epochs[i * base.epochs.size() / n]);
  return sample;
}

constexpr std::size_t kLeastPoints = 5;

std::vector<SinglePoint> sampled_points(const ObservationRecording& base, const Orbits& orbits,
                                        const DifferenceOptions& options) {
  std::vector<SinglePoint> points;
  for (const auto& point : single_points(sample_of(base), orbits, options))
    if (point) points.push_back(*point);
  return points;
}

/// Position of the base from its codes, N, E, D.
struct OwnPosition {
  geo::LocalFrame frame;
  std::size_t epochs = 0;
  Eigen::Vector3d median_n, sd_n;  ///< m
  double spread = 0.0;             ///< horizontal, between the outer tenths of the positions, m
  double spread_sd = 0.0;          ///< the same as expected by the sigmas of the positions, m
};

std::optional<OwnPosition> own_position(const ObservationRecording& base, const Orbits& orbits,
                                        const DifferenceOptions& options) {
  constexpr double kMadToSd = 1.4826;
  DifferenceOptions free = options;
  free.air.ionosphere_free = true;
  std::vector<SinglePoint> points = sampled_points(base, orbits, free);
  const bool two_bands = points.size() >= kLeastPoints;
  if (!two_bands) points = sampled_points(base, orbits, options);
  if (points.size() < kLeastPoints) return std::nullopt;
  OwnPosition own{geo::LocalFrame(geo::geodetic_from_ecef(points[points.size() / 2].r_e)), points.size(), {}, {}};
  const double factor = two_bands ? 1.0 : options.air.ionosphere ? 3.0 : 10.0;
  const Eigen::Vector3d common = factor * Eigen::Vector3d(0.7, 0.7, 1.5);
  for (Eigen::Index i = 0; i < 3; ++i) {
    std::vector<double> along, off, variances;
    for (const SinglePoint& point : points) {
      along.push_back(own.frame.to_ned(point.r_e)(i));
      const Eigen::Vector3d axis_e = own.frame.rotation().col(i);
      variances.push_back(axis_e.dot(point.covariance_e * axis_e));
    }
    own.median_n(i) = quantile(along, 0.5);
    for (const double a : along) off.push_back(std::abs(a - own.median_n(i)));
    own.sd_n(i) = std::hypot(common(i), kMadToSd * quantile(off, 0.5));
    if (i == 2) continue;
    own.spread = std::hypot(own.spread, quantile(along, 0.9) - quantile(along, 0.1));
    own.spread_sd = std::hypot(own.spread_sd, std::sqrt(2.0 * quantile(variances, 0.5)));
  }
  return own;
}

std::string metres(double distance) {
  return distance < 10e3 ? fmt::format("{:.1f} m", distance) : fmt::format("{:.0f} km", 1e-3 * distance);
}

/// A receiver stated to be at rest that moves.
std::optional<record::Event> motion_of(const OwnPosition& own, const ObservationRecording& receiver, const char* code,
                                       const std::string& what, const std::string& what_to_do) {
  constexpr double kDoubtful = 30.0, kUnmistakable = 50.0;  // m
  constexpr double kSigmas = 5.0;
  if (own.spread < std::max(kDoubtful, kSigmas * own.spread_sd)) return std::nullopt;
  const std::string found =
      fmt::format("{} moves by {} (sigma {:.1f} m) by its own codes", what, metres(own.spread), own.spread_sd);
  if (own.spread > kUnmistakable) throw InputError({receiver.source, 0, found, "a receiver at rest", what_to_do});
  return record::Event{record::Event::Severity::kWarning, code, fmt::format("{}: {}. {}", receiver.source, found, what_to_do),
                       std::nullopt, 1};
}

/// Geodetic coordinates stated in other units than degrees, or in another order.
std::string order_in_words(const Eigen::Vector3d& stated_e, const Eigen::Vector3d& own_e) {
  constexpr double kFits = 20e3;  // m: radians with four digits
  constexpr double kRightAngle = 0.5 * std::numbers::pi;
  const auto fits = [&](double latitude, double longitude, double height) {
    return std::abs(latitude) <= kRightAngle && std::abs(longitude) <= 2.0 * kRightAngle &&
           (geo::ecef_from_geodetic({latitude, longitude, height}) - own_e).norm() < kFits;
  };
  const geo::Geodetic stated = geo::geodetic_from_ecef(stated_e);
  if (fits(stated.longitude, stated.latitude, stated.height)) return "With latitude and longitude exchanged it fits. ";
  if (fits(stated.latitude / geo::kDegree, stated.longitude / geo::kDegree, stated.height))
    return "With its angles taken as radians it fits: geodetic_deg_m is in degrees. ";
  return "";
}

/// "With the sign of y changed it fits", if other signs of some coordinates, or another order or unit fit.
std::string mistake_in_words(const Eigen::Vector3d& stated_e, const Eigen::Vector3d& own_e) {
  constexpr double kFits = 1e3;  // m
  constexpr std::array kNames{"", "x", "y", "x and y", "z", "x and z", "y and z", "x, y and z"};
  for (std::size_t flipped = 1; flipped < kNames.size(); ++flipped) {
    Eigen::Vector3d other_e = stated_e;
    for (Eigen::Index i = 0; i < 3; ++i)
      if ((flipped >> i & 1U) != 0) other_e(i) = -other_e(i);
    if ((other_e - own_e).norm() < kFits) return fmt::format("With the sign of {} changed it fits: a sign? ", kNames[flipped]);
  }
  return order_in_words(stated_e, own_e);
}

void check_antenna(const ObservationRecording& base) {
  constexpr double kHighest = 50.0;  // m
  const double off = base.antenna_offset_enu.norm();
  if (off > kHighest)
    throw InputError({base.source, 0, fmt::format("an antenna {:.0f} m from its marker (ANTENNA: DELTA H/E/N)", off), "metres",
                      "Millimetres? Correct the header."});
}

}  // namespace

record::Events examine_base(const BaseAt& base_at, const KnownBase& known, const ObservationRecording& base,
                            const Orbits& orbits, const DifferenceOptions& options) {
  constexpr double kElsewhere = 10e3, kDoubtful = 10.0, kDoubtfulHeader = 3.0;  // m
  if (base_at.how == BaseAt::How::kMoving) return {};
  check_antenna(base);
  const auto own = own_position(base, orbits, options);
  if (!own) return {};
  record::Events events;
  if (const auto moves = motion_of(*own, base, "base_moves", "the file given as base",
                                   "Are rover and base exchanged? Exchange `rover` and `base`, or say base_position: moving."))
    events.push_back(*moves);
  if (base_at.how == BaseAt::How::kAverage) return events;
  const bool unstated = base_at.how == BaseAt::How::kUnstated;
  const bool header = unstated || base_at.how == BaseAt::How::kHeader;
  const Eigen::Vector3d off_n = own->frame.to_ned(known.r_e) - own->median_n;
  const double off = off_n.norm();
  const double sd = off > 0.0 ? off_n.cwiseProduct(own->sd_n).norm() / off : own->sd_n.norm();
  const std::string found = fmt::format("{} is {} from where the base's own codes put it ({} epochs, sigma {:.1f} m)",
                                        header ? "the header's position of the base, which is approximate," : "base_position",
                                        metres(off), own->epochs, sd);
  const std::string what_to_do =
      fmt::format("Give base_position: {{ecef_m: [x, y, z]}} of the base's marker{}.",
                  unstated ? ", or base_position: header where the header's is good to centimetres" : "");
  if (off > kElsewhere)
    throw InputError(
        {base.source, 0, found, "metres", mistake_in_words(known.r_e, own->frame.to_ecef(own->median_n)) + what_to_do});
  const double bound = header ? std::max(kDoubtfulHeader, 2.0 * sd) : std::max(kDoubtful, 5.0 * sd);
  if (!unstated && off < bound) return events;
  events.push_back(
      {record::Event::Severity::kWarning, "base_position_doubtful",
       fmt::format("{}: {}: north {:.1f}, east {:.1f}, up {:.1f} m. An error of the base is one of every position of "
                   "the rover. {}",
                   base.source, found, off_n.x(), off_n.y(), -off_n.z(), what_to_do),
       std::nullopt, 1});
  return events;
}

record::Events examine_static_rover(const ObservationRecording& rover, const Orbits& orbits, const DifferenceOptions& options) {
  record::Events events;
  if (const auto own = own_position(rover, orbits, options))
    if (const auto moves = motion_of(*own, rover, "rover_moves", "the rover", "Say motion: kinematic, or leave it out."))
      events.push_back(*moves);
  return events;
}

bool same_observations(const ObservationRecording& a, const ObservationRecording& b) {
  const auto at = std::ranges::find(b.epochs, a.epochs.front().t, &record::ObservationEpoch::t);
  if (at == b.epochs.end() || a.epochs.front().observations.empty()) return false;
  return std::ranges::equal(
      a.epochs.front().observations, at->observations, [](const record::Observation& one, const record::Observation& other) {
        return one.satellite == other.satellite && one.code_m == other.code_m && one.phase_cycles == other.phase_cycles;
      });
}

KnownBase known_base(const BaseAt& base_at, const ObservationRecording& base, const Orbits& orbits,
                     const DifferenceOptions& options) {
  if (base_at.how == BaseAt::How::kGiven && base_at.datum) return in_orbits_frame(base_at.r_e, *base_at.datum, base);
  if (base_at.how == BaseAt::How::kGiven) return at_rest(antenna(base, base_at.r_e), "given in the configuration");
  if (base_at.how == BaseAt::How::kHeader || base_at.how == BaseAt::How::kUnstated) {
    if (!base.approximate_r_e)
      throw InputError({base.source, 0, "no APPROX POSITION XYZ in the header", "the base's position",
                        "Give base_position: {ecef_m: [x, y, z]}, or base_position: average."});
    return at_rest(antenna(base, *base.approximate_r_e), "of the file's header, which may be metres off");
  }
  const auto positions = std::make_shared<const Positions>(own_positions(base, orbits, options));
  if (base_at.how == BaseAt::How::kAverage) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const auto& [t, r_e] : *positions) sum += r_e;
    return at_rest(sum / static_cast<double>(positions->size()),
                   fmt::format("the mean of its {} single-point positions, metres off", positions->size()));
  }
  const auto at = [positions](geo::GpsTime t) {
    const auto found = positions->find(t);
    return found == positions->end() ? std::nullopt : std::optional(found->second);
  };
  return {at, positions->begin()->second, "moving: its own single-point positions, metres off, the baseline is not"};
}

}  // namespace coast::carrier
