// Trajectories of a bag: one topic of poses in a local frame, whose origin the run file states.

#include <fmt/format.h>

#include <cmath>

#include "../position.hpp"
#include "../repairs.hpp"
#include "bag_readers.hpp"
#include "bag_topics.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/record/error.hpp"
#include "ros_message.hpp"

namespace coast::io {

namespace {

struct BagPoseRow {
  std::int64_t log_ns = 0;
  RosPose pose;
};

class BagPoses {
 public:
  BagPoses(const ReferenceFileOptions& options, std::optional<geo::GpsTime> near, std::string file)
      : options_(options),
        file_(std::move(file)),
        position_(options.position, file_, error_),
        C_n_e_(geo::C_n_e(*options.position.origin)),
        times_(options.time, near, error_),
        order_(error_, repairs_) {}

  void take(const BagPoseRow& row) {
    ++rows_;
    const Eigen::Vector3d& p = row.pose.position;
    const auto t = times_.at(row.pose.stamp_ns, row.log_ns);
    const bool turned = std::abs(row.pose.attitude.norm() - 1.0) < kMostOff;
    if (!t || !p.allFinite() || !turned) {
      unusable_.add(t);
      return;
    }
    record::NavState state;
    state.t = *t;
    state.r_eb_e = position_.to_ecef(p.x(), p.y(), p.z());
    state.q_b_e = attitude(row.pose.attitude.normalized());
    auto& states = trajectory_.states;
    if (order_.accept(state.t, !states.empty() && states.back().r_eb_e == state.r_eb_e)) states.push_back(state);
  }

  record::Trajectory finish(record::Events damage) {
    if (trajectory_.states.empty())
      throw InputError(
          {file_, 0, fmt::format("{} poses, none with a time, a place and a unit quaternion", rows_), "at least one", ""});
    trajectory_.source = file_;
    trajectory_.has_velocity = false;
    trajectory_.has_attitude = true;
    trajectory_.events = std::move(damage);
    repairs_.finish(rows_, trajectory_.events);
    times_.report(trajectory_.events, file_);
    add_counted(trajectory_.events, file_, unusable_,
                {"nan_row", "pose", "poses", "without a time, a place or a unit quaternion left out"});
    return std::move(trajectory_);
  }

 private:
  static constexpr double kMostOff = 0.01;  // of the norm of a quaternion

  /// The pose's frame is that of the origin everywhere: no meridians converge in it.
  [[nodiscard]] Eigen::Quaterniond attitude(Eigen::Quaterniond q) const {
    const double half = std::sqrt(0.5);
    if (options_.position.frame == PositionOptions::Frame::kEnu) q = Eigen::Quaterniond(0.0, half, half, 0.0) * q;
    if (options_.attitude.body_flu) q = q * Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0);
    return (Eigen::Quaterniond(C_n_e_) * q).normalized();
  }

  const ReferenceFileOptions& options_;
  std::string file_;
  long rows_ = 0;
  WeekClock::MakeError error_ = [this](auto found, auto expected, auto what_to_do) {
    return InputError({file_, 0, fmt::format("pose {}: {}", rows_, found), expected, what_to_do});
  };
  PositionConverter position_;
  Eigen::Matrix3d C_n_e_;
  BagTimes times_;
  Repairs repairs_;
  TimeOrder order_;
  record::Trajectory trajectory_;
  Counted unusable_;
};

}  // namespace

record::Trajectory read_bag_reference(OpenBag open, const ReferenceFileOptions& options, Format::Near near) {
  const auto stream = open(options.file);
  BagRows<BagPoseRow> topics({options.topic, "reference",
                              "geometry_msgs/PoseStamped, PoseWithCovarianceStamped, TransformStamped or nav_msgs/Odometry"});
  BagMessage message;
  while (stream->next(message)) {
    if (!is_ros_pose(message.topic->type) || !is_decoded(*message.topic)) continue;
    const auto pose = ros_pose(message);
    topics.add(*message.topic, pose ? std::optional(BagPoseRow{message.log_ns, *pose}) : std::nullopt);
  }
  record::Events events = stream->events();
  const auto rows = topics.chosen(stream->name(), events);
  const auto frame = options.position.frame;
  if ((frame != PositionOptions::Frame::kEnu && frame != PositionOptions::Frame::kNed) || !options.position.origin)
    throw InputError(
        {stream->name(), 0, "poses in a local frame without its place on the Earth", "",
         "State `frame: enu`, `origin_deg_m: [lat, lon, h]` and, of bodies with z up, `body_axes: flu` beside the file."});
  BagPoses poses(options, near, stream->name());
  for (const BagPoseRow& row : rows) poses.take(row);
  return poses.finish(std::move(events));
}

}  // namespace coast::io
