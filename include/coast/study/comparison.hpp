#pragma once
// A computed trajectory compared with a reference: errors = estimate - reference, at the reference's epochs, in its N, E, D.

#include <functional>
#include <optional>

#include "coast/record/trajectory.hpp"
#include "coast/study/interpolation.hpp"

namespace coast::study {

struct ErrorSample {
  geo::GpsTime t;
  Eigen::Vector3d position_n = Eigen::Vector3d::Zero();   ///< N, E, D, m
  Eigen::Vector3d velocity_n = Eigen::Vector3d::Zero();   ///< m/s
  Eigen::Vector3d attitude = Eigen::Vector3d::Zero();     ///< roll, pitch, yaw, rad, wrapped
  Eigen::Vector3d sd_position = Eigen::Vector3d::Zero();  ///< of the estimate, m
  Eigen::Vector3d sd_attitude = Eigen::Vector3d::Zero();  ///< rad
};

/// Error of one state relative to another at the same instant.
[[nodiscard]] ErrorSample error_of(const record::TrajectoryEpoch& estimate, const record::NavState& reference);

/// Statistics of one error vector, axis by axis, SI and rad.
struct AxisErrors {
  Eigen::Vector3d rms = Eigen::Vector3d::Zero();
  Eigen::Vector3d max = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> inside_95;  ///< share within 1.96 predicted sigma, if a sigma is predicted
};

/// Quantities that the reference does not have are left out.
struct ErrorSummary {
  std::size_t epochs = 0;
  AxisErrors position;
  std::optional<AxisErrors> velocity;
  std::optional<AxisErrors> attitude;
};

/// Accumulates errors one by one: memory does not grow with the mission.
class ErrorStatistics {
 public:
  void add(const ErrorSample& sample);
  [[nodiscard]] ErrorSummary summary(bool has_velocity, bool has_attitude) const;

 private:
  struct Sums {
    Eigen::Vector3d squares = Eigen::Vector3d::Zero();
    Eigen::Vector3d max = Eigen::Vector3d::Zero();
    Eigen::Vector3d inside = Eigen::Vector3d::Zero();
  };
  static void add_to(Sums& sums, const Eigen::Vector3d& value, const Eigen::Vector3d& sd);
  [[nodiscard]] AxisErrors of(const Sums& sums, bool has_sd) const;

  std::size_t epochs_ = 0;
  Sums position_;
  Sums velocity_;
  Sums attitude_;
};

/// Compares a trajectory, added epoch by epoch, with the reference at each of the reference's epochs.
class Comparison {
 public:
  using Sink = std::function<void(const ErrorSample&)>;
  /// @param lever_arm_b  from the estimate's point to the reference's, body axes, m
  /// @param sink         gets every error, in order
  explicit Comparison(const record::Trajectory& reference, Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero(),
                      Sink sink = {});

  void add(const record::TrajectoryEpoch& epoch);
  [[nodiscard]] ErrorSummary summary() const { return statistics_.summary(reference_.has_velocity, reference_.has_attitude); }

 private:
  const record::Trajectory& reference_;
  Eigen::Vector3d lever_arm_b_;
  Sink sink_;
  std::optional<record::TrajectoryEpoch> previous_;
  PassingMotion motion_;
  std::size_t next_ = 0;  ///< first reference epoch not yet compared
  ErrorStatistics statistics_;
};

}  // namespace coast::study
