// Positions of UBX-NAV-PVT, with the digits of NAV-HPPOSLLH and the covariances of NAV-COV of the same epoch where the file has
// them (u-blox F9 HPG interface description).

#include <fmt/format.h>

#include <cmath>

#include "../binary.hpp"
#include "../ephemerides.hpp"
#include "../receiver_positions.hpp"
#include "coast/geo/units.hpp"
#include "ubx_messages.hpp"
#include "ubx_readers.hpp"

namespace coast::io {

namespace {

/// What the messages of one navigation epoch say, as long as they have said it.
struct UbxEpoch {
  std::uint32_t tow_ms = 0;
  std::optional<geo::GpsTime> t;  ///< of NAV-PVT
  struct Solution {
    int kind = 0;  ///< fixType: 2 2-D, 3 3-D, 4 with the receiver's IMU
    bool accepted = false;
    record::FixQuality quality = record::FixQuality::kUnknown;
    int satellites = 0;
    Eigen::Vector3d velocity_n = Eigen::Vector3d::Zero();  ///< m/s
    double speed_sd = 0.0;                                 ///< m/s, three-dimensional
  };
  std::optional<Solution> solution;
  struct Place {
    std::optional<Eigen::Vector3d> r_ea_e;
    std::optional<Eigen::Matrix3d> cov_n;  ///< by the accuracies of the message
  };
  std::optional<Place> coarse, fine;  ///< NAV-PVT, NAV-HPPOSLLH
  std::optional<Eigen::Matrix3d> position_cov_n, velocity_cov_n;
};

record::FixQuality quality_of(std::uint8_t flags) {
  constexpr unsigned kFloat = 1, kFixed = 2;
  const unsigned carrier = flags >> 6;
  if (carrier == kFixed) return record::FixQuality::kFixed;
  if (carrier == kFloat) return record::FixQuality::kFloat;
  return (flags & 2U) != 0 ? record::FixQuality::kDgps : record::FixQuality::kSingle;
}

double millimetres(std::string_view payload, std::size_t at) {
  return 1e-3 * number_at<std::int32_t>(payload, at);
}

void take_pvt(std::string_view b, UbxEpoch& epoch) {
  const auto byte = [&](std::size_t at) { return number_at<std::uint8_t>(b, at); };
  UbxEpoch::Solution s;
  s.kind = byte(20);
  s.accepted = (byte(21) & 1U) != 0;
  s.quality = quality_of(byte(21));
  s.satellites = byte(23);
  s.velocity_n = {millimetres(b, 48), millimetres(b, 52), millimetres(b, 56)};
  s.speed_sd = 1e-3 * number_at<std::uint32_t>(b, 68);
  epoch.solution = s;
  epoch.t = pvt_time(b);
  if ((byte(78) & 1U) != 0) return;  // position not valid
  constexpr double kUnit = 1e-7 * geo::kDegree;
  epoch.coarse = {
      ecef_if_on_earth({kUnit * number_at<std::int32_t>(b, 28), kUnit * number_at<std::int32_t>(b, 24), millimetres(b, 32)}),
      position_covariance(1e-3 * number_at<std::uint32_t>(b, 40), 1e-3 * number_at<std::uint32_t>(b, 44))};
}

/// Coordinates in two numbers, the second 1e-9 deg and 0.1 mm.
void take_high_precision(std::string_view b, UbxEpoch& epoch) {
  if ((b[3] & 1) != 0) return;  // position not valid
  const auto angle = [&](std::size_t at, std::size_t fine_at) {
    return geo::kDegree * (1e-7 * number_at<std::int32_t>(b, at) + 1e-9 * number_at<std::int8_t>(b, fine_at));
  };
  const double height = millimetres(b, 16) + 1e-4 * number_at<std::int8_t>(b, 26);
  epoch.fine = {ecef_if_on_earth({angle(12, 25), angle(8, 24), height}),
                position_covariance(1e-4 * number_at<std::uint32_t>(b, 28), 1e-4 * number_at<std::uint32_t>(b, 32))};
}

/// Upper triangle NN, NE, ND, EE, ED, DD.
Eigen::Matrix3d triangle_at(std::string_view b, std::size_t at) {
  const auto c = [&](std::size_t i) { return static_cast<double>(number_at<float>(b, at + 4 * i)); };
  Eigen::Matrix3d cov;
  cov << c(0), c(1), c(2), c(1), c(3), c(4), c(2), c(4), c(5);
  return cov;
}

void take_covariances(std::string_view b, UbxEpoch& epoch) {
  if (b[5] != 0) epoch.position_cov_n = covariance_if_positive(triangle_at(b, 16));
  if (b[6] != 0) epoch.velocity_cov_n = covariance_if_positive(triangle_at(b, 40));
}

class UbxFixReader {
 public:
  UbxFixReader(const GnssFileOptions& options, Format::Near near)
      : stream_(options.file, kUbxLog), known_(near), positions_(options, stream_.name()) {
    if (options.time.gps_week) known_ = geo::GpsTime::from_week(*options.time.gps_week, kHalfWeek);
  }

  record::GnssRecording read();

 private:
  void take(const MessageFrame& frame);
  void begin_epoch(std::uint32_t tow_ms);
  void finish_epoch();
  [[nodiscard]] std::optional<geo::GpsTime> time_of_epoch() const;

  static constexpr double kHalfWeek = 302400.0;
  FrameStream stream_;
  std::optional<geo::GpsTime> known_;  ///< last time that a message states with its week
  UbxEpoch epoch_;
  ReceiverPositions positions_;
  Counted with_imu_;
};

void UbxFixReader::take(const MessageFrame& frame) {
  constexpr std::size_t kPvt = 84, kHighPrecision = 36, kCov = 64;
  if (frame.protocol != Protocol::kUbx) return;
  if (const auto t = stated_time(frame)) known_ = t;
  const std::string_view b = frame.payload;
  const auto is = [&](std::uint32_t id, std::size_t size) { return frame.id == id && b.size() >= size; };
  if (is(ubx::kNavPvt, kPvt)) {
    begin_epoch(number_at<std::uint32_t>(b, 0));
    take_pvt(b, epoch_);
  } else if (is(ubx::kNavHpPosLlh, kHighPrecision)) {
    begin_epoch(number_at<std::uint32_t>(b, 4));
    take_high_precision(b, epoch_);
  } else if (is(ubx::kNavCov, kCov)) {
    begin_epoch(number_at<std::uint32_t>(b, 0));
    take_covariances(b, epoch_);
  }
}

void UbxFixReader::begin_epoch(std::uint32_t tow_ms) {
  if (tow_ms == epoch_.tow_ms) return;
  finish_epoch();
  epoch_ = {};
  epoch_.tow_ms = tow_ms;
}

std::optional<geo::GpsTime> UbxFixReader::time_of_epoch() const {
  constexpr std::uint32_t kWeekMs = 604'800'000;
  if (epoch_.t) return epoch_.t;
  // NAV-PVT without a date, or only NAV-HPPOSLLH: seconds of a week that other messages tell.
  if (!known_ || epoch_.tow_ms >= kWeekMs) return std::nullopt;
  return nearest_second_of_week(*known_, 1e-3 * epoch_.tow_ms);
}

void UbxFixReader::finish_epoch() {
  constexpr int kThreeD = 3, kWithImu = 4;
  const std::optional<UbxEpoch::Place>& place = epoch_.fine ? epoch_.fine : epoch_.coarse;
  const auto& s = epoch_.solution;
  if (!place && !s) return;
  ReceiverPosition position;
  position.solved = place && (!s || (s->accepted && (s->kind == kThreeD || s->kind == kWithImu)));
  position.t = time_of_epoch();
  if (place) {
    position.r_ea_e = place->r_ea_e;
    position.position_cov_n = epoch_.position_cov_n ? epoch_.position_cov_n : place->cov_n;
  }
  if (s) {
    position.quality = s->quality;
    position.satellites = s->satellites;
    position.v_ea_n = s->velocity_n;
    position.velocity_cov_n = epoch_.velocity_cov_n ? epoch_.velocity_cov_n : velocity_covariance(s->speed_sd);
  }
  if (positions_.take(position) && s && s->kind == kWithImu) with_imu_.add();
}

record::GnssRecording UbxFixReader::read() {
  MessageFrame frame;
  while (stream_.next(frame)) take(frame);
  finish_epoch();
  record::GnssRecording recording = positions_.finish(
      ubx_file_events(stream_.census(), stream_.name()),
      {.positions = {stream_.name(), 0, "a UBX file without UBX-NAV-PVT and UBX-NAV-HPPOSLLH", "positions",
                     "If it holds UBX-RXM-RAWX, `gnss: {ppk: {rover: .., base: .., nav: [..]}}` computes them."},
       .for_time = "State `gps_week:` beside the file.",
       .for_accuracy = "Give `sd_m: [n, e, d]` beside the file."});
  add_counted(
      recording.events, recording.source, with_imu_,
      {"fix_with_imu", "position is", "positions are",
       "of GNSS and the receiver's own IMU together: their errors are correlated over time, and in gaps of GNSS they are "
       "no measurements"});
  return recording;
}

}  // namespace

record::GnssRecording read_ubx_gnss(const GnssFileOptions& options, Format::Near near) {
  return UbxFixReader(options, near).read();
}

}  // namespace coast::io
