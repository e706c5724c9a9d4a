// Definitions of messages: common_msgs of ROS 1, common_interfaces of ROS 2. The fields are the same, but for `seq` of the
// header in ROS 1. Serialisation: ROS 1 without padding, little endian; ROS 2 as CDR (OMG DDSI-RTPS 2.3, 10: encapsulation;
// CORBA 3.3, 9.3: alignment of each number to its size, counted from behind the encapsulation).

#include "ros_message.hpp"

#include "../binary.hpp"

namespace coast::io {

namespace {

constexpr std::string_view kPoseType = "geometry_msgs/PoseStamped";
constexpr std::string_view kPoseWithCovarianceType = "geometry_msgs/PoseWithCovarianceStamped";
constexpr std::string_view kTransformType = "geometry_msgs/TransformStamped";
constexpr std::string_view kOdometryType = "nav_msgs/Odometry";

/// Fields of a message one after another, in either serialisation. Behind the end all are zero, and `whole` is false.
class RosFields {
 public:
  explicit RosFields(const BagMessage& message) : ros1_(message.topic->encoding == BagEncoding::kRos1), bytes_(message.bytes) {
    if (ros1_) return;
    constexpr std::size_t kEncapsulation = 4;
    constexpr char kCdrBigEndian = 0, kCdrLittleEndian = 1;
    ok_ = bytes_.size() >= kEncapsulation && bytes_[0] == 0 && (bytes_[1] == kCdrBigEndian || bytes_[1] == kCdrLittleEndian);
    if (!ok_) return;
    big_endian_ = bytes_[1] == kCdrBigEndian;
    bytes_.remove_prefix(kEncapsulation);
  }

  template <class T>
  T number() {
    if (!ros1_) at_ = (at_ + sizeof(T) - 1) / sizeof(T) * sizeof(T);
    if (!take(sizeof(T))) return T{};
    return number_at<T>(bytes_, at_ - sizeof(T), big_endian_);
  }
  /// A length and so many characters; CDR counts a zero at the end with them.
  void skip_text() { (void)take(number<std::uint32_t>()); }
  void skip_numbers(std::size_t number_of_doubles) {
    for (std::size_t i = 0; i < number_of_doubles; ++i) (void)number<double>();
  }
  template <class Vector>
  Vector vector() {
    Vector v = Vector::Zero();
    for (Eigen::Index i = 0; i < v.size(); ++i) v.data()[i] = number<double>();
    return v;
  }
  Eigen::Quaterniond quaternion() {
    const auto v = vector<Eigen::Vector4d>();
    return {v[3], v[0], v[1], v[2]};
  }
  /// The stamp of the header, in ns.
  std::int64_t header() {
    constexpr std::int64_t kNano = 1'000'000'000;
    if (ros1_) (void)number<std::uint32_t>();  // a sequence number
    const std::int64_t seconds = ros1_ ? std::int64_t{number<std::uint32_t>()} : std::int64_t{number<std::int32_t>()};
    const std::int64_t nanoseconds = number<std::uint32_t>();
    skip_text();  // the frame
    return kNano * seconds + nanoseconds;
  }
  /// All fields were there, and nothing but padding is behind them.
  [[nodiscard]] bool whole() const {
    constexpr std::size_t kMostPadding = 7;
    return ok_ && bytes_.size() - at_ <= (ros1_ ? 0 : kMostPadding);
  }

 private:
  [[nodiscard]] bool take(std::size_t size) {
    ok_ = ok_ && at_ <= bytes_.size() && size <= bytes_.size() - at_;
    if (ok_) at_ += size;
    return ok_;
  }

  bool ros1_;
  bool big_endian_ = false;
  bool ok_ = true;
  std::string_view bytes_;
  std::size_t at_ = 0;
};

using RosMatrix3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

}  // namespace

bool is_ros_pose(std::string_view type) {
  return type == kPoseType || type == kPoseWithCovarianceType || type == kTransformType || type == kOdometryType;
}

bool is_decoded(const BagTopic& topic) {
  return topic.encoding != BagEncoding::kOther &&
         (topic.type == kRosImuType || topic.type == kRosFixType || is_ros_pose(topic.type));
}

std::optional<RosImu> ros_imu(const BagMessage& message) {
  constexpr std::size_t kQuaternion = 4;
  RosFields fields(message);
  RosImu imu;
  imu.stamp_ns = fields.header();
  fields.skip_numbers(kQuaternion);
  (void)fields.vector<RosMatrix3>();  // covariance of the attitude
  imu.gyro = fields.vector<Eigen::Vector3d>();
  const auto gyro_cov = fields.vector<RosMatrix3>();
  imu.accel = fields.vector<Eigen::Vector3d>();
  const auto accel_cov = fields.vector<RosMatrix3>();
  imu.measured = gyro_cov(0, 0) != -1.0 && accel_cov(0, 0) != -1.0;
  return fields.whole() ? std::optional(imu) : std::nullopt;
}

std::optional<RosFix> ros_fix(const BagMessage& message) {
  RosFields fields(message);
  RosFix fix;
  fix.stamp_ns = fields.header();
  fix.status = fields.number<std::int8_t>();
  (void)fields.number<std::uint16_t>();  // the systems in use
  fix.latitude_deg = fields.number<double>();
  fix.longitude_deg = fields.number<double>();
  fix.height = fields.number<double>();
  fix.covariance_enu = fields.vector<RosMatrix3>();
  const auto kind = fields.number<std::uint8_t>();
  if (!fields.whole() || kind > static_cast<std::uint8_t>(RosFix::Covariance::kKnown)) return std::nullopt;
  fix.covariance = static_cast<RosFix::Covariance>(kind);
  return fix;
}

std::optional<RosPose> ros_pose(const BagMessage& message) {
  constexpr std::size_t kCovariance = 36, kTwist = 6;
  const std::string& type = message.topic->type;
  RosFields fields(message);
  RosPose pose;
  pose.stamp_ns = fields.header();
  if (type == kOdometryType || type == kTransformType) fields.skip_text();  // the body's frame
  pose.position = fields.vector<Eigen::Vector3d>();
  pose.attitude = fields.quaternion();
  if (type == kOdometryType || type == kPoseWithCovarianceType) fields.skip_numbers(kCovariance);
  if (type == kOdometryType) fields.skip_numbers(kTwist + kCovariance);
  return fields.whole() ? std::optional(pose) : std::nullopt;
}

}  // namespace coast::io
