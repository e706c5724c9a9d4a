#include "coast/carrier/base_position.hpp"

#include <fmt/format.h>

#include <map>
#include <memory>

#include "coast/record/error.hpp"

namespace coast::carrier {

namespace {

using record::ObservationRecording;
using Positions = std::map<geo::GpsTime, Eigen::Vector3d>;

Eigen::Vector3d antenna(const ObservationRecording& receiver, const Eigen::Vector3d& r_marker_e) {
  const Eigen::Vector3d& enu = receiver.antenna_offset_enu;
  return r_marker_e + geo::C_n_e(geo::geodetic_from_ecef(r_marker_e)) * Eigen::Vector3d(enu.y(), enu.x(), -enu.z());
}

/// Where a receiver is by itself, epoch by epoch.
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

/// A day of a decimal year is known to half of one: a twentieth of a millimetre where plates move 4 cm a year.
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

}  // namespace

KnownBase known_base(const BaseAt& base_at, const ObservationRecording& base, const Orbits& orbits,
                     const DifferenceOptions& options) {
  if (base_at.how == BaseAt::How::kGiven && base_at.datum) return in_orbits_frame(base_at.r_e, *base_at.datum, base);
  if (base_at.how == BaseAt::How::kGiven) return at_rest(antenna(base, base_at.r_e), "given in the configuration");
  if (base_at.how == BaseAt::How::kHeader) {
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
