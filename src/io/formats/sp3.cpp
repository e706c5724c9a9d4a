#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "../file_kind.hpp"
#include "../rinex_lines.hpp"
#include "../text.hpp"
#include "coast/io/products.hpp"
#include "coast/record/error.hpp"

namespace coast::io {

namespace {

class Sp3Reader {
 public:
  Sp3Reader(const std::filesystem::path& file, record::PreciseOrbits& orbits) : lines_(file), orbits_(orbits) {}

  void read() {
    std::string_view line;
    if (!lines_.next(line) || line.size() < 3 || line[0] != '#' || line[1] < 'a' || line[1] > 'd' ||
        (line[2] != 'P' && line[2] != 'V'))
      refuse(in_quotes(line), "#aP to #dV at the begin of the first line", "This is no SP3 file.");
    while (lines_.next(line)) {
      if (line.starts_with("%c") && !has_scale_) read_scale(line);
      if (line.starts_with("* ")) read_epoch(line);
      if (line.starts_with("P")) read_position(line);
      if (line.starts_with("EOF")) break;
    }
    if (!epoch_) refuse("no epoch", "lines that begin with '*'");
    for (const auto& event : lines_.events()) orbits_.events.push_back(event);
    if (spoiled_ > 0)
      orbits_.events.push_back(
          {record::Event::Severity::kWarning, "sp3_spoiled",
           fmt::format("{}: {} line{} that cannot be read left out", lines_.name(), spoiled_, spoiled_ == 1 ? "" : "s"),
           std::nullopt, spoiled_});
  }

 private:
  [[noreturn]] void refuse(std::string found, std::string expected, std::string what_to_do = "") const {
    throw InputError({lines_.name(), lines_.line_number(), std::move(found), std::move(expected), std::move(what_to_do)});
  }

  void read_scale(std::string_view line) {
    has_scale_ = true;
    const std::string_view scale = field(line, 9, 3);
    if (scale == "UTC" || scale == "GLO") scale_ = RinexTime::kUtc;
    if (scale == "BDT") scale_ = RinexTime::kBeidou;
    if (scale == "TAI") refuse("times in TAI", "GPS, UTC, GLO, GAL, QZS or BDT");
  }

  void read_epoch(std::string_view line) {
    const auto year = integer_field(line, 3, 4), month = integer_field(line, 8, 2), day = integer_field(line, 11, 2);
    const auto hour = integer_field(line, 14, 2), minute = integer_field(line, 17, 2);
    const auto second = number_field(line, 20, 11);
    if (year && month && day && hour && minute && second)
      epoch_ = gps_time({*year, *month, *day, *hour, *minute, *second}, scale_);
    else
      epoch_.reset();
    if (!epoch_) refuse(in_quotes(line), "a date and a time");
  }

  void read_position(std::string_view line) {
    constexpr double kKilometre = 1000.0;
    constexpr double kMicrosecond = 1e-6;
    constexpr double kNoClock = 999999.0;
    constexpr std::size_t kColumn = 14;
    const auto satellite = satellite_field(field(line, 1, 3), 'G');
    const auto x = number_field(line, 4, kColumn), y = number_field(line, 4 + kColumn, kColumn);
    const auto z = number_field(line, 4 + 2 * kColumn, kColumn), clock = number_field(line, 4 + 3 * kColumn, kColumn);
    constexpr double kGround = 6.4e6;  // m
    constexpr double kBeyond = 1e8;    // m
    if (!epoch_ || !satellite || !x || !y || !z) {
      ++spoiled_;
      return;
    }
    record::OrbitPoint point{*epoch_, kKilometre * Eigen::Vector3d(*x, *y, *z), {}};
    if (point.r_e.isZero()) return;  // bad or absent
    if (point.r_e.norm() < kGround || point.r_e.norm() > kBeyond) {
      ++spoiled_;
      return;
    }
    if (clock && std::abs(*clock) < kNoClock) point.clock_s = kMicrosecond * *clock;
    orbits_.points[*satellite].push_back(point);
  }

  LineReader lines_;
  record::PreciseOrbits& orbits_;
  RinexTime scale_ = RinexTime::kGps;
  bool has_scale_ = false;
  std::optional<geo::GpsTime> epoch_;
  long spoiled_ = 0;
};

}  // namespace

record::PreciseOrbits read_sp3(const std::vector<std::filesystem::path>& files) {
  record::PreciseOrbits orbits;
  for (const auto& file : files) {
    read_as(file, FileKind::Content::kOrbits, "an SP3 file of precise orbits", [&] { Sp3Reader(file, orbits).read(); });
    orbits.source += (orbits.source.empty() ? "" : ", ") + file.string();
  }
  for (auto& [satellite, points] : orbits.points) {
    std::ranges::stable_sort(points, {}, &record::OrbitPoint::t);
    const auto same = [](const record::OrbitPoint& a, const record::OrbitPoint& b) { return a.t == b.t; };
    points.erase(std::unique(points.begin(), points.end(), same), points.end());
  }
  return orbits;
}

}  // namespace coast::io
