#include "coast/ins/mounting.hpp"

#include <cmath>
#include <string>
#include <vector>

#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"

namespace coast::ins {
namespace {

Eigen::RowVector3d axis(const config::Node& node) {
  const std::string text = node.text();
  const bool is_signed = !text.empty() && (text.front() == '-' || text.front() == '+');
  const std::string letter = text.substr(is_signed ? 1 : 0);
  const double sign = is_signed && text.front() == '-' ? -1.0 : 1.0;
  if (letter == "x") return {sign, 0.0, 0.0};
  if (letter == "y") return {0.0, sign, 0.0};
  if (letter == "z") return {0.0, 0.0, sign};
  throw node.error("'" + text + "'", "x, y or z with a sign: the sensor axis that points forward, right or down");
}

Eigen::Matrix3d parse_axes(const config::Node& node) {
  const std::vector<config::Node> items = node.items();
  if (items.size() != 3)
    throw node.error(std::to_string(items.size()) + " axes", "three: forward, right and down in terms of sensor axes",
                     "Example: [-x, y, -z].");
  Eigen::Matrix3d axes;
  for (std::size_t i = 0; i < 3; ++i) axes.row(static_cast<Eigen::Index>(i)) = axis(items[i]);
  const double determinant = axes.determinant();
  if (determinant == 0.0) throw node.error("one sensor axis twice", "each of x, y, z once");
  if (determinant < 0.0)
    throw node.error("a left-handed set of axes", "a right-handed one: forward x right = down", "Change one sign.");
  return axes;
}

}  // namespace

MountingOptions MountingOptions::from(const config::Node& imu) {
  MountingOptions options;
  if (const auto axes = imu.find("axes")) options.axes = parse_axes(*axes);
  const Eigen::Vector3d degrees = imu.vector3("mounting_deg", Eigen::Vector3d::Zero());
  if (std::abs(degrees(0)) > 180.0 || std::abs(degrees(1)) > 90.0 || std::abs(degrees(2)) > 180.0)
    throw imu.at("mounting_deg").error("an angle out of range", "roll and yaw in [-180, 180], pitch in [-90, 90] deg");
  options.mounting = degrees * geo::kDegree;
  return options;
}

Eigen::Matrix3d C_s_b(const MountingOptions& options) {
  const Eigen::Vector3d& m = options.mounting;
  return geo::dcm_from_euler({m(0), m(1), m(2)}).transpose() * options.axes;
}

void to_body(record::ImuRecording& recording, const Eigen::Matrix3d& C_s_b) {
  for (record::ImuSample& sample : recording.samples) {
    sample.dtheta = C_s_b * sample.dtheta;
    sample.dv = C_s_b * sample.dv;
  }
}

}  // namespace coast::ins
