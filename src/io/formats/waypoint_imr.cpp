// Waypoint IMR (Inertial Explorer): a header of 512 bytes, then records of a double (seconds of week) and six 32-bit counts
// (gyro x, y, z, accelerometer x, y, z). Layout: NovAtel, "IMR File"
// (docs.novatel.com/Waypoint/Content/Data_Formats/IMR_File.htm).

#include <fmt/format.h>

#include <cmath>

#include "../binary.hpp"
#include "../imu_builder.hpp"
#include "../repairs.hpp"
#include "coast/geo/units.hpp"
#include "coast/io/input.hpp"
#include "formats.hpp"

namespace coast::io {

namespace {

constexpr std::size_t kHeader = 512;
constexpr std::size_t kRecordBytes = 32;
constexpr std::string_view kMagic = "$IMURAW";

struct ImrHeader {
  bool big_endian = false;
  bool gyro_increments = true;
  bool accel_increments = true;
  double rate_hz = 0.0;
  double gyro_scale = 0.0;   ///< deg/s, or deg
  double accel_scale = 0.0;  ///< m/s^2, or m/s
  bool utc = false;
  double time_bias = 0.0;  ///< s
};

ImrHeader parse_header(std::string_view bytes, const std::string& name) {
  const auto refuse = [&](std::string found, std::string expected) {
    return InputError({name, 0, "header: " + std::move(found), std::move(expected), "Is this a Waypoint IMR file?"});
  };
  if (bytes.size() < kHeader || bytes.substr(0, kMagic.size()) != kMagic) throw refuse("no \"$IMURAW\"", "an IMR header");
  ImrHeader h;
  h.big_endian = bytes[8] != 0;
  const bool big = h.big_endian;
  h.gyro_increments = number_at<std::int32_t>(bytes, 17, big) != 0;
  h.accel_increments = number_at<std::int32_t>(bytes, 21, big) != 0;
  h.rate_hz = number_at<double>(bytes, 25, big);
  h.gyro_scale = number_at<double>(bytes, 33, big);
  h.accel_scale = number_at<double>(bytes, 41, big);
  h.utc = number_at<std::int32_t>(bytes, 49, big) == 1;
  h.time_bias = number_at<double>(bytes, 57, big);
  if (!(h.rate_hz > 0.0 && h.rate_hz < 1e5)) throw refuse(fmt::format("data rate {} Hz", h.rate_hz), "0 to 100 kHz");
  if (!std::isnormal(h.gyro_scale)) throw refuse(fmt::format("gyro scale {}", h.gyro_scale), "a factor that is not 0");
  if (!std::isnormal(h.accel_scale))
    throw refuse(fmt::format("accelerometer scale {}", h.accel_scale), "a factor that is not 0");
  if (!std::isfinite(h.time_bias)) throw refuse("time bias not finite", "seconds");
  return h;
}

Eigen::Vector3d counts(std::string_view bytes, std::size_t offset, bool big) {
  return {static_cast<double>(number_at<std::int32_t>(bytes, offset, big)),
          static_cast<double>(number_at<std::int32_t>(bytes, offset + 4, big)),
          static_cast<double>(number_at<std::int32_t>(bytes, offset + 8, big))};
}

record::ImuRecording read_imr(const ImuFileOptions& options, Format::Near near) {
  const std::string bytes = read_all(options.file);
  record::ImuRecording recording;
  recording.source = options.file.string();
  const ImrHeader h = parse_header(bytes, recording.source);
  // Rates are converted to increments of the nominal interval, so that both kinds are processed alike.
  const double gyro = h.gyro_scale * geo::kDegree / (h.gyro_increments ? 1.0 : h.rate_hz);
  const double accel = h.accel_scale / (h.accel_increments ? 1.0 : h.rate_hz);
  const std::size_t records = (bytes.size() - kHeader) / kRecordBytes;
  std::size_t index = 0;
  const auto error = [&](std::string found, std::string expected, std::string what_to_do) {
    return InputError(
        {recording.source, 0, fmt::format("record {}: {}", index + 1, found), std::move(expected), std::move(what_to_do)});
  };
  WeekClock clock(options.time, near, error);
  Repairs repairs;
  TimeOrder order(error, repairs);
  recording.samples.reserve(records);
  for (; index < records; ++index) {
    const std::size_t at = kHeader + index * kRecordBytes;
    record::ImuSample sample;
    sample.t = clock.at(number_at<double>(bytes, at, h.big_endian) + h.time_bias + options.time.offset_s);
    if (h.utc) sample.t = sample.t + geo::leap_seconds(sample.t);
    sample.dtheta = gyro * counts(bytes, at + 8, h.big_endian);
    sample.dv = accel * counts(bytes, at + 20, h.big_endian);
    require_possible(sample, error);
    auto& samples = recording.samples;
    const bool same = !samples.empty() && samples.back().dtheta == sample.dtheta && samples.back().dv == sample.dv;
    if (order.accept(sample.t, same)) samples.push_back(sample);
  }
  recording.events = clock.events();
  repairs.finish(static_cast<long>(records), recording.events);
  const std::size_t rest = (bytes.size() - kHeader) % kRecordBytes;
  if (rest != 0)
    recording.events.push_back({record::Event::Severity::kWarning, "trailing_garbage",
                                fmt::format("{}: the last {} bytes are no whole record; left out", recording.source, rest),
                                std::nullopt, 1});
  finish_imu(recording, true, options.time_tag);
  return recording;
}

bool sniff_imr(const FileHead& head) {
  return head.text.starts_with(kMagic);
}

}  // namespace

Format waypoint_imr_format() {
  return {"imr", "Waypoint IMR (Inertial Explorer)", sniff_imr, read_imr, {}, {}};
}

}  // namespace coast::io
