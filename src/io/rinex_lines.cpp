#include "rinex_lines.hpp"

#include <fast_float/fast_float.h>
#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "coast/record/error.hpp"
#include "ephemerides.hpp"
#include "text.hpp"

namespace coast::io {

RinexLines::RinexLines(const std::filesystem::path& file) : lines_(file) {
  std::string_view line;
  if (!lines_.next(line)) refuse("an empty file", "RINEX");
  if (Hatanaka::begins(line)) {
    compact_ = std::make_unique<Hatanaka>(lines_, line);
    return;
  }
  first_ = line;
  first_waits_ = true;
}

bool RinexLines::next(std::string_view& line) {
  if (again_) {
    again_ = false;
  } else if (first_waits_) {
    first_waits_ = false;
    line_ = first_;
  } else if (!(compact_ ? compact_->next(line_) : lines_.next(line_))) {
    return false;
  }
  line = line_;
  return true;
}

void RinexLines::refuse(std::string found, std::string expected, std::string what_to_do) const {
  throw InputError({name(), lines_.line_number(), std::move(found), std::move(expected), std::move(what_to_do)});
}

std::string_view field(std::string_view line, std::size_t at, std::size_t width) {
  return at < line.size() ? line.substr(at, width) : std::string_view();
}

std::optional<int> integer_field(std::string_view line, std::size_t at, std::size_t width) {
  const std::string_view text = trimmed(field(line, at, width));
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<double> number_field(std::string_view line, std::size_t at, std::size_t width) {
  constexpr std::size_t kLongest = 32;
  const std::string_view text = trimmed(field(line, at, width));
  if (text.empty() || text.size() > kLongest) return std::nullopt;
  std::array<char, kLongest> copy{};
  for (std::size_t i = 0; i < text.size(); ++i) copy[i] = text[i] == 'D' || text[i] == 'd' ? 'E' : text[i];
  const char* begin = copy.data() + (copy[0] == '+' ? 1 : 0);
  const char* end = copy.data() + text.size();
  double value = 0.0;
  const auto [stop, error] = fast_float::from_chars(begin, end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string in_quotes(std::string_view text, std::size_t length) {
  return fmt::format("'{}'", excerpt(text, length));
}

std::string_view label_of(std::string_view line) {
  return trimmed(field(line, 60, 20));
}

RinexKind read_kind(RinexLines& lines) {
  std::string_view line;
  if (!lines.next(line) || label_of(line) != "RINEX VERSION / TYPE")
    lines.refuse(in_quotes(line), "RINEX VERSION / TYPE in columns 61 to 80 of the first line", "This is no RINEX file.");
  const auto version = number_field(line, 0, 9);
  if (!version || *version < 2.0 || *version >= 5.0)
    lines.refuse(fmt::format("RINEX version {}", in_quotes(trimmed(field(line, 0, 9)))), "2.0 to 4.x");
  const auto letter = [&](std::size_t at) { return at < line.size() ? line[at] : ' '; };
  return {static_cast<int>(*version), letter(20), letter(40), in_quotes(trimmed(field(line, 20, 20)))};
}

std::optional<record::Satellite> satellite_field(std::string_view text, char system) {
  if (text.size() < 2) return std::nullopt;
  if (text.size() > 2 && text[0] != ' ') {
    system = text[0];
    text.remove_prefix(1);
  }
  const auto found = record::system_of(system == ' ' ? 'G' : system);
  const auto number = integer_field(text, 0, text.size());
  if (!found || !number || *number < 1 || *number > 99) return std::nullopt;
  return record::Satellite{*found, static_cast<std::uint8_t>(*number)};
}

std::optional<geo::GpsTime> gps_time(const geo::Calendar& calendar, RinexTime scale) {
  try {
    switch (scale) {
      case RinexTime::kGps:
        return geo::GpsTime::from_calendar(calendar);
      case RinexTime::kUtc:
        return geo::GpsTime::from_utc(calendar);
      case RinexTime::kBeidou:
        return geo::GpsTime::from_calendar(calendar) + kGpsMinusBeidou;
    }
  } catch (const std::invalid_argument&) {
    // No date.
  }
  return std::nullopt;
}

int full_year(int year) {
  constexpr int kTurn = 80;
  if (year >= 100) return year;
  return year < kTurn ? 2000 + year : 1900 + year;
}

}  // namespace coast::io
