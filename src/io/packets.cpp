#include "coast/io/packets.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "imu_builder.hpp"
#include "imu_units.hpp"

namespace coast::io {

namespace {

constexpr double kLargestCounter = 9007199254740992.0;  // above it a double does not represent every integer

class PacketTable {
 public:
  explicit PacketTable(const PacketFileOptions& options) : options_(options), table_(options.file) {
    counter_ = table_.number_slot(options.counter, "counter");
    arrival_ = table_.number_slot(options.arrival, "arrival");
    for (std::size_t i = 0; i < 3; ++i) gyro_[i] = table_.number_slot(options.gyro[i], "gyro");
    for (std::size_t i = 0; i < 3; ++i) accel_[i] = table_.number_slot(options.accel[i], "accel");
    if (!options.gps.empty()) gps_ = table_.number_slot(options.gps, "gps");
    if (!options.pulse.empty()) pulse_ = table_.number_slot(options.pulse, "pulse");
    recording_.source = table_.name();
  }

  record::PacketRecording read() {
    while (table_.next()) take_row();
    for (const record::Event& event : table_.events()) recording_.events.push_back(event);
    if (left_out_ > 0)
      recording_.events.push_back(
          {record::Event::Severity::kWarning, "nan_row",
           fmt::format("{}: {} rows with a field that is not finite left out", recording_.source, left_out_), std::nullopt,
           left_out_});
    if (recording_.packets.size() < 2) throw table_.error("fewer than two packets", "a recording");
    return std::move(recording_);
  }

 private:
  void take_row() {
    record::ImuSample values;
    values.dtheta = options_.gyro_to_si * vector(gyro_);
    values.dv = options_.accel_to_si * vector(accel_);
    const double arrival = table_.number(arrival_);
    if (!values.dtheta.allFinite() || !values.dv.allFinite() || !std::isfinite(arrival)) {
      ++left_out_;
      return;
    }
    require_possible(values, error_);
    if (!(std::abs(arrival) < 1e12)) throw table_.error("not a time of arrival", "seconds");
    record::Packet packet;
    packet.counter = whole(counter_, "counter");
    packet.arrival_s = arrival;
    if (gps_ && std::isfinite(table_.number(*gps_))) packet.master_s = second_of_week(table_.number(*gps_));
    if (pulse_ && std::isfinite(table_.number(*pulse_))) packet.pulse = whole(*pulse_, "pulse");
    packet.row = recording_.rates.size();
    recording_.packets.push_back(packet);
    recording_.rates.push_back(values.dtheta);
    recording_.forces.push_back(values.dv);
  }

  [[nodiscard]] std::int64_t whole(std::size_t slot, const char* what) const {
    const double value = table_.number(slot);
    if (!(value >= 0.0 && value < kLargestCounter) || value != std::floor(value))
      throw table_.error(fmt::format("{} {} is no whole number of zero or more", what, value), "a counter");
    return static_cast<std::int64_t>(value);
  }
  [[nodiscard]] double second_of_week(double value) const {
    if (!(value >= 0.0 && value < 604800.0)) throw table_.error(fmt::format("gps {}", value), "GPS seconds of week");
    return value;
  }
  [[nodiscard]] Eigen::Vector3d vector(const std::array<std::size_t, 3>& slots) const {
    return {table_.number(slots[0]), table_.number(slots[1]), table_.number(slots[2])};
  }

  const PacketFileOptions& options_;
  TableReader table_;
  WeekClock::MakeError error_ = [this](auto found, auto expected, auto what_to_do) {
    return table_.error(found, expected, what_to_do);
  };
  std::size_t counter_ = 0, arrival_ = 0;
  std::array<std::size_t, 3> gyro_{}, accel_{};
  std::optional<std::size_t> gps_, pulse_;
  long left_out_ = 0;
  record::PacketRecording recording_;
};

}  // namespace

PacketFileOptions PacketFileOptions::from(const config::Node& imu) {
  PacketFileOptions o;
  o.file = imu.at("file").path();
  const config::Node columns = imu.at("columns");
  o.counter = Column::from(columns.at("counter"));
  o.arrival = Column::from(columns.at("arrival"));
  o.gyro = Column::list_from(columns.at("gyro"), 3);
  o.accel = Column::list_from(columns.at("accel"), 3);
  if (const auto gps = columns.find("gps")) o.gps = Column::from(*gps);
  if (const auto pulse = columns.find("pulse")) o.pulse = Column::from(*pulse);
  const ImuFactors factors = imu_factors(imu, false);
  o.gyro_to_si = factors.gyro;
  o.accel_to_si = factors.accel;
  return o;
}

record::PacketRecording read_packets(const PacketFileOptions& options) {
  return PacketTable(options).read();
}

}  // namespace coast::io
