#include "process/trajectory_output.hpp"

namespace coast::jobs {

std::vector<std::string> trajectory_files(const OutputOptions& options) {
  std::vector<std::string> files;
  for (const std::string& format : options.formats) {
    files.push_back("trajectory." + format);
    if (format == "sbet") files.emplace_back("trajectory.smrmsg");
    if (format == "nav") files.emplace_back("forward.nav");
  }
  return files;
}

void TrajectoryOutput::add(const record::TrajectoryEpoch& epoch) {
  record::TrajectoryEpoch written = epoch;
  written.motion = motion_.at(epoch.nav);
  if (!options_.point_b.isZero()) {
    written.nav = study::at_point(epoch.nav, options_.point_b, written.motion.omega_eb_b);
    written.motion.a_eb_b = motion_at_point_.at(written.nav).a_eb_b;
  }
  const bool due = !options_.rate_hz || !last_ || epoch.nav.t - *last_ >= 1.0 / *options_.rate_hz - 1e-6;
  if (!due) return;
  to_(written);
  last_ = epoch.nav.t;
}

}  // namespace coast::jobs
