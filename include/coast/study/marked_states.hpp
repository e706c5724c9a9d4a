#pragma once
// The state of a device on the body, such as a camera, at marked instants.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "coast/record/time_mark.hpp"
#include "coast/record/trajectory.hpp"
#include "coast/study/interpolation.hpp"

namespace coast::study {

/// Where a device is on the body, and how it is turned. Its axes s are those of a camera that looks down: forward to the top of
/// the image, right, down along the view.
struct Mounted {
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();  ///< from the IMU to the device, m
  Eigen::Matrix3d C_s_b = Eigen::Matrix3d::Identity();
};

/// A mark without a state.
struct MissedMark {
  enum class Why { kBefore, kAfter, kGap };
  record::TimeMark mark;
  Why why;
};

/// Takes a trajectory epoch by epoch and interpolates it to marks: as `interpolate` between the two epochs about each, the
/// covariance linearly. The lever arm adds its share of the attitude's covariance to that of position and velocity; the
/// covariance between position and attitude is not known here and left out. A stated sd of the mark's time adds the motion
/// during it. Mounting and lever arm count as free of errors.
class MarkedStates {
 public:
  /// @param marks               in the order of time
  /// @param delay_s             from the mark to the instant that is meant, s
  /// @param longest_interval_s  between epochs; a mark in a longer one is missed
  MarkedStates(std::vector<record::TimeMark> marks, double delay_s, const Mounted& mounted, double longest_interval_s);

  /// In time order.
  void add(const record::TrajectoryEpoch& epoch);
  /// After the last epoch: the marks that are left lie behind it.
  void finish();

  [[nodiscard]] const std::vector<record::MarkedState>& states() const { return states_; }
  [[nodiscard]] const std::vector<MissedMark>& missed() const { return missed_; }

 private:
  [[nodiscard]] record::MarkedState between(const record::TrajectoryEpoch& epoch, const record::TimeMark& mark,
                                            geo::GpsTime t) const;

  std::vector<record::TimeMark> marks_;
  double delay_s_;
  Mounted mounted_;
  double longest_interval_s_;
  std::size_t next_ = 0;
  std::optional<record::TrajectoryEpoch> previous_;
  PassingMotion motion_;
  Eigen::Vector3d omega_eb_b_ = Eigen::Vector3d::Zero();  ///< over the interval that ends with the last epoch, rad/s
  std::vector<record::MarkedState> states_;
  std::vector<MissedMark> missed_;
};

/// How much later than stated the instants of images are, by the positions stated beside them.
struct DelayEstimate {
  double delay_s = 0.0;                                ///< beyond the delay already used
  double sd_s = 0.0;                                   ///< as if the errors of the stated positions were independent
  std::size_t marks = 0;                               ///< with a position
  double residual_m = 0.0;                             ///< rms of the horizontal differences that remain, per component
  Eigen::Vector2d offset_n = Eigen::Vector2d::Zero();  ///< stated minus computed positions, constant part, north and east, m
};

/// Least squares of horizontal differences, stated minus computed: velocity times delay, and a constant offset north and east.
/// A lever arm along the direction of motion that is not accounted for looks like a delay.
/// @return nothing with fewer than 4 positions, or if the velocity is the same at all: then a delay is an offset
[[nodiscard]] std::optional<DelayEstimate> estimate_delay(const std::vector<record::MarkedState>& states);

}  // namespace coast::study
