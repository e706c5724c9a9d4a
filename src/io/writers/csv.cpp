// CSV with header: gps_week, sow_s, position, velocity, attitude; standard deviations (N, E, D; roll, pitch, yaw) and
// correlations of position, velocity and attitude errors.

#include <fmt/format.h>

#include "../state_columns.hpp"
#include "text_trajectory.hpp"
#include "writers.hpp"

namespace coast::io {

namespace {

class CsvWriter final : public TextTrajectory {
 public:
  CsvWriter(const std::filesystem::path& path, bool covariance) : TextTrajectory(path), covariance_(covariance) {
    text().put(fmt::format("{},{}", kTimeAndPlaceColumns, kMotionColumns));
    if (covariance_) text().put(fmt::format(",{}", kCovarianceColumns));
    text().end_line();
  }

  void write(const record::TrajectoryEpoch& epoch) override {
    const LocalState s = local_state(epoch.nav);
    put_time_and_place(text(), epoch.nav.t, s.p);
    put_motion(text(), s);
    if (covariance_) put_covariance(text(), epoch.cov, s.attitude);
    text().end_line();
  }

 private:
  bool covariance_;
};

}  // namespace

TrajectoryFormat csv_trajectory() {
  TrajectoryFormat format{"csv", "CSV with covariance"};
  format.velocity = format.attitude = true;
  format.make = [](const std::filesystem::path& file, const WriterOptions& options) {
    return std::make_unique<CsvWriter>(file, options.covariance);
  };
  return format;
}

}  // namespace coast::io
