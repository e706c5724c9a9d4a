#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "coast/study/causes.hpp"
#include "coast/study/outage_runs.hpp"
#include "load.hpp"
#include "process_page.hpp"
#include "process_result.hpp"
#include "run_config.hpp"
#include "scores.hpp"
#include "state_tracks.hpp"
#include "trajectory_output.hpp"

namespace coast::cli {

/// The run, stage by stage; each stage leaves its part in `result`.
class ProcessRun {
 public:
  ProcessRun(const RunConfig& config, Recordings recordings, study::Setup setup, const study::Excerpt& excerpt,
             std::filesystem::path out, const study::Progress& progress)
      : config_(config),
        excerpt_(excerpt),
        out_(std::move(out)),
        progress_(progress),
        result_(what_was_read(recordings)),
        reference_(std::move(recordings.reference)),
        setup_(std::move(setup)),
        mission_(std::move(recordings.imu), std::move(recordings.gnss), setup_, progress),
        curves_(mission_.start().nav),
        motion_(mission_.mission()),
        forward_knots_(mission_.mission().imu.samples.back().t - mission_.start().nav.t) {
    describe_input();
  }

  void solve_without_outages();
  void run_earlier_passes();
  void solve_and_write();
  void offer_gnss_noise();
  void study_sweep();
  void check_lever_arm();
  void separate_forward_and_backward();
  void judge();
  void rank_causes();
  [[nodiscard]] const Judgement& verdict() const { return result_.verdict; }
  [[nodiscard]] const record::Events& adaptations() const { return mission_.adaptations(); }
  /// summary.json, report.html, report.json, run.resolved.yaml. @return the lines for the terminal
  [[nodiscard]] std::string write_results();

 private:
  [[nodiscard]] static ProcessResult what_was_read(const Recordings& recordings);
  void describe_input();
  [[nodiscard]] std::vector<study::Outage> outages() const;
  [[nodiscard]] estimate::FilterOptions options_with_outages() const;
  [[nodiscard]] std::optional<estimate::FilterState> carried(const estimate::FilterOptions& options);
  [[nodiscard]] std::optional<estimate::BackwardKnots> backward(const estimate::FilterOptions& options);
  void add_writers(TrajectoryOutput& forward, TrajectoryOutput& delivered) const;
  void count_innovations();
  void note_time_offset(double prepared);
  void note_scores(const std::vector<study::Outage>& gaps, const Scores& forward, const Scores& smoothed);
  void note_estimates() const;
  void doubt_lever_arm();

  const RunConfig& config_;
  const study::Excerpt& excerpt_;  ///< as read
  std::filesystem::path out_;
  const study::Progress& progress_;
  ProcessResult result_;
  std::optional<record::Trajectory> reference_;
  study::Setup setup_;
  study::PreparedMission mission_;
  study::GapFreeReference gap_free_;                 ///< of the delivered solution
  std::optional<estimate::FilterState> carried_;     ///< start that the passes before the last left
  std::optional<estimate::BackwardKnots> backward_;  ///< of a combined solution
  study::Solution solution_;
  TrajectoryCurves curves_;
  MotionChecks motion_;
  KnotStates forward_knots_;
};

}  // namespace coast::cli
