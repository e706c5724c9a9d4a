#pragma once
// The checks for a verdict: by GNSS, gravity and the error model.

#include <optional>
#include <string>
#include <vector>

#include "coast/jobs/process.hpp"

namespace coast::jobs {

/// Compares a solution epoch by epoch: its speed with that of the fixes, its tilt with the specific force at rest.
class MotionChecks {
 public:
  explicit MotionChecks(const estimate::Mission& mission);
  void add(const record::TrajectoryEpoch& epoch);
  /// Checks `distance_over_gnss` and `tilt_at_rest_deg`, if the recording has the required data.
  [[nodiscard]] std::vector<Check> checks() const;

 private:
  struct Leg {
    geo::GpsTime from, to;
    double length = 0.0, sd = 0.0;  ///< of the fixes, m
    double travelled = 0.0;         ///< of the solution, m
  };
  struct Rest {
    geo::GpsTime middle;
    Eigen::Vector3d f_b;           ///< mean specific force
    std::optional<double> tilt{};  ///< between it and the attitude, rad
  };
  std::vector<Leg> legs_;
  std::vector<Rest> rests_;
  std::size_t leg_ = 0, rest_ = 0;
  std::optional<geo::GpsTime> last_;
};

/// Sensor states at the end of the forward run relative to their prior by the error model: the largest in sigmas.
[[nodiscard]] std::optional<Check> sensor_check(const estimate::StateLayout& layout, const Eigen::VectorXd& x);

/// The likeliest cause and the next one, as a sentence; empty if there is none.
[[nodiscard]] std::string told(const std::vector<study::Cause>& causes);

/// Whether the likeliest cause is that the samples are not what the run file says.
[[nodiscard]] std::optional<Check> misreading_check(const std::vector<study::Cause>& causes);

/// All checks of a run, and the likeliest cause of the failed ones.
/// @param motion  of the delivered solution, and all other checks made before
[[nodiscard]] Judgement judge(const ProcessResult& result, std::vector<Check> motion);

}  // namespace coast::jobs
