#pragma once

#include <vector>

#include "coast/jobs/process.hpp"
#include "coast/study/comparison.hpp"
#include "coast/study/outage.hpp"

namespace coast::jobs {

/// One solution compared with the reference and, in every outage, with the truth.
class Scores {
 public:
  Scores(const record::Trajectory& truth, const Eigen::Vector3d& lever_arm_b, bool is_reference,
         const std::vector<study::Outage>& outages, const estimate::Mission& mission, geo::GpsTime start)
      : is_reference_(is_reference),
        errors_(start),
        comparison_(truth, lever_arm_b, [this](const study::ErrorSample& e) { errors_.add(e); }) {
    for (const study::Outage& outage : outages) recorders_.emplace_back(outage, truth, lever_arm_b, mission);
  }
  Scores(const Scores&) = delete;
  Scores& operator=(const Scores&) = delete;
  void add(const record::TrajectoryEpoch& epoch) {
    if (is_reference_) comparison_.add(epoch);
    for (auto& recorder : recorders_) recorder.add(epoch);
  }
  [[nodiscard]] const ReferenceErrors& errors() const { return errors_; }
  [[nodiscard]] study::OutageErrors outage(std::size_t i) const { return recorders_[i].errors(); }

 private:
  bool is_reference_;
  ReferenceErrors errors_;
  study::Comparison comparison_;
  std::vector<study::OutageRecorder> recorders_;
};

}  // namespace coast::jobs
