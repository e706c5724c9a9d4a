#include "commands.hpp"

#include <fmt/format.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "background_sink.hpp"
#include "coast/io/results_folder.hpp"
#include "coast/io/writers.hpp"
#include "coast/noise/chi_square.hpp"
#include "coast/report/render.hpp"
#include "coast/study/causes.hpp"
#include "coast/study/outage_runs.hpp"
#include "gnss_course.hpp"
#include "load.hpp"
#include "process_page.hpp"
#include "process_result.hpp"
#include "progress.hpp"
#include "run_config.hpp"
#include "scores.hpp"
#include "state_tracks.hpp"
#include "summary.hpp"
#include "trajectory_output.hpp"

namespace coast::cli {

namespace {

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
           "horizontally and {:.2g} vertically, and errors of {:.2g} and {:.2g} m that last {:.2g} s beside them. Set "
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

void ProcessRun::check_lever_arm() {
  constexpr double kPriorSd = 0.5;  // m: wide against what a tape measure misses
  if (mission_.mission().gnss.fixes.size() > 10) result_.lever_arm = study::check_lever_arm(mission_, kPriorSd, {});
}

// Where innovations are too large, so are the sigmas of what they show too small.
void ProcessRun::doubt_lever_arm() {
  constexpr double kSigmas = 6.0;
  constexpr double kLeast = 0.15;      // m
  constexpr double kObservable = 0.2;  // m
  if (!result_.lever_arm || mission_.options().auxiliary.lever_arm_sd_m > 0.0 || !(result_.nis.expected > 0.0)) return;
  const double excess = std::sqrt(std::max(1.0, result_.nis.mean / result_.nis.expected));
  const Eigen::Vector3d& difference = result_.lever_arm->difference_m;
  const Eigen::Vector3d sd = excess * result_.lever_arm->sd_m;
  bool contradicted = false;
  for (Eigen::Index i = 0; i < 3; ++i)
    contradicted |= sd(i) < kObservable && std::abs(difference(i)) > std::max(kLeast, kSigmas * sd(i));
  if (!contradicted) return;
  const Eigen::Vector3d& stated = mission_.setup().lever_arm_b;
  const Eigen::Vector3d found = stated + difference;
  result_.events.push_back(
      {record::Event::Severity::kWarning, "lever_arm_contradicted",
       fmt::format(
           "The recording shows the antenna at ({:.2f}, {:.2f}, {:.2f}) m +- ({:.2f}, {:.2f}, {:.2f}), forward right down "
           "of the IMU; the file says ({:.2f}, {:.2f}, {:.2f}). Measure it again, or set `imu.lever_arm_m: [{:.2f}, {:.2f}, "
           "{:.2f}]`.",
           found.x(), found.y(), found.z(), sd.x(), sd.y(), sd.z(), stated.x(), stated.y(), stated.z(), found.x(), found.y(),
           found.z()),
       std::nullopt, 1});
}

void ProcessRun::judge() {
  doubt_lever_arm();
  std::vector<Check> checks = motion_.checks();
  const estimate::FilterState& last = solution_.forward.last;
  if (auto check = sensor_check(solution_.filter->layout(), last.x)) checks.push_back(std::move(*check));
  result_.verdict = cli::judge(result_, std::move(checks));
  if (result_.verdict.standing() != Standing::kGood && !result_.verdict.only_jumps()) rank_causes();
  result_.verdict.accepted = config_.accept;
}

void ProcessRun::rank_causes() {
  progress_("looking for the cause", 0.0);
  result_.verdict.causes = study::rank_causes(excerpt_, setup_);
  if (const std::string cause = told(result_.verdict.causes); !cause.empty()) result_.verdict.likely_cause = cause;
}

void ProcessRun::separate_forward_and_backward() {
  SeparationRecorder recorder(forward_knots_.knots());
  // Multi-pass shows the separation of two filters that have both converged.
  const estimate::FilterState& last = solution_.forward.last;
  mission_.run_backward(
      options_with_outages(), carried_ ? last : mission_.far_end(last),
      [&](const estimate::FilterState& state) { recorder.add(state); }, progress_);
  result_.separations = std::move(recorder).in_order();
}

namespace {

std::string drift_factors(const study::DriftFactors& drift) {
  if (drift.largest() == 1.0) return "";
  const auto three = [](const Eigen::Vector3d& v) { return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v.x(), v.y(), v.z()); };
  return fmt::format(", drift_factors: {{gyro: {}, accel: {}}}", three(drift.gyro), three(drift.accel));
}

}  // namespace

// What the run found stands in the resolved file as comments, ready to be stated in another run.
void ProcessRun::note_estimates() const {
  if (mission_.options().auxiliary.time_offset_sd_s > 0.0 || mission_.mission().time_offset_s != config_.setup.time_offset_s)
    config_.root.at("gnss").note_estimated("time_offset_s", fmt::format("{:.17g}", mission_.mission().time_offset_s));
  const Eigen::Vector3d& arm = mission_.mission().lever_arm_b;
  if (mission_.options().auxiliary.lever_arm_sd_m > 0.0)
    config_.root.at("imu").note_estimated("lever_arm_m", fmt::format("[{:.17g}, {:.17g}, {:.17g}]", arm.x(), arm.y(), arm.z()));
  if (!result_.noise_fit) return;
  const estimate::NoiseAdjustment& a = result_.noise_fit->adjustment;
  const estimate::NoiseFitChoice& choice = *mission_.setup().noise_fit;
  if (choice.imu_white_noise)
    config_.root.at("imu").note_estimated(
        "noise",
        fmt::format("{{gyro_factor: {:.17g}, accel_factor: {:.17g}{}{}}}", a.gyro_factor, a.accel_factor,
                    drift_factors(mission_.drift()), mission_.gain_errors_left_out() ? ", without_gain_errors: true" : ""));
  if (choice.gnss_scale)
    config_.root.at("gnss").note_estimated(
        "noise",
        fmt::format("{{scale_horizontal: {:.17g}, scale_vertical: {:.17g}, scale_velocity: {:.17g}, correlated_horizontal_m: "
                    "{:.17g}, correlated_vertical_m: {:.17g}, correlated_time_s: {:.17g}}}",
                    a.gnss_scale.horizontal, a.gnss_scale.vertical, a.gnss_scale.velocity, a.correlated_gnss.horizontal_m,
                    a.correlated_gnss.vertical_m, a.correlated_gnss.time_s));
}

std::string ProcessRun::write_results() {
  progress_("writing", 0.0);
  note_estimates();
  const std::string resolved = config_.root.resolved_yaml();
  io::write_text(out_ / "run.resolved.yaml", resolved);
  io::write_text(out_ / "innovations.csv", innovations_csv(result_.innovations));
  const report::Page page = make_page({config_, result_, mission_, curves_, resolved});
  io::write_text(out_ / "report.json", report::to_json(page));
  io::write_text(out_ / "report.html", report::render(page));
  io::write_text(out_ / "summary.json", summary_json(result_));
  return summary_text(result_);
}

// What turns tell of the times is a candidate for the filter, not advice: with fixes a second apart it is now and then false.
void leave_time_to_the_filter(const RunConfig& config, Recordings& recordings, study::Setup& setup) {
  constexpr double kAgrees = 0.3;    // s
  constexpr double kNothing = 0.15;  // s: the state of the offset finds as much
  if (!recordings.time_shift_s) return;
  const double seen = -*recordings.time_shift_s;
  const bool left = config.setup.unstated.time_offset;
  if (left && std::abs(seen) >= kNothing) setup.unstated.time_offset_seen_s = seen;
  if (!left && std::abs(seen - config.setup.time_offset_s) > kAgrees) return;
  std::erase_if(recordings.inspection_events, [&](const record::Event& event) {
    if (event.kind != "time_shift" && event.kind != "leap_second_shift") return false;
    std::ranges::replace(
        recordings.inspection, event.text,
        fmt::format("Times: turns match best at a shift of {:+.2f} s, which the filter confirms or not.", seen));
    return true;
  });
}

// Where no start is found, a mistake that would explain it is told beside the reason.
std::unique_ptr<ProcessRun> prepare(const RunConfig& config, Recordings recordings, study::Setup setup,
                                    const study::Excerpt& excerpt, const std::filesystem::path& out,
                                    const study::Progress& progress) {
  const study::Setup stated = setup;
  try {
    return std::make_unique<ProcessRun>(config, std::move(recordings), std::move(setup), excerpt, out, progress);
  } catch (const NumericalError& error) {
    const std::string cause = told(study::rank_causes(excerpt, stated));
    if (cause.empty()) throw;
    throw NumericalError("start", "", fmt::format("{} Most likely cause: {}", error.what(), cause));
  }
}

}  // namespace

void process(const std::filesystem::path& run_yaml, const CommonOptions& options) {
  ProgressLine line(options.quiet);
  const study::Progress progress = line.stages();
  const RunConfig config = read_run_config(run_yaml);
  Recordings recordings = load(config, progress);
  std::vector<std::string> files = trajectory_files(config.output);
  for (const char* file : {"run.resolved.yaml", "summary.json", "innovations.csv", "report.json", "report.html"})
    files.emplace_back(file);
  const std::filesystem::path out = output_folder(run_yaml, options.out, files);
  line.clear();
  study::Setup setup = setup_of(config, recordings, config.sweep);
  setup.unstated = config.setup.unstated;
  leave_time_to_the_filter(config, recordings, setup);
  print_inspection(recordings, options.quiet);
  refuse_wrong_axes(config, recordings);
  take_out_effects(config, recordings, setup, progress);
  const study::Excerpt excerpt = study::excerpt_of(recordings.imu, recordings.gnss);
  const std::unique_ptr<ProcessRun> prepared = prepare(config, std::move(recordings), std::move(setup), excerpt, out, progress);
  ProcessRun& run = *prepared;
  line.clear();
  if (!options.quiet)
    for (const record::Event& event : run.adaptations()) fmt::print("{}\n", event.text);
  run.solve_without_outages();
  run.run_earlier_passes();
  tbb::parallel_invoke([&run] { run.solve_and_write(); }, [&run] { run.check_lever_arm(); });
  run.offer_gnss_noise();
  run.study_sweep();
  run.separate_forward_and_backward();
  run.judge();
  const std::string summary = run.write_results();
  line.clear();
  if (!options.quiet) fmt::print("{}\n{}report: {}\n", run.verdict().line(), summary, (out / "report.html").string());
  if (run.verdict().standing() == Standing::kUnusable && !config.accept)
    throw NumericalError(
        "the result contradicts its input", "",
        run.verdict().line() + ". Everything was written, marked as unusable; `accept: true` takes it as it is");
}

}  // namespace coast::cli
