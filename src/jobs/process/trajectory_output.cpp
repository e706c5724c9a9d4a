#include "process/trajectory_output.hpp"

#include "coast/io/writers.hpp"

namespace coast::jobs {

std::vector<std::string> trajectory_files(const OutputOptions& options) {
  std::vector<std::string> files;
  for (const std::string& format : options.formats) {
    const io::TrajectoryFormat& how = io::trajectory_format(format);
    files.push_back(io::file_of("trajectory", how));
    if (const std::string companion(how.companion); !companion.empty()) files.push_back("trajectory." + companion);
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
  if (rate_.due(epoch.nav.t)) to_(written);
}

}  // namespace coast::jobs
