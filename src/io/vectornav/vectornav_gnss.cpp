// Positions of a VectorNav's GNSS receiver (VectorNav ICD for VN-310: GNSS groups); of the second one where the file has no
// first.

#include <cmath>

#include "../receiver_positions.hpp"
#include "coast/geo/units.hpp"
#include "vectornav_readers.hpp"
#include "vectornav_stream.hpp"
#include "vectornav_values.hpp"

namespace coast::io {

namespace {

/// GnssFix: 0 none, 1 time, 2 2-D, 3 3-D, 4 SBAS, 7 RTK float, 8 RTK fixed.
std::optional<record::FixQuality> vectornav_quality(std::uint8_t fix) {
  switch (fix) {
    case 3:
      return record::FixQuality::kSingle;
    case 4:
      return record::FixQuality::kSbas;
    case 7:
      return record::FixQuality::kFloat;
    case 8:
      return record::FixQuality::kFixed;
    default:
      return std::nullopt;
  }
}

/// Of PosU: standard deviations north, east, down.
std::optional<Eigen::Matrix3d> vectornav_covariance(const VectorNavMessage& message, VectorNavGroup group) {
  constexpr double kLargest = 1e6;  // m
  const auto field = message.field(group, 9);
  if (!field) return std::nullopt;
  const Eigen::Vector3d sd = vector_at<float>(*field);
  if (!sd.allFinite() || !(sd.minCoeff() > 0.0 && sd.maxCoeff() < kLargest)) return std::nullopt;
  return Eigen::Matrix3d(sd.cwiseAbs2().asDiagonal());
}

class VectorNavGnssReader {
 public:
  explicit VectorNavGnssReader(const GnssFileOptions& options) : stream_(options.file), positions_(options, stream_.name()) {}

  record::GnssRecording read() {
    VectorNavMessage message;
    while (stream_.next(message)) take(message);
    return positions_.finish(vectornav_file_events(stream_.census(), stream_.name()),
                             {.positions = {stream_.name(), 0, "VectorNav messages without a position of GNSS",
                                            "PosLla or PosEcef of a GNSS group", ""},
                              .for_time = "Add Tow and Week of the GNSS group to the output.",
                              .for_accuracy = "Add PosU to the output, or give `sd_m: [n, e, d]` beside the file."});
  }

 private:
  void take(const VectorNavMessage& message);

  VectorNavStream stream_;
  ReceiverPositions positions_;
  std::optional<VectorNavGroup> group_;  ///< the receiver
  std::optional<geo::GpsTime> last_;     ///< of the last message: the sensor repeats a position until the next one
};

void VectorNavGnssReader::take(const VectorNavMessage& message) {
  using enum VectorNavGroup;
  for (const VectorNavGroup group : {kGnss1, kGnss2})
    if (!group_ && (message.field(group, 5) || message.field(group, 6))) group_ = group;
  if (!group_ || (!message.field(*group_, 5) && !message.field(*group_, 6))) return;
  const auto tow = message.field(*group_, 1), week = message.field(*group_, 2);
  const auto t =
      tow && week ? week_and_nanoseconds(number_at<std::uint16_t>(*week, 0), number_at<std::uint64_t>(*tow, 0)) : std::nullopt;
  if (t && t == last_) return;
  last_ = t;
  const auto byte = [&](int bit) {
    const auto field = message.field(*group_, bit);
    return field ? std::optional(number_at<std::uint8_t>(*field, 0)) : std::nullopt;
  };
  const auto quality = byte(4) ? vectornav_quality(*byte(4)) : record::FixQuality::kUnknown;
  ReceiverPosition position;
  position.t = t;
  position.solved = quality.has_value();
  position.r_ea_e = vectornav_position(message, *group_);
  position.position_cov_n = vectornav_covariance(message, *group_);
  if (const auto velocity = message.field(*group_, 7)) position.v_ea_n = vector_at<float>(*velocity);
  // VelU is of the three components together.
  if (const auto sd = message.field(*group_, 10)) position.velocity_cov_n = velocity_covariance(number_at<float>(*sd, 0));
  position.quality = quality.value_or(record::FixQuality::kUnknown);
  position.satellites = byte(3).value_or(0);
  positions_.take(position);
}

}  // namespace

record::GnssRecording read_vectornav_gnss(const GnssFileOptions& options, Format::Near) {
  return VectorNavGnssReader(options).read();
}

}  // namespace coast::io
