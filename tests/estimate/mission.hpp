#pragma once
// The missions that the tests of this room run on: a weaving drive with known truth, sensors and antenna on it.

#include <memory>
#include <random>
#include <string>

#include "coast/estimate/forward_filter.hpp"
#include "coast/estimate/state_layout.hpp"
#include "coast/noise/error_model.hpp"
#include "coast/record/gnss.hpp"
#include "coast/record/imu.hpp"
#include "coast/simulate/gnss.hpp"
#include "coast/simulate/trajectory.hpp"

namespace coast::test {

/// Every kind of process on every axis, correlation times from 5 s: 9 + 36 states.
extern const char* const kFullModel;
/// Industrial MEMS: white noise, turn-on constant, Gauss-Markov bias and scale factor: 9 + 18 states.
extern const char* const kIndustrialModel;

[[nodiscard]] noise::ImuErrorModel error_model(const std::string& yaml);

/// A drive that turns, brakes, climbs and shakes from its first second on, 5 to 20 m/s.
[[nodiscard]] const simulate::AnalyticTrajectory& weaving(double duration);
[[nodiscard]] geo::GpsTime mission_start();

/// Standard deviations of a start, each axis; heading apart.
struct StartSd {
  double position = 0.1;
  double velocity = 0.05;
  double tilt = 2e-3;
  double heading = 5e-3;
  [[nodiscard]] Eigen::Vector3d attitude() const { return {tilt, tilt, heading}; }
};

/// A recording with everything that the filter needs. Movable in one piece; `mission()` refers to it.
struct Recording {
  const simulate::AnalyticTrajectory* motion = nullptr;
  record::ImuRecording imu;
  record::GnssRecording gnss;
  Eigen::Vector3d lever_arm_b = Eigen::Vector3d::Zero();
  [[nodiscard]] estimate::Mission mission() const;
  [[nodiscard]] record::NavState truth(geo::GpsTime t) const { return motion->nav_state(mission_start(), t - mission_start()); }
};

struct RecordingOptions {
  double duration = 120.0;
  double imu_rate_hz = 100.0;
  simulate::GnssOptions gnss = {};
};
/// @param model  of the sensor errors; null for an error-free IMU
[[nodiscard]] Recording make_recording(const RecordingOptions& options, const noise::ImuErrorModel* model, std::uint64_t seed);

/// Fixes first to last - 1 have float ambiguities.
inline void float_between(record::GnssRecording& gnss, std::size_t first, std::size_t last) {
  for (std::size_t i = first; i < last; ++i) gnss.fixes[i].quality = record::FixQuality::kFloat;
}

/// A start state with errors drawn from its own covariance.
[[nodiscard]] estimate::FilterState drawn_start(const estimate::ForwardFilter& filter, const record::NavState& truth,
                                                const StartSd& sd, std::mt19937_64& random);

/// The rate that the filter would have at `state` if it had `omega` with the sensor states x0: measured rate minus estimated
/// errors. For finite differences.
[[nodiscard]] Eigen::Vector3d rate_at(const estimate::StateLayout& layout, const Eigen::Vector3d& omega,
                                      const Eigen::VectorXd& x0, const estimate::FilterState& state);

/// A vector of independent normal numbers.
[[nodiscard]] Eigen::VectorXd normal_vector(Eigen::Index size, std::mt19937_64& random);
/// A symmetric positive definite matrix with eigenvalues near 1.
[[nodiscard]] Eigen::MatrixXd random_covariance(Eigen::Index size, std::mt19937_64& random);

}  // namespace coast::test
