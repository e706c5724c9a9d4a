#include "trajectory_output.hpp"

namespace coast::cli {

std::vector<std::string> trajectory_files(const OutputOptions& options) {
  std::vector<std::string> files;
  for (const std::string& format : options.formats) {
    files.push_back("trajectory." + format);
    if (format == "sbet") files.emplace_back("trajectory.smrmsg");
    if (format == "nav") files.emplace_back("forward.nav");
  }
  return files;
}

// Heights above mean sea level that nobody converted are the trajectory's, too.
std::optional<double> geoid_height(const RunConfig& config) {
  if (config.ppk) return std::nullopt;
  const io::PositionOptions& position = config.gnss.position;
  if (position.above_mean_sea_level && !position.geoid_height) return 0.0;
  return position.geoid_height;
}

void TrajectoryOutput::add(const record::TrajectoryEpoch& epoch) {
  record::TrajectoryEpoch written = epoch;
  written.motion = motion_.at(epoch.nav);
  if (!options_.point_b.isZero()) {
    written.nav = study::at_point(epoch.nav, options_.point_b, written.motion.omega_eb_b);
    written.motion.a_eb_b = motion_at_point_.at(written.nav).a_eb_b;
  }
  const bool due = !options_.rate_hz || !last_written_ || epoch.nav.t - *last_written_ >= 1.0 / *options_.rate_hz - 1e-6;
  if (!due) return;
  for (const auto& writer : writers_) writer->write(written);
  last_written_ = epoch.nav.t;
}

void TrajectoryOutput::close() {
  for (const auto& writer : writers_) writer->close();
}

}  // namespace coast::cli
