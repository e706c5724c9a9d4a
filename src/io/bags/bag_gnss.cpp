// Positions of a bag: one topic of sensor_msgs/NavSatFix. Heights are above the ellipsoid by its definition.

#include <Eigen/Cholesky>

#include "../receiver_positions.hpp"
#include "bag_readers.hpp"
#include "bag_topics.hpp"
#include "coast/geo/units.hpp"
#include "coast/record/error.hpp"
#include "ros_message.hpp"

namespace coast::io {

namespace {

struct BagFixRow {
  std::int64_t log_ns = 0;
  RosFix fix;
};

/// East, north, up to north, east, down; none if it is not known or none of a position. Off the diagonal, only one that is
/// known whole has meaning.
std::optional<Eigen::Matrix3d> covariance_ned(const RosFix& fix) {
  constexpr double kLargest = 1e12;  // m^2
  if (fix.covariance == RosFix::Covariance::kUnknown || !fix.covariance_enu.allFinite()) return std::nullopt;
  Eigen::Matrix3d C_enu_ned;
  C_enu_ned << 0, 1, 0, 1, 0, 0, 0, 0, -1;
  Eigen::Matrix3d enu = 0.5 * (fix.covariance_enu + fix.covariance_enu.transpose());
  if (fix.covariance != RosFix::Covariance::kKnown) enu = Eigen::Matrix3d(enu.diagonal().asDiagonal());
  const Eigen::Matrix3d ned = C_enu_ned * enu * C_enu_ned.transpose();
  const bool possible = ned.diagonal().maxCoeff() < kLargest && ned.llt().info() == Eigen::Success;
  return possible ? std::optional(ned) : std::nullopt;
}

/// What stands for ground-based augmentation is anything from differential corrections to fixed ambiguities.
record::FixQuality ros_quality(int status) {
  return status == 0   ? record::FixQuality::kSingle
         : status == 1 ? record::FixQuality::kSbas
         : status == 2 ? record::FixQuality::kDgps
                       : record::FixQuality::kUnknown;
}

ReceiverPosition position_of_bag(const RosFix& fix, std::optional<geo::GpsTime> t) {
  ReceiverPosition position;
  position.t = t;
  position.solved = fix.status >= 0;
  position.r_ea_e = ecef_if_on_earth({fix.latitude_deg * geo::kDegree, fix.longitude_deg * geo::kDegree, fix.height});
  position.position_cov_n = covariance_ned(fix);
  position.quality = ros_quality(fix.status);
  return position;
}

}  // namespace

record::GnssRecording read_bag_gnss(OpenBag open, const GnssFileOptions& options, Format::Near near) {
  const auto stream = open(options.file);
  BagRows<BagFixRow> topics({options.topic, "gnss", std::string(kRosFixType)});
  BagMessage message;
  while (stream->next(message)) {
    if (message.topic->type != kRosFixType || !is_decoded(*message.topic)) continue;
    const auto fix = ros_fix(message);
    topics.add(*message.topic, fix ? std::optional(BagFixRow{message.log_ns, *fix}) : std::nullopt);
  }
  const std::string& file = stream->name();
  record::Events events = stream->events();
  // The positions add the offset themselves, except where stamps become times by it.
  GnssFileOptions positions = options;
  positions.time.offset_s = 0.0;
  BagTimes times(options.time, near, [&file](auto found, auto expected, auto what_to_do) {
    return InputError({file, 0, found, expected, what_to_do});
  });
  ReceiverPositions fixes(positions, file);
  for (const BagFixRow& row : topics.chosen(file, events))
    fixes.take(position_of_bag(row.fix, times.at(row.fix.stamp_ns, row.log_ns)));
  times.report(events, file);
  return fixes.finish(std::move(events),
                      {.positions = {file, 0, "a bag without positions", "messages of sensor_msgs/NavSatFix", ""},
                       .for_time = "If the stamps count from a start, state `time: {kind: elapsed}` and `gps_week`.",
                       .for_accuracy = "Give `sd_m: [n, e, d]` beside the file."});
}

}  // namespace coast::io
