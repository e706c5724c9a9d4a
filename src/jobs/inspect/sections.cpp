#include "inspect/sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace coast::jobs {

namespace {

using Section = InspectResult::Section;

/// "from .. to .., one every .. s; 2 gaps, the longest 5.0 s"
template <class Records>
std::string span_of(const Records& records) {
  constexpr double kGap = 1.5;  // usual steps
  std::vector<double> steps;
  for (std::size_t i = 1; i < records.size(); ++i) steps.push_back(records[i].t - records[i - 1].t);
  std::string text = fmt::format("{} to {}", geo::to_string(records.front().t), geo::to_string(records.back().t));
  if (steps.empty()) return text;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  const double usual = *middle, longest = *std::ranges::max_element(steps);
  const auto gaps = std::ranges::count_if(steps, [&](double step) { return step > kGap * usual; });
  text +=
      fmt::format(", one every {:.4g} s; {}", usual,
                  gaps == 0 ? "no gap" : fmt::format("{} gap{}, the longest {:.2f} s", gaps, gaps == 1 ? "" : "s", longest));
  return text;
}

/// Measurements of one signal.
struct SignalNumbers {
  std::set<record::Satellite> satellites;
  long codes = 0, phases = 0, losses = 0, half_cycles = 0;
  double cn0 = 0.0;
  long with_cn0 = 0;
};

}  // namespace

Section messages_section(const std::vector<io::MessageCount>& messages) {
  Section section{"messages", {}};
  for (const io::MessageCount& message : messages)
    section.lines.push_back(fmt::format("{:8} {}", message.number, message.name));
  return section;
}

Section observations_section(const record::ObservationRecording& recording) {
  std::map<std::pair<record::SatelliteSystem, record::Signal>, SignalNumbers> signals;
  std::size_t fewest = 1000, most = 0;
  for (const record::ObservationEpoch& epoch : recording.epochs) {
    std::set<record::Satellite> satellites;
    for (const record::Observation& o : epoch.observations) {
      SignalNumbers& s = signals[{o.satellite.system, o.signal}];
      satellites.insert(o.satellite);
      s.satellites.insert(o.satellite);
      s.codes += o.code_m ? 1 : 0;
      s.phases += o.phase_cycles ? 1 : 0;
      s.losses += o.lost_lock ? 1 : 0;
      s.half_cycles += o.half_cycle ? 1 : 0;
      s.cn0 += o.cn0_dbhz.value_or(0.0);
      s.with_cn0 += o.cn0_dbhz ? 1 : 0;
    }
    fewest = std::min(fewest, satellites.size());
    most = std::max(most, satellites.size());
  }
  Section section{"observations", {}};
  if (!recording.marker.empty()) section.lines.push_back(fmt::format("marker {}", recording.marker));
  if (!recording.receiver.empty()) section.lines.push_back(fmt::format("receiver {}", recording.receiver));
  if (!recording.antenna.empty()) section.lines.push_back(fmt::format("antenna {}", recording.antenna));
  section.lines.push_back(fmt::format("{} epochs, {}", recording.epochs.size(), span_of(recording.epochs)));
  section.lines.push_back(fmt::format("{} to {} satellites at a time", fewest, most));
  for (const auto& [key, s] : signals) {
    std::string line =
        fmt::format("{:8} {}{}: {:3} satellites, {:7} codes, {:7} phases, losses of lock {:5}", name_of(key.first),
                    key.second.band, key.second.tracking, s.satellites.size(), s.codes, s.phases, s.losses);
    if (s.half_cycles > 0) line += fmt::format(", {} with half cycles unknown", s.half_cycles);
    if (s.with_cn0 > 0) line += fmt::format(", mean C/N0 {:.1f} dBHz", s.cn0 / static_cast<double>(s.with_cn0));
    section.lines.push_back(std::move(line));
  }
  return section;
}

Section navigation_section(const record::NavigationRecording& recording) {
  struct Numbers {
    std::set<record::Satellite> satellites, unhealthy;
    long ephemerides = 0;
    geo::GpsTime first = geo::GpsTime::from_nanoseconds(std::numeric_limits<std::int64_t>::max());
    geo::GpsTime last;
    void add(record::Satellite satellite, geo::GpsTime t, int health) {
      ++ephemerides;
      satellites.insert(satellite);
      if (health != 0) unhealthy.insert(satellite);
      first = std::min(first, t);
      last = std::max(last, t);
    }
  };
  std::map<record::SatelliteSystem, Numbers> systems;
  for (const auto& e : recording.kepler) systems[e.satellite.system].add(e.satellite, e.toe, e.health);
  for (const auto& e : recording.tabulated) systems[e.satellite.system].add(e.satellite, e.t, e.health);
  Section section{"navigation messages", {}};
  for (const auto& [system, n] : systems) {
    std::string line = fmt::format("{:8} {:3} satellites, {:5} ephemerides, {} to {}", name_of(system), n.satellites.size(),
                                   n.ephemerides, geo::to_string(n.first), geo::to_string(n.last));
    if (!n.unhealthy.empty()) {
      line += "; not healthy:";
      for (const record::Satellite satellite : n.unhealthy) line += fmt::format(" {}", to_string(satellite));
    }
    section.lines.push_back(std::move(line));
  }
  section.lines.emplace_back(recording.gps_ionosphere ? "ionosphere of Klobuchar" : "no ionosphere model");
  return section;
}

Section trajectory_section(const record::Trajectory& trajectory) {
  return {"trajectory",
          {fmt::format("{} epochs, {}", trajectory.states.size(), span_of(trajectory.states)),
           fmt::format("{}, {}", trajectory.has_velocity ? "with velocity" : "no velocity",
                       trajectory.has_attitude ? "with attitude" : "no attitude")}};
}

Section marks_section(const record::TimeMarkRecording& recording) {
  const auto with = [&](record::Edge edge) { return std::ranges::count(recording.marks, edge, &record::TimeMark::edge); };
  const std::string what =
      with(record::Edge::kNotStated) > 0
          ? fmt::format("{}", recording.marks.size())
          : fmt::format("{} rising and {} falling edges", with(record::Edge::kRising), with(record::Edge::kFalling));
  return {
      "time marks",
      {fmt::format("{}, {} to {}", what, geo::to_string(recording.marks.front().t), geo::to_string(recording.marks.back().t))}};
}

}  // namespace coast::jobs
