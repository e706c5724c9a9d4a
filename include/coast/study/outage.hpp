#pragma once
// Artificial outages: drift of the forward and the smoothed solution while GNSS is withheld.

#include <optional>
#include <vector>

#include "coast/estimate/forward_filter.hpp"
#include "coast/study/comparison.hpp"
#include "coast/study/manoeuvre.hpp"

namespace coast::study {

/// GNSS with start <= t < start + duration is withheld, except for some satellites if the outage is partial.
struct Outage {
  geo::GpsTime start;
  double duration_s = 0.0;
  int satellites_left = 0;  ///< the highest ones; 0: none
  [[nodiscard]] estimate::Withheld span() const { return {start, start + duration_s, satellites_left}; }
};

/// Errors of one solution inside one outage.
struct OutageErrors {
  Eigen::Vector3d max_m = Eigen::Vector3d::Zero();  ///< largest absolute value, N, E, D
  Eigen::Vector3d rms_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d end_m = Eigen::Vector3d::Zero();        ///< at the last IMU epoch before the next used fix
  Eigen::Vector3d sigma_end_m = Eigen::Vector3d::Zero();  ///< one sigma there
  Eigen::Vector3d sigma_max_m = Eigen::Vector3d::Zero();  ///< largest one sigma inside the outage
  double horizontal_max_m = 0.0;
  Eigen::Vector3d attitude_max = Eigen::Vector3d::Zero();  ///< rad
  std::size_t inside_95 = 0;  ///< errors of one axis and epoch within 1.96 sigma, at most ten epochs per second
  std::size_t tested = 0;
  std::optional<double> gnss_horizontal_max_m;  ///< relative to the withheld fixes, at the antenna
  std::vector<ErrorSample> series;              ///< for figures, at most ten per second, some seconds around the outage
};

struct OutageResult {
  Outage outage;
  OutageErrors forward;
  std::optional<OutageErrors> smoothed;
  Manoeuvre manoeuvre = Manoeuvre::kStraight;  ///< during the outage
};

inline constexpr double kMargin = 10.0;  ///< s before and after an outage that are included in its series, for figures

/// Collects the errors of a streamed trajectory inside (and, for figures, around) one outage.
class OutageRecorder {
 public:
  /// @param reference must outlive the recorder  @param lever_arm_b from the IMU to the reference's point
  OutageRecorder(const Outage& outage, const record::Trajectory& reference, const Eigen::Vector3d& lever_arm_b,
                 const estimate::Mission& mission);
  void add(const record::TrajectoryEpoch& epoch);
  [[nodiscard]] OutageErrors errors() const;

 private:
  void compare_with_fixes(const record::TrajectoryEpoch& epoch);

  Outage outage_;
  geo::GpsTime next_used_fix_;
  const record::Trajectory& reference_;
  Eigen::Vector3d lever_arm_b_;
  const estimate::Mission& mission_;
  std::optional<record::TrajectoryEpoch> previous_;
  std::optional<ErrorSample> end_;
  std::vector<ErrorSample> series_;
  std::size_t next_fix_ = 0;
  std::optional<double> gnss_horizontal_max_m_;
};

/// The solution without outages, thinned to ten epochs per second: the reference for outages if there is no other.
class GapFreeReference {
 public:
  void add(const record::TrajectoryEpoch& epoch);
  [[nodiscard]] const record::Trajectory& trajectory() const { return trajectory_; }

 private:
  record::Trajectory trajectory_;
};

/// One outage every `every_s` seconds (the first after `first_s` of the mission), of each duration, none longer than a quarter
/// of the mission and none beyond its end.
struct OutageSweep {
  double every_s = 60.0;
  double first_s = 60.0;
  std::vector<double> durations_s;
  int satellites_left = 0;
};
[[nodiscard]] std::vector<Outage> outages_of(const OutageSweep& sweep, geo::GpsTime from, geo::GpsTime to);

}  // namespace coast::study
