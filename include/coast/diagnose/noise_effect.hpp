#pragma once
// Random effects: a process of one sensor axis that may be missing in the error model, and the catalogue of all.

#include <Eigen/Core>
#include <array>
#include <functional>
#include <string_view>
#include <vector>

#include "coast/diagnose/effect.hpp"

namespace coast::diagnose {

struct MissionInput;

/// The six axes of an IMU in one row: gyro x, y, z, accelerometer x, y, z.
inline constexpr int kAxes = 6;

/// Scores of an error of one sensor axis that is constant over an interval between knots, for every interval.
struct Disturbances {
  std::vector<geo::GpsTime> t;  ///< starts of the intervals, ascending
  std::vector<double> length;   ///< s
  /// By axis, one column per interval: score of a unit error over it. Row 0: as recorded; further rows: random draws.
  std::array<Eigen::MatrixXf, kAxes> score;
};

/// One random effect. Its score test (Harvey 1989, section 5.1): with a_k the score of the error of interval k, the score of
/// the variance of a process is half of a sum of squares of sums of a_k, minus its expectation by chance.
struct NoiseEffect {
  std::string_view name{};
  Site site = Site::kGyro;
  std::string_view parameter{};  ///< name of the root of the variance
  std::string_view unit{};
  std::string_view equation{};
  std::string_view meaning{};
  std::string_view separating_manoeuvre{};
  std::string_view source{};
  std::vector<double> times{};  ///< correlation times that are tested, s; {0}: none
  /// Quantity to which the variance is proportional; empty: constant variance.
  std::function<double(const Signals&)> level = {};
  /// The sum of squares, for every row of the scores. @param level  mean over each interval; ones if there is none
  std::function<Eigen::ArrayXf(const Disturbances&, const Eigen::MatrixXf& score, const std::vector<double>& level,
                               double time)>
      power = {};
  /// Adds it to a mission's model. @param axis  0 to 2  @param t, level  starts of intervals and means over them
  std::function<void(MissionInput&, int axis, double root, double time, const std::vector<geo::GpsTime>& t,
                     const std::vector<double>& level)>
      add = {};
};

/// Every random effect. A new one is a file in src/diagnose/noise_effects and a line in noise_catalogue.cpp.
[[nodiscard]] const std::vector<NoiseEffect>& noise_catalogue();

}  // namespace coast::diagnose
