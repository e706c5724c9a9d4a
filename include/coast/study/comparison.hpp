#pragma once
// A computed trajectory against a reference: errors = estimate - reference, at the reference's epochs, in its N, E, D.

#include <optional>
#include <vector>

#include "coast/record/trajectory.hpp"

namespace coast::study {

struct ErrorSample {
  geo::GpsTime t;
  Eigen::Vector3d position_n = Eigen::Vector3d::Zero();   ///< N, E, D, m
  Eigen::Vector3d velocity_n = Eigen::Vector3d::Zero();   ///< m/s
  Eigen::Vector3d attitude = Eigen::Vector3d::Zero();     ///< roll, pitch, yaw, rad, wrapped
  Eigen::Vector3d sd_position = Eigen::Vector3d::Zero();  ///< of the estimate, m
  Eigen::Vector3d sd_attitude = Eigen::Vector3d::Zero();  ///< rad
};

/// Error of one state against another at the same instant.
[[nodiscard]] ErrorSample error_of(const record::TrajectoryEpoch& estimate, const record::NavState& reference);

/// Root mean squares; what the reference does not have is left out.
struct ErrorSummary {
  std::size_t epochs = 0;
  Eigen::Vector3d position_rms_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d position_max_m = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> velocity_rms_mps;
  std::optional<Eigen::Vector3d> attitude_rms;  ///< rad
};

/// Takes a trajectory epoch by epoch and compares it with the reference at each of the reference's epochs.
class Comparison {
 public:
  /// @param lever_arm_b  from the estimate's point to the reference's, body axes, m
  explicit Comparison(const record::Trajectory& reference, Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero());

  void add(const record::TrajectoryEpoch& epoch);
  [[nodiscard]] const std::vector<ErrorSample>& errors() const { return errors_; }
  [[nodiscard]] ErrorSummary summary() const;
  [[nodiscard]] bool has_velocity() const { return reference_.has_velocity; }
  [[nodiscard]] bool has_attitude() const { return reference_.has_attitude; }

 private:
  const record::Trajectory& reference_;
  Eigen::Vector3d lever_arm_b_;
  std::optional<record::TrajectoryEpoch> previous_;
  std::size_t next_ = 0;  ///< first reference epoch not yet compared
  std::vector<ErrorSample> errors_;
};

}  // namespace coast::study
