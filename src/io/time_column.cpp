#include "coast/io/time_column.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "text.hpp"

namespace coast::io {

namespace {

constexpr double kWeekSeconds = 604800.0;

/// Reads an unsigned integer and advances; none if there is no digit.
std::optional<int> take_int(std::string_view& s) {
  int value = 0;
  const auto [end, status] = std::from_chars(s.data(), s.data() + s.size(), value);
  if (status != std::errc() || value < 0) return std::nullopt;
  s.remove_prefix(static_cast<std::size_t>(end - s.data()));
  return value;
}

bool take_one_of(std::string_view& s, std::string_view characters) {
  if (s.empty() || characters.find(s.front()) == std::string_view::npos) return false;
  s.remove_prefix(1);
  return true;
}

/// yyyy-mm-dd, also with '/' or '.'.
bool take_date(std::string_view& s, geo::Calendar& c) {
  const auto year = take_int(s);
  if (!year || !take_one_of(s, "-/.")) return false;
  const auto month = take_int(s);
  if (!month || !take_one_of(s, "-/.")) return false;
  const auto day = take_int(s);
  if (!day) return false;
  c.year = *year;
  c.month = *month;
  c.day = *day;
  return true;
}

/// hh:mm:ss[.fff][Z]
bool take_clock(std::string_view& s, geo::Calendar& c) {
  const auto hour = take_int(s);
  if (!hour || !take_one_of(s, ":")) return false;
  const auto minute = take_int(s);
  if (!minute || !take_one_of(s, ":")) return false;
  if (!s.empty() && (s.back() == 'Z' || s.back() == 'z')) s.remove_suffix(1);
  const auto second = parse_number(s);
  if (!second || !std::isfinite(*second) || *second < 0.0) return false;
  c.hour = *hour;
  c.minute = *minute;
  c.second = *second;
  s = {};
  return true;
}

std::optional<geo::Calendar> parse_calendar(std::string_view date, std::string_view clock) {
  geo::Calendar c;
  if (!take_date(date, c)) return std::nullopt;
  if (clock.empty()) {
    if (!take_one_of(date, " T\t")) return std::nullopt;
    clock = trimmed(date);
  } else if (!date.empty()) {
    return std::nullopt;
  }
  if (!take_clock(clock, c)) return std::nullopt;
  return c;
}

bool is_calendar(TimeKind kind) {
  return kind == TimeKind::kGpst || kind == TimeKind::kUtc;
}

}  // namespace

int nearest_week(double seconds_of_week, geo::GpsTime near) {
  const double offset = near.sow() - seconds_of_week;
  return near.week() + static_cast<int>(std::lround(offset / kWeekSeconds));
}

TimeOptions TimeOptions::from(const config::Node& map) {
  TimeOptions o;
  o.file_key = map.where();
  if (const auto week = map.find("gps_week")) {
    const long value = week->integer();
    if (value < 0 || value > 9999) throw week->error(week->text(), "a GPS week without rollover, e.g. 2374", "");
    if (value > 0) o.gps_week = static_cast<int>(value);
  }
  const auto time = map.find("time");
  if (!time) return o;
  o.kind_given = time->find("kind").has_value();
  o.kind = static_cast<TimeKind>(time->choice("kind", {"sow", "week_sow", "gpst", "utc", "unix", "elapsed", "row"}, 0));
  static constexpr std::array<double, 4> kUnits = {1.0, 1e-3, 1e-6, 1e-9};
  o.unit_s = kUnits[time->choice("unit", {"s", "ms", "us", "ns"}, 0)];
  o.offset_s = time->number("offset_s", 0.0);
  if (o.kind == TimeKind::kRow) o.rate_hz = time->at("rate_hz").number();
  if (o.kind == TimeKind::kRow && o.rate_hz <= 0.0)
    throw time->at("rate_hz").error("a rate that is not positive", "> 0 Hz", "");
  return o;
}

bool TimeOptions::lacks_week() const {
  const bool seconds_only = kind == TimeKind::kSecondsOfWeek || kind == TimeKind::kElapsed || kind == TimeKind::kRow;
  return seconds_only && !gps_week;
}

WeekClock::WeekClock(const TimeOptions& options, std::optional<geo::GpsTime> near, MakeError error)
    : week_(options.gps_week), near_(near), unwrap_(options.kind != TimeKind::kElapsed), error_(std::move(error)) {}

geo::GpsTime WeekClock::at(double seconds) {
  if (!(std::abs(seconds) < 1e9))
    throw error_(fmt::format("time {} s", seconds), "seconds of week", "Is the unit of time right?");
  if (!week_) {
    if (!near_) throw error_("seconds of week without a GPS week", "", "State `gps_week:` beside the file.");
    week_ = nearest_week(seconds, *near_);
  } else if (started_ && unwrap_ && seconds - last_seconds_ < -0.9 * kWeekSeconds) {
    ++*week_;
    const geo::GpsTime t = geo::GpsTime::from_week(*week_, seconds);
    const auto text = fmt::format("seconds of week fall from {:.3f} to {:.3f}: taken as the begin of week {}", last_seconds_,
                                  seconds, *week_);
    events_.push_back({record::Event::Severity::kInfo, "week_rollover", error_(text, "", "").what(), t, 1});
  }
  started_ = true;
  last_seconds_ = seconds;
  return geo::GpsTime::from_week(*week_, seconds);
}

TimeColumn::TimeColumn(TableReader& table, const TimeOptions& options, const std::vector<Column>& columns,
                       std::optional<geo::GpsTime> near)
    : table_(table), options_(options), clock_(options, near, [&table](auto found, auto expected, auto what_to_do) {
        return table.error(found, expected, what_to_do);
      }) {
  if (options.lacks_week() && !near)
    throw InputError(
        {table.name(), 0, "seconds of week without a GPS week", "",
         options.kind == TimeKind::kSecondsOfWeek
             ? "State `gps_week:` beside the file, or give a partner file whose times carry a date."
             : "State `gps_week:` beside the file, any week where the true one is not known: times count from its begin."});
  const bool calendar = is_calendar(options.kind);
  const std::size_t least = options.kind == TimeKind::kRow ? 0 : options.kind == TimeKind::kWeekAndSeconds ? 2 : 1;
  const std::size_t most = calendar ? 2 : least;
  if (columns.size() < least || columns.size() > most)
    throw InputError({table.name(), 0, fmt::format("{} time columns", columns.size()),
                      least == most ? fmt::format("{}", least) : fmt::format("{} or {}", least, most),
                      "See `columns: {time: ..}`."});
  two_columns_ = columns.size() == 2;
  if (columns.empty()) return;
  slot_ = calendar ? table.text_slot(columns[0], "time") : table.number_slot(columns[0], "time");
  if (two_columns_) slot2_ = calendar ? table.text_slot(columns[1], "time") : table.number_slot(columns[1], "time");
}

geo::GpsTime TimeColumn::read() {
  const double offset = options_.offset_s;
  switch (options_.kind) {
    case TimeKind::kGpst:
    case TimeKind::kUtc:
      return from_text() + offset;
    case TimeKind::kUnix:
      // The offset is added afterwards: a double of POSIX seconds has no spare digits.
      return geo::GpsTime::from_unix_utc(table_.number(slot_) * options_.unit_s) + offset;
    case TimeKind::kWeekAndSeconds: {
      const double week = table_.number(slot_);
      if (week < 0.0 || week > 9999.0 || week != std::floor(week))
        throw table_.error(fmt::format("GPS week {}", week), "a whole number from 0 to 9999");
      if (week == 0.0) return clock_.at(table_.number(slot2_) * options_.unit_s + offset);
      return geo::GpsTime::from_week(static_cast<int>(week), table_.number(slot2_) * options_.unit_s) + offset;
    }
    case TimeKind::kRow:
      return clock_.at(offset + static_cast<double>(table_.rows() - 1) / options_.rate_hz);
    case TimeKind::kSecondsOfWeek:
    case TimeKind::kElapsed:
      break;
  }
  return clock_.at(table_.number(slot_) * options_.unit_s + offset);
}

geo::GpsTime TimeColumn::from_text() {
  const std::string_view date = table_.text(slot_);
  const std::string_view clock = two_columns_ ? table_.text(slot2_) : std::string_view{};
  const auto calendar = parse_calendar(date, clock);
  if (!calendar)
    throw table_.error(fmt::format("time \"{}{}{}\"", excerpt(date), two_columns_ ? " " : "", excerpt(clock)),
                       "a date and time like 2025-07-08 19:34:18.5");
  try {
    return options_.kind == TimeKind::kUtc ? geo::GpsTime::from_utc(*calendar) : geo::GpsTime::from_calendar(*calendar);
  } catch (const std::invalid_argument& e) {
    throw table_.error(e.what(), "a date and time in its range");
  }
}

void default_time_columns(const TableReader& table, TimeOptions& time, std::vector<Column>& columns) {
  if (!columns.empty() || time.kind == TimeKind::kRow) return;
  if (!time.kind_given && table.has("gps_week") && table.has("sow_s")) {
    time.kind = TimeKind::kWeekAndSeconds;
    columns = {"gps_week", "sow_s"};
  } else {
    columns = {"time_s"};
  }
}

}  // namespace coast::io
