// Raw binary IMU records: rows of numbers of one type, columns by number, counts scaled by the configuration.

#include "../binary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "../imu_builder.hpp"
#include "../repairs.hpp"
#include "coast/io/input.hpp"
#include "formats.hpp"

namespace coast::io {

namespace {

using Type = BinaryLayout::Type;

std::size_t size_of(Type type) {
  return type == Type::kI16 ? 2 : type == Type::kF64 ? 8 : 4;
}

double value_at(std::string_view bytes, std::size_t offset, Type type, bool big) {
  switch (type) {
    case Type::kI16:
      return number_at<std::int16_t>(bytes, offset, big);
    case Type::kI32:
      return number_at<std::int32_t>(bytes, offset, big);
    case Type::kF32:
      return static_cast<double>(number_at<float>(bytes, offset, big));
    case Type::kF64:
      break;
  }
  return number_at<double>(bytes, offset, big);
}

/// Columns by number, checked against the row length.
class BinaryRows {
 public:
  BinaryRows(const ImuFileOptions& options, std::string_view bytes)
      : layout_(options.binary), bytes_(bytes), name_(options.file.string()) {
    if (options.gyro_columns.empty())
      throw InputError({name_, 0, "binary data without a layout", "`columns: {gyro: [1, 2, 3], accel: [4, 5, 6]}`", ""});
    auto all = options.gyro_columns;
    all.insert(all.end(), options.accel_columns.begin(), options.accel_columns.end());
    all.insert(all.end(), options.time_columns.begin(), options.time_columns.end());
    int highest = 0;
    for (const Column& column : all) {
      if (column.number == 0)
        throw InputError({name_, 0, fmt::format("column \"{}\"", column.name), "a number: binary has no header", ""});
      highest = std::max(highest, column.number);
    }
    row_ = layout_.row > 0 ? layout_.row : highest;
    if (highest > row_)
      throw InputError({name_, 0, fmt::format("column {}", highest), fmt::format("at most {} (`row`)", row_), ""});
    const bool by_row = options.time.kind == TimeKind::kRow;
    if (!by_row && (options.time_columns.size() != 1 || options.time.kind == TimeKind::kWeekAndSeconds ||
                    options.time.kind == TimeKind::kGpst || options.time.kind == TimeKind::kUtc))
      throw InputError(
          {name_, 0, "binary data without one time column", "`time: {kind: row, rate_hz: ..}`, or a column of seconds", ""});
    begin_ = static_cast<std::size_t>(layout_.header_bytes);
    if (begin_ > bytes.size())
      throw InputError(
          {name_, 0, fmt::format("{} bytes", bytes.size()), fmt::format("more than `header_bytes: {}`", begin_), ""});
  }

  [[nodiscard]] std::size_t row_bytes() const { return static_cast<std::size_t>(row_) * size_of(layout_.type); }
  [[nodiscard]] std::size_t rows() const { return (bytes_.size() - begin_) / row_bytes(); }
  [[nodiscard]] std::size_t rest() const { return (bytes_.size() - begin_) % row_bytes(); }
  [[nodiscard]] double value(std::size_t row, const Column& column) const {
    const std::size_t offset = begin_ + row * row_bytes() + static_cast<std::size_t>(column.number - 1) * size_of(layout_.type);
    return value_at(bytes_, offset, layout_.type, layout_.big_endian);
  }
  [[nodiscard]] Eigen::Vector3d vector(std::size_t row, const std::vector<Column>& columns) const {
    return {value(row, columns[0]), value(row, columns[1]), value(row, columns[2])};
  }

 private:
  const BinaryLayout& layout_;
  std::string_view bytes_;
  std::string name_;
  int row_ = 0;
  std::size_t begin_ = 0;
};

record::ImuRecording read_binary(const ImuFileOptions& options, Format::Near near) {
  const std::string bytes = read_all(options.file);
  const BinaryRows rows(options, bytes);
  record::ImuRecording recording;
  recording.source = options.file.string();
  std::size_t row = 0;
  const auto error = [&](std::string found, std::string expected, std::string what_to_do) {
    return InputError(
        {recording.source, 0, fmt::format("record {}: {}", row + 1, found), std::move(expected), std::move(what_to_do)});
  };
  const TimeOptions& time = options.time;
  WeekClock clock(time, near, error);
  Repairs repairs;
  TimeOrder order(error, repairs);
  recording.samples.reserve(rows.rows());
  for (; row < rows.rows(); ++row) {
    record::ImuSample sample;
    sample.dtheta = options.gyro_to_si * rows.vector(row, options.gyro_columns);
    sample.dv = options.accel_to_si * rows.vector(row, options.accel_columns);
    const double value = time.kind == TimeKind::kRow ? static_cast<double>(row) / time.rate_hz
                                                     : rows.value(row, options.time_columns[0]) * time.unit_s;
    if (!sample.dtheta.allFinite() || !sample.dv.allFinite() || !std::isfinite(value)) {
      repairs.add("nan_row", "with a value that is not finite left out", 0.01,
                  error("a value that is not finite", "numbers", ""), std::nullopt);
      continue;
    }
    require_possible(sample, error);
    sample.t =
        time.kind == TimeKind::kUnix ? geo::GpsTime::from_unix_utc(value) + time.offset_s : clock.at(value + time.offset_s);
    auto& samples = recording.samples;
    const bool same = !samples.empty() && samples.back().dtheta == sample.dtheta && samples.back().dv == sample.dv;
    if (order.accept(sample.t, same)) samples.push_back(sample);
  }
  recording.events = clock.events();
  repairs.finish(static_cast<long>(rows.rows()), recording.events);
  if (rows.rest() != 0)
    recording.events.push_back(
        {record::Event::Severity::kWarning, "trailing_garbage",
         fmt::format("{}: the last {} bytes are no whole record; left out", recording.source, rows.rest()), std::nullopt, 1});
  finish_imu(recording, options.increments, options.time_tag);
  return recording;
}

}  // namespace

Format binary_format() {
  return {"binary", "raw binary records; layout under `binary:`", {}, read_binary, {}, {}};
}

}  // namespace coast::io
