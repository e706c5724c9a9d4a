// Raw IMU samples of SPAN receivers: RAWIMU, RAWIMUS, RAWIMUX, RAWIMUSX (OEM7 Commands and Logs Reference Manual). Counts of
// increments over the sample's interval, in the order z, -y, x; axes are those printed on the IMU.

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "../counted.hpp"
#include "../imu_builder.hpp"
#include "../repairs.hpp"
#include "novatel_imu_types.hpp"
#include "novatel_log.hpp"
#include "novatel_readers.hpp"

namespace coast::io {

namespace {

bool is_extended(std::uint32_t id) {
  return id == novatel::kRawImuX || id == novatel::kRawImuSX;
}

bool is_raw_imu(std::uint32_t id) {
  return is_extended(id) || id == novatel::kRawImu || id == novatel::kRawImuS;
}

struct NovAtelImuSample {
  std::optional<geo::GpsTime> t;
  std::optional<std::uint32_t> type;
  bool error = false;           ///< the IMU itself has found one
  Eigen::Vector3d gyro, accel;  ///< counts
};

std::optional<NovAtelImuSample> sample_of(const NovAtelLog& log) {
  NovAtelFields f = log.fields();
  NovAtelImuSample sample;
  std::uint32_t week = 0;
  if (is_extended(log.id)) {
    sample.error = (f.hex8() & 1U) != 0;
    sample.type = f.u8();
    week = f.u16();
  } else {
    week = f.u32();
  }
  const auto t = novatel_time(week, f.f64());
  if (log.timed()) sample.t = t;
  static_cast<void>(f.hex32());  // status
  const auto triad = [&f] {
    const double z = f.i32(), minus_y = f.i32(), x = f.i32();
    return Eigen::Vector3d(x, -minus_y, z);
  };
  sample.accel = triad();
  sample.gyro = triad();
  return f.good() ? std::optional(sample) : std::nullopt;
}

/// INSCONFIG and SETIMUTYPE begin with the type.
std::optional<std::uint32_t> configured_type(const NovAtelLog& log) {
  NovAtelFields f = log.fields();
  const std::string_view name = f.name();
  if (!f.good()) return std::nullopt;
  if (const auto type = novatel_imu_type(name)) return type->number;
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error != std::errc() || end != name.data() + name.size()) return std::nullopt;
  return number;
}

class NovAtelImuReader {
 public:
  explicit NovAtelImuReader(const ImuFileOptions& options)
      : options_(options), stream_(options.file), order_(error_, repairs_) {}

  record::ImuRecording read() {
    recording_.source = stream_.name();
    NovAtelLog log;
    while (stream_.next(log)) take(log);
    if (recording_.samples.size() < 2) refuse();
    scale();
    finish();
    return std::move(recording_);
  }

 private:
  void take(const NovAtelLog& log);
  void take_type(std::optional<std::uint32_t> type);
  void scale();
  void finish();
  [[nodiscard]] bool own_factors() const { return options_.gyro_to_si != 1.0 || options_.accel_to_si != 1.0; }
  [[noreturn]] void refuse() const;
  [[noreturn]] void refuse_type() const;

  const ImuFileOptions& options_;
  NovAtelStream stream_;
  record::ImuRecording recording_;  ///< counts until `scale`
  Repairs repairs_;
  WeekClock::MakeError error_ = [this](auto found, auto expected, auto what_to_do) {
    return InputError({stream_.name(), 0, fmt::format("IMU sample {}: {}", rows_, found), expected, what_to_do});
  };
  TimeOrder order_;
  std::optional<std::uint32_t> type_;
  std::optional<bool> extended_;  ///< which logs the recording is of
  long rows_ = 0, no_time_ = 0, spoiled_ = 0;
  Counted errors_;
};

void NovAtelImuReader::take(const NovAtelLog& log) {
  if (log.id == novatel::kInsConfig || log.id == novatel::kSetImuType) return take_type(configured_type(log));
  // A recording is of one kind: that of its first sample.
  if (!is_raw_imu(log.id) || is_extended(log.id) != extended_.value_or(is_extended(log.id))) return;
  const auto sample = sample_of(log);
  if (!sample) {
    ++spoiled_;
    return;
  }
  ++rows_;
  take_type(sample->type);
  if (!sample->t) {
    ++no_time_;
    return;
  }
  extended_ = is_extended(log.id);
  const record::ImuSample row{*sample->t + options_.time.offset_s, 0.0, sample->gyro, sample->accel};
  if (sample->error) return errors_.add(row.t);
  auto& samples = recording_.samples;
  const bool same = !samples.empty() && samples.back().dtheta == row.dtheta && samples.back().dv == row.dv;
  if (order_.accept(row.t, same)) samples.push_back(row);
}

void NovAtelImuReader::take_type(std::optional<std::uint32_t> type) {
  if (!type || *type == 0) return;
  if (type_ && *type_ != *type)
    throw InputError({stream_.name(), 0, fmt::format("an IMU of type {} after one of type {}", *type, *type_), "one IMU",
                      "Two recordings in one file? Split it."});
  type_ = type;
}

void NovAtelImuReader::scale() {
  double gyro = options_.gyro_to_si, accel = options_.accel_to_si;
  if (!own_factors()) {
    const auto type = type_ ? novatel_imu_type(*type_) : std::nullopt;
    if (!type || type->gyro == 0.0) refuse_type();
    gyro = type->gyro;
    accel = type->accel;
  }
  for (record::ImuSample& sample : recording_.samples) {
    sample.dtheta *= gyro;
    sample.dv *= accel;
    require_possible(sample, error_);
  }
}

void NovAtelImuReader::refuse_type() const {
  const auto type = type_ ? novatel_imu_type(*type_) : std::nullopt;
  throw InputError({stream_.name(), 0,
                    !type_ ? std::string("counts of an IMU whose type no log states")
                    : type ? fmt::format("counts of an IMU {}, whose scale factors coast does not know", type->name)
                           : fmt::format("counts of an IMU of type {}, which coast does not know", *type_),
                    "RAWIMUX or RAWIMUSX, or INSCONFIG beside RAWIMU",
                    "State what a count is, from the table \"Raw IMU Scale Factors\" of NovAtel's manual: `values: increments, "
                    "units: {gyro: rad, accel: m/s}, scale: {gyro: 1.1641532e-10, accel: 2.2710502e-9}`."});
}

void NovAtelImuReader::finish() {
  recording_.events = stream_.events();
  repairs_.finish(rows_, recording_.events);
  using enum record::Event::Severity;
  const auto add = [&](const Counted& counted, const char* kind, const char* what, record::Event::Severity severity) {
    add_counted(recording_.events, recording_.source, counted, {kind, "IMU sample", "IMU samples", what, severity});
  };
  add({no_time_}, "imu_no_time", "before the receiver knew GPS time left out", kInfo);
  add({spoiled_}, "imu_spoiled", "not of the form of its log left out", kWarning);
  add(errors_, "imu_error", "in which the IMU has found an error left out", kWarning);
  finish_imu(recording_, !own_factors() || options_.increments, options_.time_tag);
}

void NovAtelImuReader::refuse() const {
  if (rows_ > 1)
    throw InputError({stream_.name(), 0, fmt::format("{} IMU samples, {} of them without GPS time", rows_, no_time_),
                      "samples with GPS time", "Had the receiver a position when they were recorded?"});
  const long corrected = stream_.number(novatel::kCorrImuData) + stream_.number(novatel::kCorrImuDataS) +
                         stream_.number(novatel::kImuRateCorrImuS);
  if (corrected > 0)
    throw InputError(
        {stream_.name(), 0, fmt::format("{} logs of CORRIMUDATA or IMURATECORRIMUS, but no raw IMU", corrected), "RAWIMUSX",
         "The receiver has taken gravity and the rotation of the Earth out of these: they are no measurements that "
         "a navigation could start from."});
  throw InputError(
      {stream_.name(), 0, fmt::format("{} IMU samples in NovAtel logs", rows_), "RAWIMUSX, RAWIMUX, RAWIMUS or RAWIMU", ""});
}

}  // namespace

record::ImuRecording read_novatel_imu(const ImuFileOptions& options, Format::Near) {
  return NovAtelImuReader(options).read();
}

}  // namespace coast::io
