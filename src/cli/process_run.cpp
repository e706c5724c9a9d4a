// The stages that compute: solutions, writers, outages.

#include "process_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "background_sink.hpp"
#include "coast/io/results_folder.hpp"
#include "coast/io/writers.hpp"
#include "coast/noise/chi_square.hpp"
#include "gnss_course.hpp"

namespace coast::cli {

ProcessResult ProcessRun::what_was_read(const Recordings& recordings) {
  ProcessResult result;
  const auto add = [&result](const record::Events& events) {
    result.events.insert(result.events.end(), events.begin(), events.end());
  };
  add(recordings.imu.events);
  add(recordings.gnss.events);
  if (recordings.reference) add(recordings.reference->events);
  add(recordings.inspection_events);
  result.inspection = recordings.inspection;
  result.imu_samples = recordings.imu.samples.size();
  result.imu_rate_hz = recordings.imu.rate_hz;
  for (const record::Event& event : recordings.imu.events)
    if (event.kind == "imu_gap") result.imu_gaps += event.count;
  return result;
}

void ProcessRun::describe_input() {
  const estimate::Mission& mission = mission_.mission();
  result_.start = mission_.start().nav.t;
  result_.end = mission.imu.samples.back().t;
  result_.alignment = mission_.start().method;
  result_.files = trajectory_files(config_.output);
  result_.noise_fit = mission_.noise_fit();
  result_.events.insert(result_.events.end(), adaptations().begin(), adaptations().end());
  const auto met = [&](geo::GpsTime tagged) {  // by the filter, to whose tolerance
    constexpr double kTolerance = 2e-6;        // s
    const geo::GpsTime t = tagged - mission.time_offset_s;
    return t - result_.start >= -kTolerance && t - result_.end <= kTolerance;
  };
  std::map<record::FixQuality, std::size_t> counts;
  for (const record::GnssFix& fix : mission.gnss.fixes)
    if (met(fix.t)) ++counts[fix.quality];
  result_.qualities.assign(counts.begin(), counts.end());
  for (const auto& [quality, count] : result_.qualities) result_.gnss_epochs += count;
  if (mission.carrier == nullptr) return;
  result_.gnss_epochs =
      static_cast<std::size_t>(std::ranges::count_if(mission.carrier->epochs, [&](const auto& epoch) { return met(epoch.t); }));
}

std::vector<study::Outage> ProcessRun::outages() const {
  std::vector<study::Outage> outages;
  for (const OutageSeconds& outage : config_.outages) {
    const geo::GpsTime start = geo::GpsTime::from_week(result_.start.week(), outage.start_s);
    if (start < result_.start || start > result_.end)
      throw InputError({config_.file.string(), 0, fmt::format("an outage starts at {:.3f} s", outage.start_s),
                        fmt::format("a time within the mission, {:.3f} to {:.3f} s", result_.start.sow(), result_.end.sow()),
                        ""});
    outages.push_back({start, outage.duration_s, outage.satellites_left});
  }
  return outages;
}

// The run that nothing is withheld from: what outages are measured against where there is no reference.
void ProcessRun::solve_without_outages() {
  if (config_.outages.empty() || reference_) return;
  study::SolutionOutputs outputs;
  (config_.smooth ? outputs.smoothed : outputs.forward) = [this](const auto& epoch) { gap_free_.add(epoch); };
  const std::optional<estimate::BackwardKnots> both = backward(mission_.options());
  static_cast<void>(study::solve(mission_, mission_.options(), config_.smooth, outputs, progress_, carried(mission_.options()),
                                 both ? &*both : nullptr));
}

std::optional<estimate::FilterState> ProcessRun::carried(const estimate::FilterOptions& options) {
  if (config_.passes == 1) return {};
  return study::carried_start(mission_, options, config_.passes, progress_);
}

std::optional<estimate::BackwardKnots> ProcessRun::backward(const estimate::FilterOptions& options) {
  if (!config_.combined) return {};
  return study::backward_knots(mission_, options, forward_knots_.sampling(), progress_);
}

estimate::FilterOptions ProcessRun::options_with_outages() const {
  estimate::FilterOptions options = mission_.options();
  for (const study::Outage& gap : outages()) options.withheld.push_back(gap.span());
  return options;
}

// They turn the recordings round for a while, so nothing may run beside them.
void ProcessRun::run_earlier_passes() {
  carried_ = carried(options_with_outages());
  backward_ = backward(options_with_outages());
}

void ProcessRun::add_writers(TrajectoryOutput& forward, TrajectoryOutput& delivered) const {
  for (const std::string& format : config_.output.formats) {
    if (format == "nav") forward.add_writer(io::make_nav_writer(out_ / "forward.nav"));
    delivered.add_writer(io::make_trajectory_writer(format, out_ / "trajectory", geoid_height(config_)));
  }
}

void ProcessRun::solve_and_write() {
  const std::vector<study::Outage> gaps = outages();
  const bool keep_gap_free = gaps.empty() && config_.sweep && !reference_;
  TrajectoryOutput forward_output(config_.output);
  TrajectoryOutput output(config_.output);
  add_writers(forward_output, output);

  const record::Trajectory& truth = reference_ ? *reference_ : gap_free_.trajectory();
  const Eigen::Vector3d arm = reference_ ? config_.reference_lever_arm_b : Eigen::Vector3d::Zero();
  Scores forward_scores(truth, arm, reference_.has_value(), gaps, mission_.mission(), result_.start);
  Scores scores(truth, arm, reference_.has_value(), gaps, mission_.mission(), result_.start);

  BackgroundSink write_forward([&](const record::TrajectoryEpoch& epoch) { forward_output.add(epoch); });
  BackgroundSink draw_forward([&](const record::TrajectoryEpoch& epoch) {
    curves_.add_forward(epoch);
    forward_scores.add(epoch);
  });
  BackgroundSink write([&](const record::TrajectoryEpoch& epoch) { output.add(epoch); });
  BackgroundSink draw([&](const record::TrajectoryEpoch& epoch) {
    curves_.add_smoothed(epoch);
    scores.add(epoch);
    motion_.add(epoch);
    if (keep_gap_free) gap_free_.add(epoch);
  });
  GnssCourse gnss(mission_.mission());
  if (config_.tight) gnss.add_all_but(options_with_outages().withheld);
  const auto deliver = [&](record::TrajectoryEpoch epoch) {
    epoch.gnss = gnss.at(epoch.nav.t);
    write.add(epoch);
    draw.add(epoch);
  };
  study::SolutionOutputs outputs;
  outputs.measurements = [&](const estimate::Measurement& what, bool used) { gnss.add(what, used); };
  outputs.forward = [&](const record::TrajectoryEpoch& epoch) {
    write_forward.add(epoch);
    draw_forward.add(epoch);
    if (!config_.smooth) deliver(epoch);
  };
  if (config_.smooth) outputs.smoothed = deliver;
  outputs.at_knots = [this](const estimate::FilterState& state) { forward_knots_.add(state); };
  outputs.states = forward_knots_.sampling();
  solution_ = study::solve(mission_, options_with_outages(), config_.smooth, outputs, progress_, carried_,
                           backward_ ? &*backward_ : nullptr);
  backward_.reset();
  for (BackgroundSink* sink : {&write_forward, &draw_forward, &write, &draw}) sink->finish();
  io::begin_results(out_ / "summary.json");
  forward_output.close();
  output.close();
  result_.innovations = std::move(solution_.forward.innovations);
  result_.jumps = solution_.forward.jumps;
  result_.events.insert(result_.events.end(), solution_.forward.events.begin(), solution_.forward.events.end());
  result_.batch = std::move(solution_.batch);
  count_innovations();
  note_scores(gaps, forward_scores, scores);
  result_.states = state_tracks(solution_.filter->layout(), result_.start, forward_knots_.knots(), solution_.smoothed);
  if (const auto event = unseen_base_offset(result_.states)) result_.events.push_back(*event);
  note_time_offset(mission_.mission().time_offset_s);
}

// The state of the offset is about the one that the preparation found.
void ProcessRun::note_time_offset(double prepared) {
  result_.time_offset_s = prepared;
  const auto track = std::ranges::find(result_.states, "gnss_time_offset", &StateTrack::name);
  if (track == result_.states.end() || track->forward.empty()) return;
  const bool smoothed = !track->smoothed.empty();
  result_.time_offset_s += smoothed ? track->smoothed.back() : track->forward.back();
  result_.time_offset_sd_s = smoothed ? track->smoothed_sd.back() : track->forward_sd.back();
}

void ProcessRun::note_scores(const std::vector<study::Outage>& gaps, const Scores& forward, const Scores& smoothed) {
  result_.compared_with = reference_ ? "reference" : "gap_free_run";
  if (reference_) {
    result_.reference = AgainstReference{forward.errors(), std::nullopt, reference_->has_velocity, reference_->has_attitude};
    if (config_.smooth) result_.reference->smoothed = smoothed.errors();
  }
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    result_.outages.push_back({gaps[i], forward.outage(i), std::nullopt});
    if (config_.smooth) result_.outages.back().smoothed = smoothed.outage(i);
  }
}

void ProcessRun::count_innovations() {
  // An error along the axis the filter knows least is refused from sqrt(threshold) of its sigma on.
  const double probability = mission_.options().gate_probability;
  const double gate = probability > 0.0 ? std::sqrt(noise::chi2_upper_quantile(3, probability)) : 0.0;
  std::vector<double> blind;
  for (const estimate::InnovationRecord& r : result_.innovations) {
    if (!estimate::is_position(r.kind)) continue;
    ++(r.used ? result_.gnss_used : result_.gnss_rejected);
    if (gate > 0.0 && r.largest_sd > 0.0) blind.push_back(r.largest_sd * gate);
  }
  if (!blind.empty()) {
    std::nth_element(blind.begin(), blind.begin() + static_cast<std::ptrdiff_t>(blind.size() / 2), blind.end());
    result_.smallest_refusable_m = blind[blind.size() / 2];
  }
  result_.nis = nis_of(result_.innovations);
}

// Of sigmas that do not fit it is said what would fit.
void ProcessRun::offer_gnss_noise() {
  constexpr double kFits = 1.25;        // rms of the innovations over their sigma, or its inverse
  constexpr std::size_t kFewest = 100;  // epochs; fewer say little
  constexpr double kWindow = 300.0;     // s
  const double ratio = std::sqrt(result_.nis.mean / result_.nis.expected);
  if (config_.tight) return;  // no fixes, no sigmas of fixes
  if (result_.noise_fit || result_.nis.epochs < kFewest || (ratio < kFits && ratio > 1.0 / kFits)) return;
  constexpr estimate::NoiseFitChoice kGnssAlone{.gnss_scale = true, .correlated_gnss = true, .imu_white_noise = false};
  const estimate::NoiseFit fit =
      mission_.fit(kGnssAlone, estimate::starting_point(mission_.options(), kGnssAlone), kWindow, progress_);
  const estimate::GnssScale& scale = fit.adjustment.gnss_scale;
  const estimate::CorrelatedGnss& correlated = fit.adjustment.correlated_gnss;
  result_.events.push_back(
      {record::Event::Severity::kWarning, "gnss_sigmas_do_not_fit",
       fmt::format(
           "Innovations are {:.2g} times their sigma. The first {:.0f} s are likeliest with the GNSS sigmas times {:.2g} "
           "horizontally and {:.2g} vertically, and errors of {:.2g} and {:.2g} m that last {:.3g} s beside them. Set "
           "`gnss.noise: estimated` to have this fitted and used, `imu.noise: estimated` where the IMU shakes.",
           ratio, std::min(kWindow, result_.end - result_.start), scale.horizontal, scale.vertical, correlated.horizontal_m,
           correlated.vertical_m, correlated.time_s),
       std::nullopt, 1});
}

void ProcessRun::study_sweep() {
  if (!config_.sweep || !config_.smooth) return;
  const record::Trajectory& truth = reference_ ? *reference_ : gap_free_.trajectory();
  const Eigen::Vector3d arm = reference_ ? config_.reference_lever_arm_b : Eigen::Vector3d::Zero();
  // What an outage of the sweep withholds must not have come in through the start that later passes carry.
  study::Solution single;
  if (carried_) single = study::solve(mission_, mission_.options(), true, {}, progress_);
  const estimate::KnotStore& knots = carried_ ? single.knots : solution_.knots;
  const std::vector<study::Outage> outages = study::outages_of(*config_.sweep, result_.start, result_.end);
  std::size_t done = 0;
  result_.sweep = study::run_outages(mission_, knots, {truth, arm}, outages, [&](std::size_t, const study::OutageResult&) {
    progress_("studying outages", static_cast<double>(++done) / static_cast<double>(outages.size()));
  });
}

}  // namespace coast::cli
