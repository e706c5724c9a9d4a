// The solution, and everything that receives its epochs.

#include <algorithm>

#include "process/background_sink.hpp"
#include "process/event_results.hpp"
#include "process/gnss_course.hpp"
#include "process/page/curves.hpp"
#include "process/scores.hpp"
#include "process/stages.hpp"
#include "process/verdict.hpp"

namespace coast::jobs {

estimate::FilterOptions Work::options() const {
  estimate::FilterOptions options = mission.options();
  for (const study::Outage& gap : outages) options.withheld.push_back(gap.span());
  return options;
}

std::vector<study::Outage> outages_of(const RunConfig& config, geo::GpsTime start, geo::GpsTime end) {
  std::vector<study::Outage> outages;
  for (const OutageSeconds& outage : config.outages) {
    const geo::GpsTime at = geo::GpsTime::from_week(start.week(), outage.start_s);
    if (at < start || at > end)
      throw InputError({config.file.string(), 0, fmt::format("an outage starts at {:.3f} s", outage.start_s),
                        fmt::format("a time within the mission, {:.3f} to {:.3f} s", start.sow(), end.sow()), ""});
    outages.push_back({at, outage.duration_s, outage.satellites_left});
  }
  return outages;
}

EarlierPasses earlier_passes(const Work& work, const estimate::FilterOptions& options) {
  EarlierPasses passes;
  if (work.config.passes > 1) passes.carried = study::carried_start(work.mission, options, work.config.passes, work.progress);
  if (work.config.combined) passes.backward = study::backward_knots(work.mission, options, work.sampling, work.progress);
  return passes;
}

namespace {

study::Solution solve_with(const Work& work, const estimate::FilterOptions& options, const EarlierPasses& passes,
                           const study::SolutionOutputs& outputs) {
  return study::solve(work.mission, options, work.config.smooth, outputs, work.progress, passes.carried,
                      passes.backward ? &*passes.backward : nullptr);
}

/// The receivers of a solution's epochs, each on its own thread.
class Audience {
 public:
  Audience(const Work& work, const study::Truth& truth, const TrajectorySinks& sinks, TrajectoryCurves& curves);
  [[nodiscard]] study::SolutionOutputs outputs();
  /// Returns after all have processed their epochs.
  void finish();
  [[nodiscard]] const Scores& forward_scores() const { return forward_scores_; }
  [[nodiscard]] const Scores& scores() const { return scores_; }
  /// Sets the results collected from the solution.
  void give(Delivery& delivery);

 private:
  void deliver(record::TrajectoryEpoch epoch);

  const Work& work_;
  bool keeps_gap_free_;
  GnssCourse gnss_;
  MotionChecks motion_;
  KnotStates knots_;
  study::GapFreeReference gap_free_;
  std::optional<study::MarkedStates> marked_;  ///< from the first delivered epoch on: with a smoother the offset is known then
  std::optional<int> offset_state_;            ///< of the time offset
  double time_offset_s_;                       ///< of the fixes, as known so far
  Scores forward_scores_, scores_;
  BackgroundSink write_forward_, draw_forward_, write_, draw_;
};

/// Which state of the filter the time offset of the fixes is, if it is one.
std::optional<int> time_offset_state(const Work& work) {
  return estimate::StateLayout(work.mission.setup().model, work.mission.mission().C_s_b, work.options().auxiliary)
      .time_offset();
}

record::EpochSink or_nothing(const record::EpochSink& sink) {
  return sink ? sink : [](const record::TrajectoryEpoch&) {};
}

Audience::Audience(const Work& work, const study::Truth& truth, const TrajectorySinks& sinks, TrajectoryCurves& curves)
    : work_(work),
      keeps_gap_free_(work.outages.empty() && work.config.sweep && !work.reference),
      gnss_(work.mission.mission()),
      motion_(work.mission.mission()),
      knots_(work.sampling),
      offset_state_(time_offset_state(work)),
      time_offset_s_(work.mission.mission().time_offset_s),
      forward_scores_(truth.trajectory, truth.lever_arm_b, work.reference.has_value(), work.outages, work.mission.mission(),
                      work.start()),
      scores_(truth.trajectory, truth.lever_arm_b, work.reference.has_value(), work.outages, work.mission.mission(),
              work.start()),
      write_forward_(or_nothing(sinks.forward)),
      draw_forward_([this, &curves](const record::TrajectoryEpoch& epoch) {
        curves.add_forward(epoch);
        forward_scores_.add(epoch);
      }),
      write_(or_nothing(sinks.delivered)),
      draw_([this, &curves](const record::TrajectoryEpoch& epoch) {
        curves.add_smoothed(epoch);
        scores_.add(epoch);
        motion_.add(epoch);
        if (!marked_) marked_ = marked_states(work_, time_offset_s_);
        if (marked_) marked_->add(epoch);
        if (keeps_gap_free_) gap_free_.add(epoch);
      }) {
  if (work.config.tight) gnss_.add_all_but(work.options().withheld);
}

void Audience::deliver(record::TrajectoryEpoch epoch) {
  epoch.gnss = gnss_.at(epoch.nav.t);
  write_.add(epoch);
  draw_.add(epoch);
}

study::SolutionOutputs Audience::outputs() {
  study::SolutionOutputs outputs;
  outputs.measurements = [this](const estimate::Measurement& what, bool used) { gnss_.add(what, used); };
  outputs.forward = [this](const record::TrajectoryEpoch& epoch) {
    write_forward_.add(epoch);
    draw_forward_.add(epoch);
    if (!work_.config.smooth) deliver(epoch);
  };
  if (work_.config.smooth) outputs.smoothed = [this](const record::TrajectoryEpoch& epoch) { deliver(epoch); };
  outputs.at_knots = [this](const estimate::FilterState& state) {
    knots_.add(state);
    if (offset_state_ && work_.config.smooth) time_offset_s_ = work_.mission.mission().time_offset_s + state.x(*offset_state_);
  };
  outputs.states = work_.sampling;
  return outputs;
}

void Audience::finish() {
  for (BackgroundSink* sink : {&write_forward_, &draw_forward_, &write_, &draw_}) sink->finish();
}

void Audience::give(Delivery& delivery) {
  delivery.forward_knots = std::move(knots_).knots();
  delivery.motion = motion_.checks();
  delivery.gap_free = std::move(gap_free_);
  if (marked_) {
    marked_->finish();
    delivery.marked = std::move(marked_);
  }
}

// The state of the offset is relative to the offset found by the preparation.
void note_time_offset(double prepared, ProcessResult& result) {
  result.time_offset_s = prepared;
  const auto track = std::ranges::find(result.states, "gnss_time_offset", &StateTrack::name);
  if (track == result.states.end() || track->forward.empty()) return;
  const bool smoothed = !track->smoothed.empty();
  result.time_offset_s += smoothed ? track->smoothed.back() : track->forward.back();
  result.time_offset_sd_s = smoothed ? track->smoothed_sd.back() : track->forward_sd.back();
}

void note_scores(const Work& work, const Scores& forward, const Scores& smoothed, ProcessResult& result) {
  result.compared_with = work.reference ? "reference" : "gap_free_run";
  if (work.reference) {
    result.reference =
        AgainstReference{forward.errors(), std::nullopt, work.reference->has_velocity, work.reference->has_attitude};
    if (work.config.smooth) result.reference->smoothed = smoothed.errors();
  }
  for (std::size_t i = 0; i < work.outages.size(); ++i) {
    result.outages.push_back({work.outages[i], forward.outage(i), std::nullopt});
    if (work.config.smooth) result.outages.back().smoothed = smoothed.outage(i);
  }
}

}  // namespace

study::GapFreeReference solve_without_outages(const Work& work) {
  study::GapFreeReference gap_free;
  if (work.outages.empty() || work.reference) return gap_free;
  study::SolutionOutputs outputs;
  (work.config.smooth ? outputs.smoothed : outputs.forward) = [&](const auto& epoch) { gap_free.add(epoch); };
  const estimate::FilterOptions& options = work.mission.options();
  static_cast<void>(solve_with(work, options, earlier_passes(work, options), outputs));
  return gap_free;
}

Delivery deliver(const Work& work, const EarlierPasses& passes, const study::GapFreeReference& gap_free,
                 const TrajectorySinks& sinks, ProcessResult& result) {
  const auto curves = std::make_shared<TrajectoryCurves>(work.mission.start().nav);
  const study::Truth truth =
      work.reference ? study::Truth{*work.reference, work.config.reference_lever_arm_b} : study::Truth{gap_free.trajectory()};
  Audience audience(work, truth, sinks, *curves);
  Delivery delivery;
  delivery.solution = solve_with(work, work.options(), passes, audience.outputs());
  audience.finish();
  audience.give(delivery);
  const study::Solution& solution = delivery.solution;
  result.curves = curves;
  result.innovations = std::move(delivery.solution.forward.innovations);
  result.jumps = solution.forward.jumps;
  result.events.insert(result.events.end(), solution.forward.events.begin(), solution.forward.events.end());
  result.batch = std::move(delivery.solution.batch);
  count_innovations(work, result);
  count_aids(work, result);
  note_scores(work, audience.forward_scores(), audience.scores(), result);
  result.states = state_tracks(solution.filter->layout(), result.start, delivery.forward_knots, solution.smoothed);
  if (const auto event = unseen_base_offset(result.states)) result.events.push_back(*event);
  note_time_offset(work.mission.mission().time_offset_s, result);
  if (delivery.marked) note_events(work, *delivery.marked, result);
  return delivery;
}

}  // namespace coast::jobs
