#pragma once
// Comparison of the same motion in IMU and GNSS without known attitude: used by the inspection.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "coast/record/gnss.hpp"
#include "coast/record/imu.hpp"

namespace coast::io {

/// Means of rate and specific force over any interval, from running integrals on an even grid.
class ImuMeans {
 public:
  explicit ImuMeans(const record::ImuRecording& imu);
  struct Mean {
    Eigen::Vector3d rate;
    Eigen::Vector3d force;
  };
  /// Over [from, to], seconds since the first sample's interval began; none if not inside the recording.
  [[nodiscard]] std::optional<Mean> over(double from, double to) const;
  [[nodiscard]] geo::GpsTime origin() const { return origin_; }
  [[nodiscard]] double length() const { return step_ * static_cast<double>(nodes_.size() - 1); }

 private:
  using Node = Eigen::Matrix<double, 6, 1>;
  [[nodiscard]] Node at(double t) const;
  geo::GpsTime origin_;
  double step_ = 0.05;
  std::vector<Node> nodes_;
};

/// Between two fixes about half a second or more apart: speed, and change of the horizontal velocity.
struct GnssLeg {
  double from = 0.0;  ///< s since the IMU's origin, in GNSS time
  double to = 0.0;
  double speed = 0.0;        ///< m/s, three-dimensional, mean
  double course_rate = 0.0;  ///< rad/s, clockwise; only if `moving`
  double along = 0.0;        ///< acceleration along the course, m/s^2
  double across = 0.0;       ///< acceleration to the right of it, m/s^2
  bool moving = false;       ///< fast enough at both ends for a course
};
[[nodiscard]] std::vector<GnssLeg> gnss_legs(const record::GnssRecording& gnss, geo::GpsTime origin);

/// Specific force at rest, and its source.
struct RestForce {
  Eigen::Vector3d force;
  double seconds = 0.0;  ///< of standstill
  bool seen = false;     ///< standstill by GNSS; else the quietest seconds
};
[[nodiscard]] std::optional<RestForce> rest_force(const ImuMeans& means, const std::vector<GnssLeg>& legs);

/// Best shift of GNSS times relative to the IMU, from turn rates about `down`.
struct TimeMatch {
  double shift = 0.0;        ///< add to GNSS times, s
  double correlation = 0.0;  ///< signed, at the shift
  double correlation_unshifted = 0.0;
  double slope = 0.0;  ///< turn rate over course rate at the shift
};
[[nodiscard]] std::optional<TimeMatch> match_time(const ImuMeans& means, const std::vector<GnssLeg>& legs,
                                                  const Eigen::Vector3d& down);

/// Angle from body x (y if x is steep), levelled, to the direction of travel, clockwise from above, and the fraction of the
/// motion explained by it.
struct TravelDirection {
  double yaw = 0.0;          ///< rad
  double correlation = 0.0;  ///< [0, 1]
  Eigen::Vector3d forward;   ///< unit vector of travel in body axes
};
[[nodiscard]] std::optional<TravelDirection> travel_direction(const ImuMeans& means, const std::vector<GnssLeg>& legs,
                                                              double shift, const Eigen::Vector3d& f_rest);

}  // namespace coast::io
