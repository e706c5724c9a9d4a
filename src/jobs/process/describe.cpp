// Description of a mission before its solution.

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "process/stages.hpp"
#include "process/trajectory_output.hpp"

namespace coast::jobs {

ProcessResult what_was_read(const Recordings& recordings) {
  ProcessResult result;
  const auto add = [&result](const record::Events& events) {
    result.events.insert(result.events.end(), events.begin(), events.end());
  };
  add(recordings.imu.events);
  add(recordings.gnss.events);
  for (const record::AidRecording& aid : recordings.aids) add(aid.events);
  if (recordings.reference) add(recordings.reference->events);
  if (recordings.marks) add(recordings.marks->events);
  add(recordings.inspection_events);
  result.inspection = recordings.inspection;
  result.imu_samples = recordings.imu.samples.size();
  result.imu_rate_hz = recordings.imu.rate_hz;
  for (const record::Event& event : recordings.imu.events)
    if (event.kind == "imu_gap") result.imu_gaps += event.count;
  return result;
}

void describe_mission(const Work& work, ProcessResult& result) {
  const estimate::Mission& mission = work.mission.mission();
  result.start = work.start();
  result.end = mission.imu.samples.back().t;
  result.alignment = work.mission.start().method;
  result.files = trajectory_files(work.config.output);
  result.noise_fit = work.mission.noise_fit();
  const record::Events& adaptations = work.mission.adaptations();
  result.events.insert(result.events.end(), adaptations.begin(), adaptations.end());
  const auto met = [&](geo::GpsTime tagged) {  // by the filter, within its tolerance
    constexpr double kTolerance = 2e-6;        // s
    const geo::GpsTime t = tagged - mission.time_offset_s;
    return t - result.start >= -kTolerance && t - result.end <= kTolerance;
  };
  std::map<record::FixQuality, std::size_t> counts;
  for (const record::GnssFix& fix : mission.gnss.fixes)
    if (met(fix.t)) ++counts[fix.quality];
  result.qualities.assign(counts.begin(), counts.end());
  for (const auto& [quality, count] : result.qualities) result.gnss_epochs += count;
  if (mission.carrier == nullptr) return;
  result.gnss_epochs =
      static_cast<std::size_t>(std::ranges::count_if(mission.carrier->epochs, [&](const auto& epoch) { return met(epoch.t); }));
}

namespace {

/// The first position outside of the area for which the CRS was made, and how many there are.
void tell_fixes_outside(const io::Projection& projection, const std::vector<record::GnssFix>& fixes, ProcessResult& result) {
  const record::GnssFix* first = nullptr;
  long outside = 0;
  for (const record::GnssFix& fix : fixes) {
    if (projection.covers(fix.r_ea_e)) continue;
    if (first == nullptr) first = &fix;
    ++outside;
  }
  if (first == nullptr) return;
  result.events.push_back({record::Event::Severity::kWarning, "outside_area_of_use",
                           fmt::format("{} of {} fixes are outside the area of use of {}. Is it the right zone?", outside,
                                       fixes.size(), projection.name()),
                           first->t, outside});
}

}  // namespace

void describe_projection(const Work& work, ProcessResult& result) {
  const std::shared_ptr<io::Projection>& projection = work.config.output.projection;
  if (!projection) return;
  const record::NavState& start = work.mission.start().nav;
  projection->choose(start.r_eb_e);
  for (const record::Event& event : projection->events()) {
    if (event.kind != "outside_area_of_use") result.events.push_back(event);
    if (event.severity == record::Event::Severity::kInfo && work.progress.say) work.progress.say(event.text);
  }
  tell_fixes_outside(*projection, work.mission.mission().gnss.fixes, result);
  for (const record::Event& event : result.events)
    if ((event.kind == "outside_area_of_use" || event.kind == "projection_grid") && work.progress.warn)
      work.progress.warn(event.text);
  result.projection = projection;
  result.projected_start = ProjectedStart{projection->at(start.r_eb_e, start.t), projection->convergence(start.r_eb_e, start.t),
                                          projection->scale(start.r_eb_e, start.t)};
  work.config.root.section("output")
      .section("projection")
      .note_estimated("transformation", fmt::format("\"{}\"", projection->operation()));
}

}  // namespace coast::jobs
