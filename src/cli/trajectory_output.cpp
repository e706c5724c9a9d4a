#include "trajectory_output.hpp"

namespace coast::cli {

void TrajectoryOutput::add(const record::TrajectoryEpoch& epoch) {
  const Eigen::Vector3d& rate = rate_.at(epoch.nav);
  const bool due = !options_.rate_hz || !last_written_ || epoch.nav.t - *last_written_ >= 1.0 / *options_.rate_hz - 1e-6;
  if (due) {
    if (options_.point_b.isZero()) {
      for (const auto& writer : writers_) writer->write(epoch);
    } else {
      record::TrajectoryEpoch moved = epoch;
      moved.nav = study::at_point(epoch.nav, options_.point_b, rate);
      for (const auto& writer : writers_) writer->write(moved);
    }
    last_written_ = epoch.nav.t;
  }
}

void TrajectoryOutput::close() {
  for (const auto& writer : writers_) writer->close();
}

}  // namespace coast::cli
