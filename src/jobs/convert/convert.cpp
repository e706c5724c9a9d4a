#include "coast/jobs/convert.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "coast/config/node.hpp"
#include "coast/io/recording_formats.hpp"
#include "coast/io/writers.hpp"
#include "coast/study/interpolation.hpp"
#include "common/at_rate.hpp"
#include "common/tell.hpp"

namespace coast::jobs {

namespace {

/// A format by its name; none if it holds trajectories only, or recordings only.
template <class Format>
const Format* named(const std::vector<Format>& formats, std::string_view name) {
  const auto found = std::ranges::find(formats, name, &Format::name);
  return found == formats.end() ? nullptr : &*found;
}

const io::TrajectoryFormat* trajectory_format_of(const ConvertConfig& config) {
  return named(io::trajectory_formats(), config.format);
}

std::vector<io::RecordingPart> parts_of(const ConvertConfig& config) {
  const io::RecordingFormat* format = named(io::recording_formats(), config.format);
  return format == nullptr ? std::vector<io::RecordingPart>{} : format->parts;
}

std::string file_of(const ConvertConfig& config, const io::RecordingPart& part) {
  return io::companion_of(config.output.filename(), part.extension).string();
}

/// What an extension stands for that is no name of a format: .obs, .rnx.
std::string format_of_extension(const std::string& extension) {
  if (extension.empty()) return "";
  const std::string name = extension.substr(1);
  return name == "obs" || name == "rnx" ? "rinex" : name;
}

/// What a format needs and the trajectory lacks.
const char* lacking(const io::TrajectoryFormat& format, const record::Trajectory& trajectory) {
  if (format.velocity && !trajectory.has_velocity) return "velocity";
  if (format.attitude && !trajectory.has_attitude) return "attitude";
  return format.covariance ? "standard deviations" : nullptr;
}

/// What of a file is written.
struct Selection {
  bool trajectory = false;
  std::vector<io::RecordingPart> parts;
};

Selection selection(const ConvertConfig& config, const io::FileContents& contents) {
  Selection s;
  const io::TrajectoryFormat* format = trajectory_format_of(config);
  s.trajectory = format != nullptr && contents.trajectory && lacking(*format, *contents.trajectory) == nullptr;
  // A table is of one kind: the columns of a trajectory contain those of positions.
  if (s.trajectory && contents.messages.empty()) return s;
  for (const io::RecordingPart& part : parts_of(config))
    if (part.present(contents)) s.parts.push_back(part);
  return s;
}

[[noreturn]] void refuse_trajectory(const io::TrajectoryFormat& format, const record::Trajectory& trajectory) {
  std::vector<std::string> others;
  for (const io::TrajectoryFormat& other : io::trajectory_formats())
    if (lacking(other, trajectory) == nullptr) others.emplace_back(other.name);
  throw InputError({trajectory.source, 0,
                    fmt::format("no {}, which {} files contain", lacking(format, trajectory), format.name),
                    fmt::format("one of {}", fmt::join(others, ", ")), ""});
}

/// What a file holds, and the formats that can hold it.
[[noreturn]] void refuse(const ConvertConfig& config, const io::FileContents& contents) {
  const io::TrajectoryFormat* format = trajectory_format_of(config);
  if (contents.trajectory && format != nullptr) refuse_trajectory(*format, *contents.trajectory);
  std::vector<std::string> held, formats;
  const auto add = [](std::vector<std::string>& list, std::string_view name) {
    if (std::ranges::find(list, name) == list.end()) list.emplace_back(name);
  };
  for (const io::RecordingFormat& other : io::recording_formats())
    for (const io::RecordingPart& part : other.parts)
      if (part.present(contents)) {
        add(held, part.what);
        add(formats, other.name);
      }
  if (contents.trajectory) add(held, "a trajectory");
  if (contents.trajectory)
    for (const io::TrajectoryFormat& other : io::trajectory_formats()) add(formats, other.name);
  throw InputError({contents.source, 0,
                    fmt::format("{}, nothing that {} files contain",
                                held.empty() ? "messages alone" : fmt::format("{}", fmt::join(held, ", ")), config.format),
                    formats.empty() ? "a recording" : fmt::format("--to {}", fmt::join(formats, ", ")), ""});
}

void write_trajectory(const ConvertConfig& config, const record::Trajectory& trajectory, const std::filesystem::path& folder) {
  io::WriterOptions options;
  options.geoid_height_m = config.geoid_height_m;
  options.covariance = false;
  options.attitude = trajectory.has_attitude;
  options.projection = config.projection;
  const auto writer = trajectory_format_of(config)->make(folder / config.output.filename(), options);
  study::PassingMotion motion;
  AtRate rate(config.rate_hz);
  for (const record::NavState& nav : trajectory.states) {
    record::TrajectoryEpoch epoch;
    epoch.nav = nav;
    if (trajectory.has_velocity && trajectory.has_attitude) epoch.motion = motion.at(nav);
    epoch.gnss = record::GnssSupport{};
    if (rate.due(nav.t)) writer->write(epoch);
  }
  writer->close();
}

/// For the first position that is written.
void choose_projection(io::Projection& projection, bool trajectory, const io::FileContents& contents,
                       const Progress& progress) {
  if (trajectory)
    projection.choose(contents.trajectory->states.front().r_eb_e);
  else if (contents.gnss && !contents.gnss->fixes.empty())
    projection.choose(contents.gnss->fixes.front().r_ea_e);
  const record::Events events = projection.events();
  tell_warnings(events, progress);
  for (const record::Event& event : events)
    if (progress.say && event.severity == record::Event::Severity::kInfo) progress.say(event.text);
}

}  // namespace

ConvertConfig read_convert(const std::filesystem::path& input, const std::filesystem::path& output, const std::string& format) {
  ConvertConfig config;
  config.input = input;
  config.output = output;
  config.format = !format.empty() ? format : format_of_extension(output.extension().string());
  const std::vector<std::string> known = convert_format_names();
  if (std::ranges::find(known, config.format) == known.end()) {
    const std::string near = config::nearest(config.format, known);
    throw InputError(
        {"", 0, fmt::format("{} is no format to write: {}", config.format.empty() ? "nothing" : config.format, output.string()),
         fmt::format("one of {}", fmt::join(known, ", ")),
         near.empty() ? "Name the format with --to, or by the extension." : fmt::format("Do you mean {}?", near)});
  }
  std::error_code none;
  for (const std::string& name : files_of(config))
    if (std::filesystem::equivalent(input, output.parent_path() / name, none))
      throw InputError({output.string(), 0, "the output is the input", "another file", ""});
  return config;
}

io::FileContents convert(const ConvertConfig& config, const Progress& progress) {
  if (const io::TrajectoryFormat* format = trajectory_format_of(config);
      format != nullptr && format->projected && !config.projection)
    throw InputError({"", 0, fmt::format("--to {} without a CRS", config.format), "--crs EPSG:CODE",
                      "For example the zone of UTM: EPSG:32632."});
  progress("reading", 0.0);
  io::FileContents contents = io::read_contents(config.input, config.gps_week);
  const Selection selected = selection(config, contents);
  if (!selected.trajectory && selected.parts.empty()) refuse(config, contents);
  if (config.projection) choose_projection(*config.projection, selected.trajectory, contents, progress);
  const auto tell = [&progress](const auto& recording) {
    if (recording) tell_warnings(recording->events, progress);
  };
  if (selected.trajectory) tell(contents.trajectory);
  if (selected.parts.empty()) return contents;
  tell(contents.observations);
  tell(contents.navigation);
  tell(contents.imu);
  tell(contents.gnss);
  return contents;
}

std::vector<std::string> files_of(const ConvertConfig& config) {
  std::vector<std::string> files;
  if (const io::TrajectoryFormat* format = trajectory_format_of(config)) {
    files.push_back(config.output.filename().string());
    // Standard deviations, which trajectories that are read do not have, are all that a companion of SBET holds.
    if (!format->companion.empty() && format->companion != "smrmsg")
      files.push_back(io::companion_of(config.output.filename(), format->companion).string());
  }
  for (const io::RecordingPart& part : parts_of(config)) files.push_back(file_of(config, part));
  return files;
}

void write(const ConvertConfig& config, const io::FileContents& contents, const std::filesystem::path& folder) {
  const Selection selected = selection(config, contents);
  if (selected.trajectory) write_trajectory(config, *contents.trajectory, folder);
  for (const io::RecordingPart& part : selected.parts)
    part.write(folder / file_of(config, part), contents, config.projection.get());
}

std::string told(const ConvertConfig& config, const io::FileContents& contents, const std::filesystem::path&) {
  const Selection selected = selection(config, contents);
  std::string text;
  if (selected.trajectory)
    text += fmt::format("{}: {}, {} to {}\n", config.output.string(), trajectory_format_of(config)->description,
                        geo::to_string(contents.trajectory->states.front().t),
                        geo::to_string(contents.trajectory->states.back().t));
  for (const io::RecordingPart& part : selected.parts)
    text += fmt::format("{}: {}\n", (config.output.parent_path() / file_of(config, part)).string(), part.what);
  return text;
}

std::vector<std::string> convert_format_names() {
  std::vector<std::string> names;
  for (const io::TrajectoryFormat& format : io::trajectory_formats()) names.emplace_back(format.name);
  for (const io::RecordingFormat& format : io::recording_formats())
    if (named(io::trajectory_formats(), format.name) == nullptr) names.emplace_back(format.name);
  return names;
}

std::string convert_formats(const std::string& indent) {
  std::string text;
  const auto add = [&](const auto& format) {
    fmt::format_to(std::back_inserter(text), "{}{:<8} {}\n", indent, format.name, format.description);
  };
  text += indent + "of a trajectory\n";
  for (const io::TrajectoryFormat& format : io::trajectory_formats()) add(format);
  text += indent + "of a recording\n";
  for (const io::RecordingFormat& format : io::recording_formats()) add(format);
  return text;
}

}  // namespace coast::jobs
