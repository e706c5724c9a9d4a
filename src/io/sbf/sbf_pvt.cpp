#include "sbf_pvt.hpp"

#include "../receiver_positions.hpp"
#include "sbf_blocks.hpp"

namespace coast::io {

namespace {

constexpr int kFixedLocation = 3, kMovingBaseFixed = 7, kMovingBaseFloat = 8;

Eigen::Vector3d vector_of(SbfFields& f) {
  const double x = f.f8(), y = f.f8(), z = f.f8();
  return {x, y, z};
}

/// Latitude, longitude, height; north, east, up.
void take_geodetic(SbfFields& f, SbfSolution& s) {
  const Eigen::Vector3d p = vector_of(f);
  f.skip(4);  // undulation
  const double north = f.f4(), east = f.f4(), up = f.f4();
  s.r_ea_e = ecef_if_on_earth({p.x(), p.y(), p.z()});
  if (sbf_known(north) && sbf_known(east) && sbf_known(up)) s.v_ea_n = Eigen::Vector3d(north, east, -up);
}

void take_cartesian(SbfFields& f, SbfSolution& s) {
  constexpr double kLeast = 6e6, kMost = 8e6;  // m
  const Eigen::Vector3d r = vector_of(f);
  f.skip(4);  // undulation
  const double x = f.f4(), y = f.f4(), z = f.f4();
  if (!(r.norm() > kLeast && r.norm() < kMost)) return;
  const geo::Geodetic p = geo::geodetic_from_ecef(r);
  if (!ecef_if_on_earth(p)) return;
  s.r_ea_e = r;
  if (sbf_known(x) && sbf_known(y) && sbf_known(z)) s.v_ea_n = geo::C_n_e(p).transpose() * Eigen::Vector3d(x, y, z);
}

/// HAccuracy is twice the distance from the true position in the mean square, VAccuracy twice the standard deviation.
std::optional<Eigen::Matrix3d> covariance_by_accuracies(int horizontal_cm, int vertical_cm) {
  constexpr int kClipped = 65534;  // and one more: not known
  if (horizontal_cm >= kClipped || vertical_cm >= kClipped) return std::nullopt;
  return position_covariance(0.005 * horizontal_cm, 0.005 * vertical_cm);
}

}  // namespace

bool SbfSolution::measured() const {
  return type != kFixedLocation && type != kMovingBaseFixed && type != kMovingBaseFloat;
}

record::FixQuality SbfSolution::quality() const {
  switch (type) {
    case 1:
      return record::FixQuality::kSingle;
    case 2:
      return record::FixQuality::kDgps;
    case 4:
      return record::FixQuality::kFixed;
    case 5:
      return record::FixQuality::kFloat;
    case 6:
      return record::FixQuality::kSbas;
    case 10:
      return record::FixQuality::kPpp;
    default:
      return record::FixQuality::kUnknown;
  }
}

std::optional<SbfSolution> sbf_solution(const MessageFrame& frame) {
  constexpr std::size_t kRevision0 = 76, kWithAccuracies = 86;
  constexpr double kMostBias = 1000.0;  // ms; before the receiver has set its clock
  const bool geodetic = frame.id == sbf::kPvtGeodetic;
  if (frame.protocol != Protocol::kSbf || (!geodetic && frame.id != sbf::kPvtCartesian)) return std::nullopt;
  if (frame.payload.size() < kRevision0) return std::nullopt;
  SbfFields f(frame.payload, kSbfBody);
  SbfSolution s;
  const int mode = f.u1();
  s.type = mode & 15;
  s.height_held = (mode & 0x80) != 0;
  s.error = f.u1();
  if (geodetic)
    take_geodetic(f, s);
  else
    take_cartesian(f, s);
  f.skip(4);  // course
  const double bias_ms = f.f8();
  if (bias_ms > -kMostBias && bias_ms < kMostBias) s.clock_bias_s = 1e-3 * bias_ms;
  f.skip(4 + 1);  // drift, time system
  constexpr int kNoNumber = 255;
  s.datum = f.u1();
  const int satellites = f.u1();
  s.satellites = satellites == kNoNumber ? 0 : satellites;
  if (frame.payload.size() < kWithAccuracies) return s;
  f.skip(1 + 2 + 2 + 4 + 1 + 1 + 2 + 2);  // corrections, reference, age, signals, alert, bases, PPP, latency
  const int horizontal = f.u2(), vertical = f.u2();
  s.position_cov_n = covariance_by_accuracies(horizontal, vertical);
  return s;
}

}  // namespace coast::io
