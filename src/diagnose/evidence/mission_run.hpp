#pragma once
// One run of the mission and its evidence for the hypotheses; private to the room.

#include <memory>
#include <optional>

#include "coast/diagnose/diagnosis.hpp"
#include "coast/study/outage.hpp"

namespace coast::diagnose {

/// All data of one run. Not movable: the hypotheses refer to its mission.
class MissionRun {
 public:
  MissionRun(MissionInput input, Grade grade, const std::vector<EffectPtr>& suggested, const study::Progress& progress);

  [[nodiscard]] const study::PreparedMission& prepared() const { return mission_; }
  [[nodiscard]] const estimate::Mission& mission() const { return mission_.mission(); }
  [[nodiscard]] const study::Solution& solution() const { return solution_; }
  [[nodiscard]] const estimate::StateLayout& layout() const { return solution_.filter->layout(); }
  [[nodiscard]] const Hypotheses& hypotheses() const { return hypotheses_; }
  [[nodiscard]] const std::vector<record::NavState>& path() const { return path_; }
  [[nodiscard]] double log_likelihood() const { return solution_.forward.log_likelihood; }
  [[nodiscard]] Fit fit() const;
  /// take(sample, its end, signals along the smoothed trajectory), for every sample covered by the trajectory.
  template <typename Take>
  void for_each_sample(const Take& take) const {
    const std::vector<record::ImuSample>& samples = mission().imu.samples;
    auto at = path_.begin();
    for (std::size_t i = 0; i < samples.size() && at != path_.end(); ++i) {
      const record::ImuSample& sample = samples[i];
      while (at != path_.end() && at->t < sample.t) ++at;
      if (at == path_.end() || sample.t < path_.front().t) continue;
      take(i, sample.t, hypotheses_.signals({i, sample.dtheta / sample.dt, sample.dv / sample.dt, *at}));
    }
  }

 private:
  study::PreparedMission mission_;
  std::vector<record::NavState> path_;  ///< smoothed, at IMU epochs
  study::GapFreeReference gap_free_;
  study::Solution solution_;
  Hypotheses hypotheses_;
};

[[nodiscard]] inline std::string axis_letter(int axis) {
  return {static_cast<char>('x' + axis)};
}

/// Log-likelihood if the filter fails: finite, so that differences are numbers.
inline constexpr double kBroken = -1e6;

/// A forward run only, from the start in the input; none if the filter fails.
[[nodiscard]] std::optional<estimate::FilterResult> forward(MissionInput input);

}  // namespace coast::diagnose
