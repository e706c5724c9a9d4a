// CSV with header: gps_week, sow_s, position, velocity, attitude; standard deviations (N, E, D; roll, pitch, yaw) and
// correlations of position, velocity and attitude errors.

#include <fmt/format.h>

#include "../state_columns.hpp"
#include "writers.hpp"

namespace coast::io {

namespace {

class CsvWriter final : public TrajectoryWriter {
 public:
  CsvWriter(const std::filesystem::path& path, bool covariance) : file_(path), text_(file_), covariance_(covariance) {
    text_.put(fmt::format("{},{}", kTimeAndPlaceColumns, kMotionColumns));
    if (covariance_) text_.put(fmt::format(",{}", kCovarianceColumns));
    text_.end_line();
  }

  void write(const record::TrajectoryEpoch& epoch) override {
    const LocalState s = local_state(epoch.nav);
    put_time_and_place(text_, epoch.nav.t, s.p);
    put_motion(text_, s);
    if (covariance_) put_covariance(text_, epoch.cov, s.attitude);
    text_.end_line();
  }
  void close() override {
    text_.flush();
    file_.commit();
  }

 private:
  AtomicFile file_;
  TextBuffer text_;
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
