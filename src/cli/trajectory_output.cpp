#include "trajectory_output.hpp"

#include "coast/study/interpolation.hpp"

namespace coast::cli {

void TrajectoryOutput::add(const record::TrajectoryEpoch& epoch) {
  const bool due = !options_.rate_hz || !last_written_ || epoch.nav.t - *last_written_ >= 1.0 / *options_.rate_hz - 1e-6;
  if (due) {
    if (options_.point_b.isZero()) {
      for (const auto& writer : writers_) writer->write(epoch);
    } else {
      record::TrajectoryEpoch moved = epoch;
      const Eigen::Vector3d rate = previous_ ? study::mean_rate(*previous_, epoch.nav) : Eigen::Vector3d::Zero();
      moved.nav = study::at_point(epoch.nav, options_.point_b, rate);
      for (const auto& writer : writers_) writer->write(moved);
    }
    last_written_ = epoch.nav.t;
  }
  previous_ = epoch.nav;
}

void TrajectoryOutput::close() {
  for (const auto& writer : writers_) writer->close();
}

}  // namespace coast::cli
