// Positions of SBF: PVTGeodetic or PVTCartesian with the covariances of the same epoch (mosaic-X5 reference guide 4.14.10,
// 4.2.10).

#include <fmt/format.h>

#include "../ephemerides.hpp"
#include "../receiver_positions.hpp"
#include "sbf_blocks.hpp"
#include "sbf_pvt.hpp"
#include "sbf_readers.hpp"

namespace coast::io {

namespace {

/// What the blocks of one epoch say, as long as they have said it.
struct SbfEpoch {
  std::optional<std::uint32_t> ms;  ///< of the week
  std::optional<geo::GpsTime> t;
  std::optional<SbfSolution> geodetic, cartesian;
  std::optional<Eigen::Matrix3d> position_cov_n, velocity_cov_n;  ///< PosCovGeodetic, VelCovGeodetic
  std::optional<Eigen::Matrix3d> position_cov_e, velocity_cov_e;  ///< PosCovCartesian, VelCovCartesian
};

/// Variances of the three components and of the clock, then covariances 12, 13, 1 with the clock, 23, 2 and 3 with the clock.
std::optional<Eigen::Matrix3d> sbf_covariance(std::string_view payload) {
  constexpr std::size_t kSize = 48;
  constexpr int kNone = 0;
  if (payload.size() < kSize) return std::nullopt;
  SbfFields f(payload, kSbfBody);
  const int mode = f.u1(), error = f.u1();
  if ((mode & 15) == kNone || error != 0) return std::nullopt;
  Eigen::Matrix3d cov;
  for (int i = 0; i < 3; ++i) cov(i, i) = f.f4();
  f.skip(4);
  cov(0, 1) = cov(1, 0) = f.f4();
  cov(0, 2) = cov(2, 0) = f.f4();
  f.skip(4);
  cov(1, 2) = cov(2, 1) = f.f4();
  return covariance_if_positive(cov);
}

/// North, east, up to north, east, down.
std::optional<Eigen::Matrix3d> downwards(std::optional<Eigen::Matrix3d> cov) {
  if (!cov) return std::nullopt;
  const Eigen::Matrix3d flip = Eigen::Vector3d(1.0, 1.0, -1.0).asDiagonal();
  return Eigen::Matrix3d(flip * *cov * flip);
}

/// ECEF to north, east, down at a position.
std::optional<Eigen::Matrix3d> local_covariance(const std::optional<Eigen::Matrix3d>& cov_e, const Eigen::Vector3d& r_e) {
  if (!cov_e) return std::nullopt;
  const Eigen::Matrix3d C_n_e = geo::C_n_e(geo::geodetic_from_ecef(r_e));
  const Eigen::Matrix3d cov_n = C_n_e.transpose() * *cov_e * C_n_e;
  return covariance_if_positive(0.5 * (cov_n + cov_n.transpose()));
}

class SbfFixReader {
 public:
  SbfFixReader(const GnssFileOptions& options, Format::Near near)
      : stream_(options.file, kSbfLog), known_(near), positions_(options, stream_.name()) {
    if (options.time.gps_week) known_ = geo::GpsTime::from_week(*options.time.gps_week, kHalfWeek);
  }

  record::GnssRecording read();

 private:
  void take(const MessageFrame& frame);
  void begin_epoch(std::string_view payload);
  void finish_epoch();
  [[nodiscard]] std::optional<geo::GpsTime> time_of_epoch(const SbfSolution& solution) const;

  static constexpr double kHalfWeek = 302400.0;
  FrameStream stream_;
  std::optional<geo::GpsTime> known_;  ///< last time that a block states with its week
  SbfEpoch epoch_;
  ReceiverPositions positions_;
  Counted not_measured_, other_datum_;
};

void SbfFixReader::take(const MessageFrame& frame) {
  if (frame.protocol != Protocol::kSbf) return;
  switch (frame.id) {
    case sbf::kPvtGeodetic:
      begin_epoch(frame.payload);
      epoch_.geodetic = sbf_solution(frame);
      break;
    case sbf::kPvtCartesian:
      begin_epoch(frame.payload);
      epoch_.cartesian = sbf_solution(frame);
      break;
    case sbf::kPosCovGeodetic:
      begin_epoch(frame.payload);
      epoch_.position_cov_n = downwards(sbf_covariance(frame.payload));
      break;
    case sbf::kVelCovGeodetic:
      begin_epoch(frame.payload);
      epoch_.velocity_cov_n = downwards(sbf_covariance(frame.payload));
      break;
    case sbf::kPosCovCartesian:
      begin_epoch(frame.payload);
      epoch_.position_cov_e = sbf_covariance(frame.payload);
      break;
    case sbf::kVelCovCartesian:
      begin_epoch(frame.payload);
      epoch_.velocity_cov_e = sbf_covariance(frame.payload);
      break;
    default:
      break;
  }
}

/// An epoch ends where a block of another one comes.
void SbfFixReader::begin_epoch(std::string_view payload) {
  const auto ms = sbf_milliseconds(payload);
  const auto t = sbf_time(payload);
  if (ms && ms == epoch_.ms && t == epoch_.t) return;
  finish_epoch();
  epoch_ = {};
  epoch_.ms = ms;
  epoch_.t = t;
  if (t) known_ = t;
}

/// GPS time: that of the receiver's clock minus its bias.
std::optional<geo::GpsTime> SbfFixReader::time_of_epoch(const SbfSolution& solution) const {
  if (epoch_.t) return *epoch_.t - solution.clock_bias_s;
  if (!known_ || !epoch_.ms) return std::nullopt;
  return nearest_second_of_week(*known_, 1e-3 * *epoch_.ms) - solution.clock_bias_s;
}

void SbfFixReader::finish_epoch() {
  const bool geodetic = epoch_.geodetic && (epoch_.geodetic->three_dimensional() || !epoch_.cartesian);
  const std::optional<SbfSolution>& s = geodetic ? epoch_.geodetic : epoch_.cartesian;
  if (!s) return;
  ReceiverPosition position;
  position.t = time_of_epoch(*s);
  position.solved = s->three_dimensional() && s->measured();
  if (s->three_dimensional() && !s->measured()) not_measured_.add(position.t);
  if (position.solved) {
    position.r_ea_e = s->r_ea_e;
    position.v_ea_n = s->v_ea_n;
    position.position_cov_n =
        epoch_.position_cov_n ? epoch_.position_cov_n : local_covariance(epoch_.position_cov_e, *s->r_ea_e);
    if (!position.position_cov_n) position.position_cov_n = s->position_cov_n;
    position.velocity_cov_n =
        epoch_.velocity_cov_n ? epoch_.velocity_cov_n : local_covariance(epoch_.velocity_cov_e, *s->r_ea_e);
  }
  position.quality = s->quality();
  position.satellites = s->satellites;
  constexpr int kWgs84 = 0, kOfBase = 19;
  if (positions_.take(position) && s->datum != kWgs84 && s->datum != kOfBase) other_datum_.add(position.t);
}

record::GnssRecording SbfFixReader::read() {
  MessageFrame frame;
  while (stream_.next(frame)) take(frame);
  finish_epoch();
  record::GnssRecording recording =
      positions_.finish(sbf_file_events(stream_.census(), stream_.name()),
                        {.positions = {stream_.name(), 0, "an SBF file without PVTGeodetic and PVTCartesian", "positions",
                                       "If it holds MeasEpoch, `gnss: {ppk: {rover: .., base: .., nav: [..]}}` computes them."},
                         .for_time = "State `gps_week:` beside the file.",
                         .for_accuracy = "Give `sd_m: [n, e, d]` beside the file."});
  const auto add = [&](const Counted& counted, const char* kind, const char* what) {
    add_counted(recording.events, recording.source, counted, {kind, "position", "positions", what});
  };
  add(not_measured_, "fix_not_measured", "of a fixed location or relative to a moving base left out");
  add(other_datum_, "fix_datum", "in a datum other than WGS 84 and that of the base, taken as WGS 84");
  return recording;
}

}  // namespace

record::GnssRecording read_sbf_gnss(const GnssFileOptions& options, Format::Near near) {
  return SbfFixReader(options, near).read();
}

}  // namespace coast::io
