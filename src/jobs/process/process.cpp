// The sequence of the stages.

#include "coast/jobs/process.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coast/parallel.hpp"
#include "process/page/curves.hpp"
#include "process/stages.hpp"
#include "process/trajectory_output.hpp"
#include "process/verdict.hpp"
#include "run_file/recordings.hpp"

namespace coast::jobs {

namespace {

// The time shift found from turns is a candidate for the filter, no advice: with fixes a second apart it is sometimes false.
void leave_time_to_the_filter(const RunConfig& config, Recordings& recordings, study::Setup& setup) {
  constexpr double kAgrees = 0.3;    // s
  constexpr double kNothing = 0.15;  // s: the state of the offset estimates as much
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

// If no start is found, a mistake that would explain it is reported with the reason.
std::unique_ptr<study::PreparedMission> prepare(Recordings& recordings, const study::Setup& setup,
                                                const study::Excerpt& excerpt, const Progress& progress) {
  try {
    return std::make_unique<study::PreparedMission>(std::move(recordings.imu), std::move(recordings.gnss), setup, progress);
  } catch (const NumericalError& error) {
    const std::string cause = told(study::rank_causes(excerpt, setup));
    if (cause.empty()) throw;
    throw NumericalError("start", "", fmt::format("{} Most likely cause: {}", error.what(), cause));
  }
}

/// An antenna elsewhere is known better from the run, which has found it in the whole recording and by several passes.
void tell_found_antenna(const Work& work, const ProcessResult& result, std::vector<study::Cause>& causes) {
  const auto is_found = [](const record::Event& event) { return event.kind == "lever_arm_contradicted"; };
  if (std::ranges::none_of(result.events, is_found)) return;
  const Eigen::Vector3d& l = work.mission.mission().lever_arm_b;
  for (study::Cause& cause : causes) {
    if (!cause.what.starts_with("the lever")) continue;
    cause.what =
        fmt::format("the lever arm, which is ({:.2f}, {:.2f}, {:.2f}) m in this recording, as was used", l.x(), l.y(), l.z());
    cause.remedy = fmt::format("`imu: {{lever_arm_m: [{:.3f}, {:.3f}, {:.3f}]}}`", l.x(), l.y(), l.z());
  }
}

void judge_result(const Work& work, Delivery& delivery, const study::Excerpt& excerpt, const study::Setup& stated,
                  ProcessResult& result) {
  doubt_lever_arm(work, result);
  std::vector<Check> checks = std::move(delivery.motion);
  if (auto check = sensor_check(delivery.solution.filter->layout(), delivery.solution.forward.last.x))
    checks.push_back(std::move(*check));
  Judgement& verdict = result.verdict = judge(result, std::move(checks));
  verdict.accepted = work.config.accept;
  if (verdict.standing() == Standing::kGood || verdict.names_its_cause()) return;
  work.progress("looking for the cause", 0.0);
  verdict.causes = study::rank_causes(excerpt, stated);
  tell_found_antenna(work, result, verdict.causes);
  if (const std::string cause = told(verdict.causes); !cause.empty()) verdict.likely_cause = cause;
  if (auto check = misreading_check(verdict.causes)) verdict.checks.push_back(std::move(*check));
}

}  // namespace

ProcessResult process(const RunConfig& config, Recordings recordings, const TrajectorySinks& sinks, const Progress& progress) {
  study::Setup setup = setup_of(config, recordings, config.sweep);
  setup.unstated = config.setup.unstated;
  leave_time_to_the_filter(config, recordings, setup);
  tell_inspection(recordings, progress);
  refuse_wrong_axes(config, recordings);
  refuse_wrong_units(config, recordings);
  take_out_effects(config, recordings, setup, progress);
  const study::Excerpt excerpt = study::excerpt_of(recordings.imu, recordings.gnss);

  ProcessResult result = what_was_read(recordings);
  const std::unique_ptr<study::PreparedMission> mission = prepare(recordings, setup, excerpt, progress);
  if (progress.say)
    for (const record::Event& event : mission->adaptations()) progress.say(event.text);
  const geo::GpsTime start = mission->start().nav.t, end = mission->mission().imu.samples.back().t;
  const Work work{config,   *mission,        recordings.reference, outages_of(config, start, end), knot_sampling(end - start),
                  progress, recordings.marks};
  describe_mission(work, result);
  describe_projection(work, result);

  const study::GapFreeReference gap_free = solve_without_outages(work);
  // They temporarily reverse the recordings, so nothing may run concurrently.
  EarlierPasses passes = earlier_passes(work, work.options());
  Delivery delivery;
  coast::parallel_invoke([&] { delivery = deliver(work, passes, gap_free, sinks, result); },
                         [&] {
                           constexpr double kPriorSd = 0.5;  // m: large compared with errors of a tape measure
                           if (mission->mission().gnss.fixes.size() > 10)
                             result.lever_arm = study::check_lever_arm(*mission, kPriorSd, {});
                         });
  passes.backward.reset();
  offer_gnss_noise(work, result);
  study_sweep(work, delivery, passes, result);
  result.separations = separate_forward_and_backward(work, delivery, passes.carried.has_value());
  judge_result(work, delivery, excerpt, setup, result);
  note_last_state(work, delivery, result);
  note_estimates(work, result);
  result.resolved = config.root.resolved_yaml();
  result.used = mission->setup();
  result.used.carrier.reset();
  result.fixes = mission->mission().gnss.fixes;
  return result;
}

ProcessedMission process(const RunConfig& config, Recordings recordings, const Progress& progress,
                         const TrajectorySinks& also) {
  ProcessedMission mission;
  TrajectoryOutput forward(config.output, [&](const record::TrajectoryEpoch& epoch) { mission.forward.push_back(epoch); });
  TrajectoryOutput delivered(config.output, [&](const record::TrajectoryEpoch& epoch) { mission.delivered.push_back(epoch); });
  const auto both = [](TrajectoryOutput& output, const record::EpochSink& other) {
    return [&output, &other](const record::TrajectoryEpoch& epoch) {
      output.add(epoch);
      if (other) other(epoch);
    };
  };
  const TrajectorySinks sinks{both(forward, also.forward), both(delivered, also.delivered)};
  mission.result = process(config, std::move(recordings), sinks, progress);
  return mission;
}

}  // namespace coast::jobs
