#include "coast/io/noise_levels.hpp"

#include <array>

#include "coast/io/table.hpp"
#include "week_time.hpp"

namespace coast::io {

namespace {

constexpr std::array kColumns{"gyro_x_radps_rthz", "gyro_y_radps_rthz", "gyro_z_radps_rthz",
                              "accel_x_mps2_rthz", "accel_y_mps2_rthz", "accel_z_mps2_rthz"};

/// Squares of the columns relative to their means over time.
void normalise(std::vector<record::NoiseLevel>& levels) {
  Eigen::Vector3d gyro = Eigen::Vector3d::Zero(), accel = gyro;
  double span = 0.0;
  for (const record::NoiseLevel& level : levels) {
    const double seconds = level.to - level.from;
    gyro += seconds * level.gyro;
    accel += seconds * level.accel;
    span += seconds;
  }
  for (record::NoiseLevel& level : levels) {
    level.gyro = (span * level.gyro).cwiseQuotient(gyro);
    level.accel = (span * level.accel).cwiseQuotient(accel);
  }
}

}  // namespace

std::vector<record::NoiseLevel> read_noise_levels(const std::filesystem::path& file) {
  TableReader table(file);
  const std::size_t week = table.number_slot("gps_week", "the week"), seconds = table.number_slot("sow_s", "the time");
  std::array<std::size_t, kColumns.size()> slots{};
  for (std::size_t i = 0; i < kColumns.size(); ++i) slots[i] = table.number_slot(kColumns[i], "a density");
  std::vector<record::NoiseLevel> levels;
  while (table.next()) {
    record::NoiseLevel level;
    for (std::size_t i = 0; i < slots.size(); ++i) {
      const double density = table.number(slots[i]);
      if (!(density > 0.0 && density < 1e6)) throw table.error("a density of zero or less, or none", "a number above zero");
      (i < 3 ? level.gyro : level.accel)(static_cast<Eigen::Index>(i % 3)) = density * density;
    }
    level.from = week_time(table, week, seconds);
    if (!levels.empty()) {
      if (!(levels.back().from < level.from)) throw table.error("a time not behind the one before", "increasing times");
      levels.back().to = level.from;
    }
    levels.push_back(level);
  }
  if (levels.size() < 2) throw table.error("fewer than two rows", "the noise over time");
  record::NoiseLevel& last = levels.back();
  last.to = last.from + (last.from - levels[levels.size() - 2].from);
  normalise(levels);
  return levels;
}

}  // namespace coast::io
