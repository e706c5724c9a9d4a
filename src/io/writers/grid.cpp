// CSV in a projected CRS: easting, northing, height, roll, pitch, heading relative to true and to grid north; standard
// deviations along the axes of the grid.

#include <fmt/format.h>

#include <stdexcept>

#include "../grid_columns.hpp"
#include "../state_columns.hpp"
#include "coast/geo/units.hpp"
#include "text_trajectory.hpp"
#include "writers.hpp"

namespace coast::io {

namespace {

class GridWriter final : public TextTrajectory {
 public:
  GridWriter(const std::filesystem::path& path, const WriterOptions& options) : TextTrajectory(path), options_(options) {
    text().put("gps_week,sow_s," + grid_place_columns(*options_.projection));
    text().put(options_.attitude ? fmt::format(",roll_deg,pitch_deg,{}", kGridHeadingColumns) : ",convergence_deg");
    if (options_.covariance) text().put("," + grid_sd_columns(*options_.projection));
    text().end_line();
  }

  void write(const record::TrajectoryEpoch& epoch) override {
    const record::NavState& nav = epoch.nav;
    const double convergence = options_.projection->convergence(nav.r_eb_e, nav.t);
    text().put_integer(nav.t.week());
    put_column(text(), nav.t.sow(), 9);
    put_grid_place(text(), *options_.projection, nav.r_eb_e, nav.t);
    if (options_.attitude) {
      const geo::Euler attitude = local_state(nav).attitude;
      put_column(text(), attitude.roll / geo::kDegree, 9);
      put_column(text(), attitude.pitch / geo::kDegree, 9);
      put_grid_heading(text(), convergence, attitude.yaw);
    } else {
      put_column(text(), convergence / geo::kDegree, 9);
    }
    if (options_.covariance) put_grid_sd(text(), *options_.projection, convergence, epoch.cov.position);
    text().end_line();
  }

 private:
  WriterOptions options_;
};

}  // namespace

TrajectoryFormat grid_trajectory() {
  TrajectoryFormat format{"grid", "CSV in a projected CRS"};
  format.extension = "grid.csv";
  format.projected = true;
  format.make = [](const std::filesystem::path& file, const WriterOptions& options) {
    if (!options.projection) throw std::invalid_argument("the format grid needs a projection");
    return std::make_unique<GridWriter>(file, options);
  };
  return format;
}

void write_gnss_grid(const std::filesystem::path& path, const record::GnssRecording& gnss, const Projection& projection) {
  AtomicFile file(path);
  TextBuffer text(file);
  text.put(
      fmt::format("gps_week,sow_s,{},convergence_deg,{},quality", grid_place_columns(projection), grid_sd_columns(projection)));
  text.end_line();
  for (const record::GnssFix& fix : gnss.fixes) {
    const double convergence = projection.convergence(fix.r_ea_e, fix.t);
    text.put_integer(fix.t.week());
    put_column(text, fix.t.sow(), 9);
    put_grid_place(text, projection, fix.r_ea_e, fix.t);
    put_column(text, convergence / geo::kDegree, 9);
    put_grid_sd(text, projection, convergence, fix.position_cov_n);
    text.put(',');
    text.put_integer(static_cast<int>(fix.quality));
    text.end_line();
  }
  text.flush();
  file.commit();
}

}  // namespace coast::io
