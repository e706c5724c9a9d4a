#include "coast/jobs/inspect.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "coast/io/inspect.hpp"
#include "coast/jobs/run_file.hpp"
#include "inspect/sections.hpp"

namespace coast::jobs {

namespace {

/// Warnings of a reader once each: several readers of one file see the same damage.
void add_events(const record::Events& events, InspectResult& result) {
  for (const record::Event& event : events)
    if (event.severity == record::Event::Severity::kWarning &&
        std::ranges::find(result.warnings, event.text) == result.warnings.end())
      result.warnings.push_back(event.text);
}

template <class Recording, class Make>
void add(const std::optional<Recording>& recording, Make&& make, InspectResult& result) {
  if (!recording) return;
  result.sections.push_back(make(*recording));
  add_events(recording->events, result);
}

/// IMU and positions: together if the file has both, as axes, units and times are then compared.
void add_mission(const io::FileContents& contents, InspectResult& result) {
  if (!contents.imu && !contents.gnss) return;
  io::Inspection inspection = contents.imu && contents.gnss ? io::inspect(*contents.imu, *contents.gnss)
                              : contents.imu                ? io::inspect(*contents.imu)
                                                            : io::inspect(*contents.gnss);
  const char* title = !contents.imu ? "positions" : contents.gnss ? "IMU and positions" : "IMU";
  result.sections.push_back({title, std::move(inspection.sentences)});
  if (contents.imu) add_events(contents.imu->events, result);
  if (contents.gnss) add_events(contents.gnss->events, result);
}

bool is_configuration(const std::filesystem::path& file) {
  return file.extension() == ".yaml" || file.extension() == ".yml";
}

/// The recordings of a run file with its columns, axes and units: what `coast process` will see.
InspectResult inspect_run(const std::filesystem::path& file, const Progress& progress) {
  const Recordings recordings = load(read_run_config(file), progress);
  InspectResult result;
  result.format = "a run file";
  result.sections.push_back({"IMU and positions, as `coast process` reads them", recordings.inspection});
  add_events(recordings.imu.events, result);
  add_events(recordings.gnss.events, result);
  add_events(recordings.inspection_events, result);
  for (const record::AidRecording& aid : recordings.aids) add_events(aid.events, result);
  add(recordings.reference, trajectory_section, result);
  add(recordings.marks, marks_section, result);
  return result;
}

}  // namespace

InspectResult inspect(const InspectConfig& config, const Progress& progress) {
  progress("reading", 0.0);
  if (is_configuration(config.file)) return inspect_run(config.file, progress);
  io::FileContents contents = io::read_contents(config.file, config.gps_week);
  InspectResult result;
  result.format = contents.format;
  if (!contents.messages.empty()) result.sections.push_back(messages_section(contents.messages));
  add(contents.observations, observations_section, result);
  add(contents.navigation, navigation_section, result);
  add_mission(contents, result);
  add(contents.trajectory, trajectory_section, result);
  add(contents.marks, marks_section, result);
  result.absent = std::move(contents.refusals);
  return result;
}

std::string told(const InspectConfig& config, const InspectResult& result) {
  std::string text = fmt::format("{}: {}\n", config.file.string(), result.format);
  const auto add_list = [&text](std::string_view title, const std::vector<std::string>& lines) {
    if (lines.empty()) return;
    text += fmt::format("{}\n", title);
    for (const std::string& line : lines) text += fmt::format("  {}\n", line);
  };
  for (const InspectResult::Section& section : result.sections) add_list(section.title, section.lines);
  add_list("warnings", result.warnings);
  add_list("not found", result.absent);
  return text;
}

}  // namespace coast::jobs
