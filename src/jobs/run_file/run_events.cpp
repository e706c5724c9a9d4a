#include "run_file/run_events.hpp"

#include <cmath>
#include <string>

#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"

namespace coast::jobs {

EventOptions read_events(const config::Node& events) {
  EventOptions options;
  options.file = io::TimeMarkFileOptions::from(events);
  options.imu_clock = events.choice("clock", {"gnss", "imu"}, 0) == 1;
  constexpr double kLongestDelay = 10.0;  // s
  options.delay_s = events.number_within("delay_s", 0.0, -kLongestDelay, kLongestDelay);
  const config::Node camera = events.section("camera");
  options.camera.lever_arm_b = camera.vector3("lever_arm_m", Eigen::Vector3d::Zero());
  const Eigen::Vector3d degrees = camera.vector3("boresight_deg", Eigen::Vector3d::Zero());
  if (std::abs(degrees(0)) > 180.0 || std::abs(degrees(1)) > 90.0 || std::abs(degrees(2)) > 180.0)
    throw camera.at("boresight_deg").error("an angle out of range", "roll and yaw in [-180, 180], pitch in [-90, 90] deg");
  const Eigen::Vector3d angles = geo::kDegree * degrees;
  options.camera.C_s_b = geo::dcm_from_euler({angles(0), angles(1), angles(2)});
  return options;
}

record::TimeMarkRecording read_named_marks(const EventOptions& events, geo::GpsTime near) {
  record::TimeMarkRecording recording = io::read_time_marks(events.file, near);
  std::size_t number = 0;
  for (record::TimeMark& mark : recording.marks) {
    ++number;
    if (mark.id.empty()) mark.id = std::to_string(number);
  }
  return recording;
}

}  // namespace coast::jobs
