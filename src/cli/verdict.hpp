#pragma once
// What a result says of itself: checks against what GNSS, gravity and the error model say, and what follows from them.

#include <optional>
#include <string>
#include <vector>

#include "coast/estimate/forward_filter.hpp"
#include "coast/record/trajectory.hpp"
#include "coast/study/causes.hpp"

namespace coast::cli {

enum class Standing { kGood, kDoubtful, kUnusable };
[[nodiscard]] const char* name(Standing standing);

/// A number that is to be small.
struct Check {
  std::string name;
  double value = 0.0;
  double good = 0.0;                  ///< up to here
  std::optional<double> usable = {};  ///< up to here; absent: it alone makes no result unusable
  std::string text = {};              ///< the finding, in words
  [[nodiscard]] Standing standing() const;
};

struct Judgement {
  std::vector<Check> checks;
  std::string likely_cause = {};          ///< a sentence; empty where nothing failed or nothing explains it
  std::vector<study::Cause> causes = {};  ///< by likelihood, the likeliest first
  bool accepted = false;                  ///< by the configuration
  [[nodiscard]] Standing standing() const;
  /// Whether jumps of GNSS are all that is wrong: they are no mistake of the description.
  [[nodiscard]] bool only_jumps() const;
  /// "good: .." or the checks that failed and the likely cause, a line.
  [[nodiscard]] std::string line() const;
};

struct ProcessResult;

/// Watches a solution go by: its speed beside that of the fixes, its tilt beside the specific force at rest.
class MotionChecks {
 public:
  explicit MotionChecks(const estimate::Mission& mission);
  void add(const record::TrajectoryEpoch& epoch);
  /// Checks `distance_over_gnss` and `tilt_at_rest_deg`, where the recording has what they need.
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
    std::optional<double> tilt{};  ///< between it and what the attitude says, rad
  };
  std::vector<Leg> legs_;
  std::vector<Rest> rests_;
  std::size_t leg_ = 0, rest_ = 0;
  std::optional<geo::GpsTime> last_;
};

/// Sensor states at the end of the forward run against what the error model gives them beforehand: the largest in sigmas.
[[nodiscard]] std::optional<Check> sensor_check(const estimate::StateLayout& layout, const Eigen::VectorXd& x);

/// The likeliest cause and the next one, a sentence; empty where there is none.
[[nodiscard]] std::string told(const std::vector<study::Cause>& causes);

/// All checks of a run, and the likeliest cause of those that fail.
/// @param motion  of the delivered solution, and whatever else was checked
[[nodiscard]] Judgement judge(const ProcessResult& result, std::vector<Check> motion);

}  // namespace coast::cli
