#pragma once
// Readings of aiding sensors on a moving body, as files hold them.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "coast/config/node.hpp"
#include "coast/record/aid.hpp"
#include "coast/simulate/gnss.hpp"
#include "coast/simulate/trajectory.hpp"

namespace coast::simulate {

/// An item of `aids:` of a scenario.
///
///     aids:
///       - {kind: odometer, rate_hz: 50, sd_mps: 0.02, scale: 1.02, delay_s: 0.08, point_m: [-1.2, 0, 0.6],
///          metres_per_pulse: 0.02,                                      # left out: speeds
///          slips: [{elapsed_s: 300, duration_s: 5, share: 0.1}]}       # the wheels turn faster by this share
///       - {kind: heading, rate_hz: 1, sd_deg: 0.2, baseline_m: [1, 0, 0], offset_deg: 0.5}
///       - {kind: height, rate_hz: 10, sd_m: 0.2, offset_m: 12, drift: {sd_m: 1, correlation_time_s: 600}}
struct AidOptions {
  enum class Kind { kOdometer, kHeading, kHeight };
  struct Slip {
    Interval when;
    double share = 0.0;
  };
  Kind kind = Kind::kOdometer;
  double rate_hz = 10.0;
  double sd = 0.0;       ///< white, m/s, rad or m
  double delay_s = 0.0;  ///< a row tagged t is of t - delay
  Eigen::Vector3d point_b = Eigen::Vector3d::Zero();
  Eigen::Vector3d baseline_b = Eigen::Vector3d::UnitX();
  double scale = 1.0;  ///< true distance over that of the odometer
  std::optional<double> metres_per_pulse;
  std::vector<Slip> slips;
  double offset = 0.0;  ///< rad or m
  double drift_sd = 0.0;
  double drift_time_s = 600.0;

  /// @throws InputError
  [[nodiscard]] static AidOptions from(const config::Node& node);
  [[nodiscard]] std::string name() const;    ///< "odometer"
  [[nodiscard]] std::string column() const;  ///< of the values: "speed_mps"
  /// What a run file says of it besides the file: what is known of such a sensor, not the errors that were drawn.
  [[nodiscard]] std::string run_keys() const;
};

/// Rows in the units of the file.
/// @param index  in the scenario's list: its noise has its own seeds
[[nodiscard]] record::AidRecording aid_rows(const AnalyticTrajectory& motion, geo::GpsTime start, const AidOptions& options,
                                            std::uint64_t seed, std::size_t index);

}  // namespace coast::simulate
