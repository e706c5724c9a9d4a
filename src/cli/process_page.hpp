#pragma once
// The page of `coast process`: what a navigation engineer needs to accept or refuse a trajectory.

#include <filesystem>
#include <memory>
#include <string>

#include "coast/record/trajectory.hpp"
#include "coast/report/page.hpp"
#include "process_result.hpp"
#include "run_config.hpp"

namespace coast::cli {

/// Curves of the streamed trajectories, decimated as they come.
class TrajectoryCurves {
 public:
  /// @param start  origin of the local N, E, D frame and zero of the time axes
  explicit TrajectoryCurves(const record::NavState& start);
  ~TrajectoryCurves();
  void add_forward(const record::TrajectoryEpoch& epoch);
  void add_smoothed(const record::TrajectoryEpoch& epoch);

  struct Curves;
  [[nodiscard]] const Curves& curves() const { return *curves_; }

 private:
  std::unique_ptr<Curves> curves_;
};

/// What the page is made of.
struct ProcessPage {
  const RunConfig& config;
  const ProcessResult& result;
  const study::PreparedMission& mission;
  const TrajectoryCurves& curves;
  const std::string& resolved;  ///< run.resolved.yaml
};
[[nodiscard]] report::Page make_page(const ProcessPage& page);

}  // namespace coast::cli
