// Section: estimated errors of the sensors, lever arm, time offset and mounting, in the units of data sheets.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coast/geo/units.hpp"
#include "coast/noise/error_model.hpp"
#include "process/page/parts.hpp"
#include "process/page/state_words.hpp"

namespace coast::jobs {

namespace {

/// States of one process on all axes of one sensor, or one group of auxiliary states: one panel.
struct Group {
  std::string key;  ///< "gyro random_constant 1"
  std::string title;
  std::vector<const StateTrack*> tracks;
  std::vector<std::string> labels;  ///< of the plots
  std::vector<std::string> units;   ///< candidates, coarsest first
};

/// "gyro_x misalignment" or "gyro_x misalignment of left" -> sensor, axis, process, member. Auxiliary states have no space in
/// their names.
void add_sensor_track(const StateTrack& track, std::vector<Group>& groups) {
  const std::size_t space = track.name.find(' ');
  const std::string block = track.name.substr(0, space);
  const std::size_t of = track.name.find(" of ", space);
  const std::string process = track.name.substr(space + 1, of == std::string::npos ? of : of - space - 1);
  const std::string whose = of == std::string::npos ? "" : track.name.substr(of);
  const bool gyro = block.starts_with("gyro");
  const std::string axis = block.substr(block.size() - 1);
  const std::string key = fmt::format("{} {}{}", gyro ? "gyro" : "accel", process, whose);
  const bool misalignment = process == "misalignment";
  // A second process of the same kind on an axis has its own group; the two misalignments of an axis are one group.
  const auto same = [&](const Group& g) {
    return g.key == key && (misalignment || std::ranges::find(g.labels, axis) == g.labels.end());
  };
  auto group = std::ranges::find_if(groups, same);
  if (group == groups.end()) {
    const auto earlier = std::ranges::count_if(groups, [&](const Group& g) { return g.key == key; });
    std::string title = fmt::format("{} {}", gyro ? "Gyro" : "Accelerometer", plain_name(process));
    if (earlier > 0) title += fmt::format(" {}", earlier + 1);
    title += whose;
    groups.push_back({key, std::move(title), {}, {}, units_of(process, gyro)});
    group = std::prev(groups.end());
  }
  std::string label = axis;
  if (misalignment) {  // first to the next axis (x -> y), then to the previous one
    const int from = axis[0] - 'x';
    const bool first = std::ranges::none_of(group->labels, [&](const std::string& l) { return l[0] == axis[0]; });
    label += static_cast<char>('x' + (from + (first ? 1 : 2)) % 3);
  }
  group->tracks.push_back(&track);
  group->labels.push_back(std::move(label));
}

/// Auxiliary states by the first part of their name.
struct Auxiliary {
  const char* prefix;
  const char* title;
  const char* unit;
  std::array<const char*, 3> labels;
};
constexpr Auxiliary kAuxiliaries[] = {
    {"lever_arm", "Lever arm, estimated minus configured", "m", {"forward", "right", "down"}},
    {"gnss_time_offset", "GNSS time offset, estimated minus configured", "ms", {"offset", "", ""}},
    {"vehicle_mounting", "Vehicle against body", "deg", {"pitch", "yaw", ""}},
    {"base_offset", "Offset of all GNSS positions", "m", {"x (ECEF)", "y (ECEF)", "z (ECEF)"}},
    {"gnss_error_horizontal", "Correlated GNSS error, horizontal", "m", {"N", "E", ""}},
    {"odometer", "Odometer scale, beside the one that was stated or found", "ppm", {"scale", "second", "third"}},
    {"heading", "Heading sensor, measured minus true", "deg", {"offset", "second", "third"}},
    {"height", "Height sensor, measured minus true", "m", {"offset", "drift", "second"}},
    {"gnss_error_vertical", "Correlated GNSS error, vertical", "m", {"D", "", ""}},
};

void add_auxiliary_track(const StateTrack& track, std::vector<Group>& groups) {
  for (const Auxiliary& a : kAuxiliaries) {
    if (!track.name.starts_with(a.prefix)) continue;
    auto group = std::ranges::find(groups, a.prefix, &Group::key);
    if (group == groups.end()) {
      groups.push_back({a.prefix, a.title, {}, {}, {a.unit}});
      group = std::prev(groups.end());
    }
    const std::size_t index = std::min<std::size_t>(group->tracks.size(), 2);
    group->tracks.push_back(&track);
    group->labels.emplace_back(a.labels[index]);
    return;
  }
  groups.push_back({track.name, track.name, {&track}, {track.name}, {}});
}

std::vector<Group> groups_of(const std::vector<StateTrack>& states) {
  std::vector<Group> groups;
  for (const StateTrack& track : states) {
    if (track.seconds.empty()) continue;
    if (track.name.find(' ') != std::string::npos)
      add_sensor_track(track, groups);
    else
      add_auxiliary_track(track, groups);
  }
  return groups;
}

/// From the estimates at the end.
const geo::Unit* unit_of(const Group& group) {
  double largest = 0.0;
  for (const StateTrack* t : group.tracks) largest = std::max({largest, std::abs(t->forward.back()), t->forward_sd.back()});
  return unit_for(group.units, largest);
}

std::vector<double> scaled(std::vector<double> values, double unit) {
  for (double& v : values) v /= unit;
  return values;
}

std::string id_of(const std::string& text) {
  std::string id = "state-";
  for (const char c : text) id += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '-';
  return id;
}

report::Panel state_panel(const ProcessPage& page, const Group& group, std::size_t index) {
  const geo::Unit* unit = unit_of(group);
  const double to_si = unit != nullptr ? unit->to_si : 1.0;
  report::Panel panel = report::stacked_time_panel(
      fmt::format("{}-{}", id_of(group.key), index), group.title, group.labels, unit != nullptr ? std::string(unit->name) : "",
      group.tracks.front()->smoothed.empty()
          ? "Settles and stays within its band: the motion has shown it."
          : "Forward settles within the band of smoothed; where the band stays as wide as at "
            "the start, the motion has not shown this error.");
  for (std::size_t i = 0; i < group.tracks.size(); ++i) {
    const StateTrack& t = *group.tracks[i];
    report::Plot& plot = panel.plots[i];
    plot.height_px = group.tracks.size() > 1 ? 110 : 160;  // the last one of a stack gets room for the time axis automatically
    const bool smoothed = !t.smoothed.empty();
    report::Line& forward =
        report::add_line(plot, "forward", curve(t.seconds, scaled(t.forward, to_si), scaled(t.forward_sd, to_si), 1.0, 4000),
                         report::Tone::kForward);
    if (!smoothed)
      forward.band_label = "1 sigma";
    else
      forward.series.band.reset();
    if (smoothed)
      report::add_line(plot, "smoothed", curve(t.seconds, scaled(t.smoothed, to_si), scaled(t.smoothed_sd, to_si), 1.0, 4000),
                       report::Tone::kSmoothed)
          .band_label = "1 sigma";
  }
  report::shade(panel, outage_intervals(page));
  // The forward filter is used after it has converged: the second half of the mission.
  show_bulk(panel, {0.01, 1.0, 0.5 * group.tracks.front()->seconds.back()});
  return panel;
}

/// Values at the end of the mission, where the forward filter has the same information as the smoother.
report::Table value_table(const std::vector<Group>& groups) {
  report::Table table;
  table.id = "sensor-errors";
  table.title = "Sensor errors at the end";
  table.caption =
      "In sensor axes; measured minus true. An estimate far below its sigma is not significantly different from zero.";
  table.columns = {{"error", "", false}, {"component", "", false}, {"value", ""},
                   {"sigma", ""},        {"sigma at start", ""},   {"unit", "", false}};
  for (const Group& group : groups) {
    const geo::Unit* unit = unit_of(group);
    const double to_si = unit != nullptr ? unit->to_si : 1.0;
    for (std::size_t i = 0; i < group.tracks.size(); ++i) {
      const StateTrack& t = *group.tracks[i];
      table.rows.push_back(
          cells({group.title, group.labels[i], number(t.forward.back() / to_si), number(t.forward_sd.back() / to_si, 2),
                 number(t.forward_sd.front() / to_si, 2), unit != nullptr ? std::string(unit->name) : ""}));
    }
  }
  return table;
}

/// The error model in data sheet units, as used (including fitted noise).
report::Table model_table(const noise::ImuErrorModel& model) {
  report::Table table;
  table.id = "error-model";
  table.title = "Error model as used";
  table.caption = "White noise as density (random walk of angle and velocity); bias as prior sigma of all additive processes.";
  table.columns = {{"axis", "", false},
                   {"gyro noise", "deg/sqrt(h)"},
                   {"gyro bias", "deg/h"},
                   {"accel. noise", "ug/sqrt(Hz)"},
                   {"accel. noise", "m/s/sqrt(h)"},
                   {"accel. bias", "mg"}};
  for (int axis = 0; axis < 3; ++axis) {
    const double gyro = std::sqrt(model.white_density(noise::Sensor::kGyro, axis).value);
    const double accel = std::sqrt(model.white_density(noise::Sensor::kAccel, axis).value);
    table.rows.push_back(cells({std::string(1, static_cast<char>('x' + axis)), number(gyro / geo::unit("deg/sqrt(h)").to_si),
                                number(model.bias_sd(noise::Sensor::kGyro, axis) / geo::unit("deg/h").to_si),
                                number(accel / geo::unit("ug/sqrt(Hz)").to_si), number(accel / geo::unit("m/s/sqrt(h)").to_si),
                                number(model.bias_sd(noise::Sensor::kAccel, axis) / geo::unit("mg").to_si)}));
  }
  return table;
}

report::Table lever_arm_table(const ProcessPage& page) {
  const auto& [difference, sd] = *page.result.lever_arm;
  const Eigen::Vector3d& configured = page.result.used.lever_arm_b;
  report::Table table;
  table.id = "lever-arm";
  table.title = "Lever arm check";
  table.caption =
      "Left free by half a metre in a run of its own. Turns show forward and right; down needs rolling or pitching motion, and "
      "otherwise keeps a large sigma.";
  table.columns = {{"component", "", false}, {"configured", "m"}, {"estimated minus configured", "m"}, {"sigma", "m"}};
  const std::array<const char*, 3> names{"forward", "right", "down"};
  for (Eigen::Index i = 0; i < 3; ++i)
    table.rows.push_back(cells(
        {names[static_cast<std::size_t>(i)], decimals(configured(i), 3), decimals(difference(i), 3), decimals(sd(i), 3)}));
  return table;
}

}  // namespace

report::Section sensor_section(const ProcessPage& page) {
  report::Section section;
  section.id = "sensors";
  section.title = "Sensor errors";
  const std::vector<Group> groups = groups_of(page.result.states);
  section.tables.push_back(model_table(page.result.used.model));
  if (page.result.lever_arm) section.tables.push_back(lever_arm_table(page));
  if (!groups.empty()) section.tables.push_back(value_table(groups));
  for (std::size_t i = 0; i < groups.size(); ++i) section.panels.push_back(state_panel(page, groups[i], i + 1));
  return section;
}

}  // namespace coast::jobs
