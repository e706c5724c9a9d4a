#include "imu_table.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "imu_builder.hpp"
#include "repairs.hpp"

namespace coast::io {

namespace {

constexpr double kImuNanShare = 0.01;

class ImuTable {
 public:
  ImuTable(TableReader& table, const ImuFileOptions& options, std::optional<geo::GpsTime> near)
      : table_(table), options_(options), time_(table, options.time, options.time_columns, near), order_(table, repairs_) {
    for (std::size_t i = 0; i < 3; ++i) gyro_[i] = table.number_slot(options.gyro_columns[i], "gyro");
    for (std::size_t i = 0; i < 3; ++i) accel_[i] = table.number_slot(options.accel_columns[i], "accel");
    if (!options.temperature_column.empty()) temperature_ = table.number_slot(options.temperature_column, "temperature");
    recording_.source = table.name();
    recording_.samples.reserve(table.expected_rows());
  }

  record::ImuRecording read() {
    while (table_.next()) take_row();
    for (const auto& event : table_.events()) recording_.events.push_back(event);
    for (const auto& event : time_.events()) recording_.events.push_back(event);
    repairs_.finish(table_.rows(), recording_.events);
    finish_imu(recording_, options_.increments, options_.time_tag);
    return std::move(recording_);
  }

 private:
  void take_row() {
    if (!table_.finite()) {
      repairs_.add("nan_row", "with a field that is empty or not finite left out", kImuNanShare,
                   table_.error("a field that is empty or not finite", "numbers", "Are the columns mapped right?"),
                   std::nullopt);
      return;
    }
    record::ImuSample sample;
    sample.t = time_.read();
    sample.dtheta = options_.gyro_to_si * vector(gyro_);
    sample.dv = options_.accel_to_si * vector(accel_);
    require_possible(sample, error_);
    auto& samples = recording_.samples;
    if (samples.empty() && sample.dtheta.isZero(0.0) && sample.dv.isZero(0.0)) {
      repairs_.add("imu_zero_row", "at the start with zeros in all axes left out: the sensor was not measuring yet", 1.0,
                   table_.error("rates and specific forces are all zero"), sample.t);
      return;
    }
    const bool same = !samples.empty() && samples.back().dtheta == sample.dtheta && samples.back().dv == sample.dv;
    if (!order_.accept(sample.t, same)) return;
    samples.push_back(sample);
    if (temperature_) recording_.temperature.push_back(static_cast<float>(table_.number(*temperature_)));
  }

  [[nodiscard]] Eigen::Vector3d vector(const std::array<std::size_t, 3>& slots) const {
    return {table_.number(slots[0]), table_.number(slots[1]), table_.number(slots[2])};
  }

  TableReader& table_;
  const ImuFileOptions& options_;
  WeekClock::MakeError error_ = [this](auto found, auto expected, auto what_to_do) {
    return table_.error(found, expected, what_to_do);
  };
  Repairs repairs_;
  TimeColumn time_;
  TimeOrder order_;
  std::array<std::size_t, 3> gyro_{}, accel_{};
  std::optional<std::size_t> temperature_;
  record::ImuRecording recording_;
};

}  // namespace

record::ImuRecording read_imu_table(TableReader& table, const ImuFileOptions& options, std::optional<geo::GpsTime> near) {
  return ImuTable(table, options, near).read();
}

}  // namespace coast::io
