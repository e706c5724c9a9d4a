#include "gnss_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "coast/geo/rotation.hpp"
#include "gnss_builder.hpp"
#include "position.hpp"

namespace coast::io {

namespace {

using Slots = std::optional<std::array<std::size_t, 3>>;

class GnssTable {
 public:
  GnssTable(TableReader& table, const GnssFileOptions& options, std::optional<geo::GpsTime> near)
      : table_(table),
        options_(options),
        time_(table, options.time, options.time_columns, near),
        position_(options.position, table),
        builder_(table) {
    r_ = slots(options.position_columns, "position");
    if (!options.sd) sd_ = slots(options.sd_columns, "sd");
    v_ = slots(options.velocity_columns, "velocity");
    if (!options.velocity_sd) v_sd_ = slots(options.velocity_sd_columns, "velocity_sd");
    if (!options.quality_column.empty()) quality_ = table.number_slot(options.quality_column, "quality");
    if (!options.satellites_column.empty()) satellites_ = table.number_slot(options.satellites_column, "satellites");
    if (!sd_ && !options.sd)
      throw InputError({table.name(), 0, "no standard deviations", "columns `sd: [n, e, d]`, or the same for all fixes",
                        "Give `sd_m: [n, e, d]` beside the file: what you would expect of this receiver."});
    if (v_ && !v_sd_ && !options.velocity_sd)
      throw InputError({table.name(), 0, "velocities without standard deviations", "columns `velocity_sd`, or the same for all",
                        "Give `velocity_sd_mps: [n, e, d]` beside the file, or leave `velocity` out."});
  }

  record::GnssRecording read() {
    while (table_.next()) take_row();
    record::Events events = position_.events();
    for (const auto& event : time_.events()) events.push_back(event);
    return builder_.finish(events);
  }

 private:
  Slots slots(const std::vector<Column>& columns, std::string_view role) {
    if (columns.empty()) return std::nullopt;
    std::array<std::size_t, 3> s{};
    for (std::size_t i = 0; i < 3; ++i) s[i] = table_.number_slot(columns[i], role);
    return s;
  }
  [[nodiscard]] Eigen::Vector3d vector(const Slots& s) const {
    return {table_.number((*s)[0]), table_.number((*s)[1]), table_.number((*s)[2])};
  }

  void take_row() {
    if (!table_.finite()) return builder_.leave_out_nan();
    record::GnssFix fix;
    fix.t = time_.read();
    const Eigen::Vector3d r = vector(r_);
    fix.r_ea_e = position_.to_ecef(r.x(), r.y(), r.z());
    fix.position_cov_n = builder_.covariance({options_.sd ? *options_.sd : vector(sd_)}, "position", "sd_m");
    if (v_)
      fix.velocity = {vector(v_), builder_.covariance({options_.velocity_sd ? *options_.velocity_sd : vector(v_sd_)},
                                                      "velocity", "velocity_sd_mps")};
    if (quality_) fix.quality = quality_from(table_.number(*quality_));
    if (satellites_) fix.satellites = static_cast<int>(std::lround(std::clamp(table_.number(*satellites_), 0.0, 999.0)));
    builder_.add(fix);
  }

  TableReader& table_;
  const GnssFileOptions& options_;
  TimeColumn time_;
  PositionConverter position_;
  GnssBuilder builder_;
  Slots r_, sd_, v_, v_sd_;
  std::optional<std::size_t> quality_, satellites_;
};

}  // namespace

record::GnssRecording read_gnss_table(TableReader& table, const GnssFileOptions& options, std::optional<geo::GpsTime> near) {
  return GnssTable(table, options, near).read();
}

}  // namespace coast::io
