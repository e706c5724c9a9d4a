#include "boot_clock_imu.hpp"

#include <fmt/format.h>

#include <utility>

#include "counted.hpp"
#include "imu_builder.hpp"
#include "repairs.hpp"

namespace coast::io {

std::vector<BootImuRow> paired_triads(std::span<const BootTriad> gyros, std::span<const BootTriad> accels) {
  std::vector<BootImuRow> samples;
  std::size_t next = 1;
  for (const BootTriad& gyro : gyros) {
    while (next < accels.size() && accels[next].boot_us < gyro.boot_us) ++next;
    if (next >= accels.size()) break;
    const BootTriad &a = accels[next - 1], &b = accels[next];
    if (gyro.boot_us < a.boot_us || b.boot_us <= a.boot_us) continue;
    const double share = static_cast<double>(gyro.boot_us - a.boot_us) / static_cast<double>(b.boot_us - a.boot_us);
    samples.push_back({gyro.boot_us, gyro.value, a.value + share * (b.value - a.value)});
  }
  return samples;
}

record::ImuRecording boot_clock_imu(std::span<const BootImuRow> rows, const ClockTie& tie, const ImuFileOptions& options,
                                    const std::string& source, record::Events damage) {
  record::ImuRecording recording;
  recording.source = source;
  long row = 0, not_finite = 0;
  const auto error = [&](std::string found, std::string expected, std::string what_to_do) {
    return InputError({source, 0, fmt::format("IMU sample {}: {}", row, found), std::move(expected), std::move(what_to_do)});
  };
  Repairs repairs;
  TimeOrder order(error, repairs);
  for (const BootImuRow& s : rows) {
    ++row;
    const auto t = tie.at(s.boot_us);
    if (!t || !s.gyro.allFinite() || !s.accel.allFinite()) {
      ++not_finite;
      continue;
    }
    const record::ImuSample sample{*t + options.time.offset_s, 0.0, s.gyro, s.accel};
    require_possible(sample, error);
    auto& samples = recording.samples;
    const bool same = !samples.empty() && samples.back().dtheta == sample.dtheta && samples.back().dv == sample.dv;
    if (order.accept(sample.t, same)) samples.push_back(sample);
  }
  recording.events = std::move(damage);
  repairs.finish(row, recording.events);
  add_counted(recording.events, source, {not_finite},
              {"nan_row", "IMU sample", "IMU samples", "with a value that is not finite, or an impossible time, left out"});
  recording.events.push_back(
      {record::Event::Severity::kInfo, "imu_clock_tied",
       fmt::format(
           "{}: IMU times follow from when GNSS messages arrived, which scatter by {:.3f} s: they are early by the delay of "
           "these, some 0.1 s. Without `gnss.time_offset_s` the rest is found from the motion",
           source, tie.median_distance_s()),
       std::nullopt, 1});
  finish_imu(recording, false, options.time_tag);
  return recording;
}

}  // namespace coast::io
