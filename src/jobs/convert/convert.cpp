#include "coast/jobs/convert.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "coast/config/node.hpp"
#include "coast/io/reference.hpp"
#include "coast/io/writers.hpp"
#include "coast/study/interpolation.hpp"
#include "common/at_rate.hpp"
#include "common/tell.hpp"

namespace coast::jobs {

namespace {

std::vector<std::string> format_names() {
  std::vector<std::string> names;
  for (const io::TrajectoryFormat& format : io::trajectory_formats()) names.emplace_back(format.name);
  return names;
}

void require_contents(const io::TrajectoryFormat& format, const record::Trajectory& trajectory) {
  const auto refuse = [&](const char* what, const auto& without) {
    std::vector<std::string> others;
    for (const io::TrajectoryFormat& other : io::trajectory_formats())
      if (without(other)) others.emplace_back(other.name);
    throw InputError({trajectory.source, 0, fmt::format("no {}, which {} files contain", what, format.name),
                      fmt::format("one of {}", fmt::join(others, ", ")), ""});
  };
  const auto bare = [&](const io::TrajectoryFormat& other) {
    return (trajectory.has_velocity || !other.velocity) && (trajectory.has_attitude || !other.attitude) && !other.covariance;
  };
  if (format.velocity && !trajectory.has_velocity) refuse("velocity", bare);
  if (format.attitude && !trajectory.has_attitude) refuse("attitude", bare);
  if (format.covariance) refuse("standard deviations", bare);
}

}  // namespace

ConvertConfig read_convert(const std::filesystem::path& input, const std::filesystem::path& output, const std::string& format) {
  ConvertConfig config;
  config.input = input;
  config.output = output;
  const std::string extension = output.extension().string();
  config.format = !format.empty() ? format : extension.empty() ? "" : extension.substr(1);
  const std::vector<std::string> known = format_names();
  if (std::ranges::find(known, config.format) == known.end()) {
    const std::string near = config::nearest(config.format, known);
    throw InputError(
        {"", 0,
         fmt::format("{} is no format of trajectories: {}", config.format.empty() ? "nothing" : config.format, output.string()),
         fmt::format("one of {}", fmt::join(known, ", ")),
         near.empty() ? "Name the format with --to, or by the extension." : fmt::format("Do you mean {}?", near)});
  }
  std::error_code none;
  for (const std::string& name : files_of(config))
    if (std::filesystem::equivalent(input, output.parent_path() / name, none))
      throw InputError({output.string(), 0, "the output is the input", "another file", ""});
  return config;
}

record::Trajectory convert(const ConvertConfig& config, const Progress& progress) {
  progress("reading", 0.0);
  io::ReferenceFileOptions options = io::ReferenceFileOptions::of_file(config.input);
  options.time.gps_week = config.gps_week;
  record::Trajectory trajectory = io::read_reference(options);
  tell_warnings(trajectory.events, progress);
  require_contents(io::trajectory_format(config.format), trajectory);
  return trajectory;
}

std::vector<std::string> files_of(const ConvertConfig& config) {
  std::vector<std::string> files{config.output.filename().string()};
  const std::string_view companion = io::trajectory_format(config.format).companion;
  // Standard deviations, which trajectories that are read do not have, are all that a companion of SBET holds.
  if (!companion.empty() && companion != "smrmsg")
    files.push_back(io::companion_of(config.output.filename(), companion).string());
  return files;
}

void write(const ConvertConfig& config, const record::Trajectory& trajectory, const std::filesystem::path& folder) {
  io::WriterOptions options;
  options.geoid_height_m = config.geoid_height_m;
  options.covariance = false;
  const auto writer = io::trajectory_format(config.format).make(folder / config.output.filename(), options);
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

std::string told(const ConvertConfig& config, const record::Trajectory& trajectory, const std::filesystem::path&) {
  return fmt::format("{}: {}, {} to {}\n", config.output.string(), io::trajectory_format(config.format).description,
                     geo::to_string(trajectory.states.front().t), geo::to_string(trajectory.states.back().t));
}

std::vector<std::string> convert_format_names() {
  std::vector<std::string> names;
  for (const io::TrajectoryFormat& format : io::trajectory_formats()) names.emplace_back(format.name);
  return names;
}

std::string convert_formats(const std::string& indent) {
  std::string text;
  for (const io::TrajectoryFormat& format : io::trajectory_formats())
    fmt::format_to(std::back_inserter(text), "{}{:<8} {}\n", indent, format.name, format.description);
  return text;
}

}  // namespace coast::jobs
