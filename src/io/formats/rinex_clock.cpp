#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "../file_kind.hpp"
#include "../rinex_lines.hpp"
#include "../text.hpp"
#include "coast/io/products.hpp"
#include "coast/record/error.hpp"

namespace coast::io {

namespace {

class ClockReader {
 public:
  ClockReader(const std::filesystem::path& file, record::PreciseClocks& clocks) : lines_(file), clocks_(clocks) {}

  void read() {
    read_header();
    std::string_view line;
    while (lines_.next(line))
      if (line.starts_with("AS ")) read_satellite(line);
    if (satellites_ == 0) refuse("no clock of a satellite", "lines that begin with 'AS'");
    for (const auto& event : lines_.events()) clocks_.events.push_back(event);
    if (spoiled_ > 0)
      clocks_.events.push_back(
          {record::Event::Severity::kWarning, "clocks_spoiled",
           fmt::format("{}: {} line{} that cannot be read left out", lines_.name(), spoiled_, spoiled_ == 1 ? "" : "s"),
           std::nullopt, spoiled_});
  }

 private:
  [[noreturn]] void refuse(std::string found, std::string expected, std::string what_to_do = "") const {
    throw InputError({lines_.name(), lines_.line_number(), std::move(found), std::move(expected), std::move(what_to_do)});
  }

  /// Version 3.04 has its labels five columns further right, and names of nine characters.
  void read_header() {
    std::string_view line;
    if (!lines_.next(line) || line.find("RINEX VERSION / TYPE") == std::string_view::npos ||
        line.substr(0, 45).find('C') == std::string_view::npos)
      refuse(in_quotes(line), "a RINEX clock file: type C", "This is no file of clocks.");
    const std::string_view version = trimmed(field(line, 0, 9));
    wide_ = version == "3.04";
    while (lines_.next(line)) {
      if (line.find("TIME SYSTEM ID") != std::string_view::npos) read_scale(line);
      if (line.find("END OF HEADER") != std::string_view::npos) return;
    }
    refuse("the end of the file", "END OF HEADER", "The header is cut off.");
  }
  void read_scale(std::string_view line) {
    const std::string_view scale = trimmed(field(line, 0, 9));
    if (scale == "UTC" || scale == "GLO") scale_ = RinexTime::kUtc;
    if (scale == "BDT" || scale == "BDS") scale_ = RinexTime::kBeidou;
    if (scale == "TAI") refuse("times in TAI", "GPS, UTC, GLO, GAL, QZS or BDT");
  }

  void read_satellite(std::string_view line) {
    constexpr double kLargest = 1.0;  // s
    const std::size_t at = wide_ ? 13 : 8;
    const auto satellite = satellite_field(trimmed(field(line, 3, at - 4)), 'G');
    std::array<std::optional<int>, 5> date;
    date[0] = integer_field(line, at, 4);
    for (std::size_t i = 1; i < date.size(); ++i) date.at(i) = integer_field(line, at + 2 + 3 * i, 3);
    const auto second = number_field(line, at + 16, 10);
    const auto clock = number_field(line, wide_ ? 45 : 40, 20);
    if (!satellite || !second || !clock || std::ranges::any_of(date, [](const auto& v) { return !v; })) {
      ++spoiled_;
      return;
    }
    const auto t = gps_time({*date[0], *date[1], *date[2], *date[3], *date[4], *second}, scale_);
    if (!t || !(std::abs(*clock) < kLargest)) {
      ++spoiled_;
      return;
    }
    clocks_.points[*satellite].push_back({*t, *clock});
    ++satellites_;
  }

  LineReader lines_;
  record::PreciseClocks& clocks_;
  RinexTime scale_ = RinexTime::kGps;
  bool wide_ = false;
  long satellites_ = 0, spoiled_ = 0;
};

}  // namespace

record::PreciseClocks read_clocks(const std::vector<std::filesystem::path>& files) {
  record::PreciseClocks clocks;
  for (const auto& file : files) {
    read_as(file, FileKind::Content::kRinex, "RINEX clocks", [&] { ClockReader(file, clocks).read(); });
    clocks.source += (clocks.source.empty() ? "" : ", ") + file.string();
  }
  for (auto& [satellite, points] : clocks.points) {
    std::ranges::stable_sort(points, {}, &record::ClockPoint::t);
    const auto same = [](const record::ClockPoint& a, const record::ClockPoint& b) { return a.t == b.t; };
    points.erase(std::unique(points.begin(), points.end(), same), points.end());
  }
  return clocks;
}

}  // namespace coast::io
