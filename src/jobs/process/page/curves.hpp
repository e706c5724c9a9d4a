#pragma once
// Data that TrajectoryCurves collects from the streamed trajectories: decimated, so that memory does not grow with the mission.

#include <array>
#include <optional>

#include "coast/geo/earth.hpp"
#include "coast/report/series.hpp"
#include "process/page/page.hpp"

namespace coast::jobs {

/// One decimator per component: N, E, D or roll, pitch, yaw or forward, right, down.
using Decimators = std::array<report::Decimator, 3>;

/// North-east-down at the point, renewed only after the point has moved: per epoch it costs a product instead of the
/// conversion to geodetic coordinates. Rotation accurate to 3e-6 rad, height to 3e-5 m.
class NearbyFrame {
 public:
  void move_to(const Eigen::Vector3d& r_e);
  [[nodiscard]] Eigen::Matrix3d C_e_n() const { return frame_->rotation().transpose(); }
  [[nodiscard]] double height(const Eigen::Vector3d& r_e) const { return height_ - frame_->to_ned(r_e).z(); }

 private:
  std::optional<geo::LocalFrame> frame_;
  double height_ = 0.0;  ///< of the frame's origin, m
};

/// The largest sigmas within a minute: N, E, D in m; roll, pitch, yaw in deg.
struct MinuteAccuracy {
  double from_s = 0.0;  ///< since the start
  Eigen::Vector3d sd_position = Eigen::Vector3d::Zero();
  Eigen::Vector3d sd_attitude = Eigen::Vector3d::Zero();
};

/// Curves over seconds since the start; angles in degrees. Forward and smoothed share no data: they may be drawn concurrently.
struct SolutionCurves {
  explicit SolutionCurves(double start_yaw);
  Decimators position;  ///< N, E in the tangent plane of the start, D as height loss since the start, m; band one sigma
  Decimators velocity;  ///< N, E, D at the point, m/s; band one sigma
  Decimators attitude;  ///< roll, pitch, yaw (unwrapped), deg; band one sigma
  Decimators sd_position;
  Decimators sd_velocity;
  Decimators sd_attitude;
  std::vector<MinuteAccuracy> minutes;
  NearbyFrame nearby;
  double yaw;  ///< previous one, unwrapped, rad
};

struct TrajectoryCurves::Curves {
  explicit Curves(const record::NavState& nav);
  void add(const record::TrajectoryEpoch& epoch, SolutionCurves& to) const;
  void add_delivered(const record::TrajectoryEpoch& epoch);

  geo::GpsTime start;
  geo::LocalFrame local;  ///< origin at the start
  double start_height = 0.0;

  SolutionCurves forward;
  SolutionCurves smoothed;

  // For the delivered trajectory:
  report::Decimator track;     ///< east, north
  report::Decimator height;    ///< ellipsoidal, m
  report::Decimator distance;  ///< travelled since the start, m
  report::Decimator speed;     ///< horizontal, m/s
  Decimators body_velocity;    ///< forward, right, down, m/s
  report::Decimator slip;      ///< course minus heading, deg, if the speed is sufficient for a course
  double travelled = 0.0;
  std::optional<record::NavState> previous;
};

}  // namespace coast::jobs
