#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "../file_kind.hpp"
#include "../rinex_lines.hpp"
#include "../text.hpp"
#include "coast/geo/units.hpp"
#include "coast/io/products.hpp"
#include "coast/record/error.hpp"

namespace coast::io {

namespace {

constexpr double kMillimetre = 1e-3;

class AntexReader {
 public:
  explicit AntexReader(const std::filesystem::path& file) : lines_(file) { table_.source = lines_.name(); }

  record::AntennaTable read() {
    std::string_view line;
    if (!lines_.next(line) || label_of(line) != "ANTEX VERSION / SYST")
      refuse(in_quotes(line), "ANTEX VERSION / SYST", "This is no ANTEX file.");
    while (lines_.next(line)) {
      const std::string_view label = label_of(line);
      if (label == "PCV TYPE / REFANT" && !line.starts_with('A'))
        refuse("relative phase centres", "absolute ones", "Absolute calibrations are in use since 2006.");
      if (label == "START OF ANTENNA") read_antenna();
    }
    if (table_.antennas.empty()) refuse("no antenna that can be used", "one or more");
    for (const auto& event : lines_.events()) table_.events.push_back(event);
    if (spoiled_ > 0)
      table_.events.push_back(
          {record::Event::Severity::kWarning, "antex_spoiled",
           fmt::format("{}: {} antenna{} that cannot be read left out", lines_.name(), spoiled_, spoiled_ == 1 ? "" : "s"),
           std::nullopt, spoiled_});
    return std::move(table_);
  }

 private:
  [[noreturn]] void refuse(std::string found, std::string expected, std::string what_to_do = "") const {
    throw InputError({lines_.name(), lines_.line_number(), std::move(found), std::move(expected), std::move(what_to_do)});
  }

  /// The columns of an antenna's tables.
  struct Grid {
    double azimuth_step = 0.0;  ///< deg, 0: no rows by azimuth
    double first = 0.0, last = 0.0, step = 0.0;
    [[nodiscard]] std::size_t columns() const {
      return step > 0.0 ? static_cast<std::size_t>(std::lround((last - first) / step)) + 1 : 0;
    }
    [[nodiscard]] bool possible() const {
      constexpr double kLeast = 0.1, kMost = 180.0;  // deg
      return azimuth_step >= 0.0 && azimuth_step <= 360.0 && (azimuth_step == 0.0 || azimuth_step >= kLeast) &&
             step >= kLeast && first >= 0.0 && last > first && last <= kMost;
    }
  };

  void read_antenna() {
    record::AntennaCalibration antenna;
    Grid grid;
    bool whole = true;
    std::string_view line;
    while (lines_.next(line)) {
      const std::string_view label = label_of(line);
      if (label == "END OF ANTENNA") break;
      if (label == "TYPE / SERIAL NO") {
        antenna.type = field(line, 0, 20);
        antenna.type.resize(20, ' ');
        antenna.satellite = satellite_field(trimmed(field(line, 20, 20)), 'G');
      } else if (label == "DAZI") {
        grid.azimuth_step = number_field(line, 2, 6).value_or(-1.0);
      } else if (label == "ZEN1 / ZEN2 / DZEN") {
        grid.first = number_field(line, 2, 6).value_or(-1.0);
        grid.last = number_field(line, 8, 6).value_or(-1.0);
        grid.step = number_field(line, 14, 6).value_or(-1.0);
      } else if (label == "VALID FROM") {
        antenna.from = time_of(line);
      } else if (label == "VALID UNTIL") {
        antenna.until = time_of(line);
      } else if (label == "START OF FREQUENCY") {
        whole = read_band(line, grid, antenna) && whole;
      } else if (label == "START OF FREQ RMS") {
        while (lines_.next(line) && label_of(line) != "END OF FREQ RMS") continue;
      }
    }
    if (whole && !antenna.bands.empty())
      table_.antennas.push_back(std::move(antenna));
    else
      ++spoiled_;
  }

  std::optional<geo::GpsTime> time_of(std::string_view line) const {
    std::array<std::optional<int>, 5> date;
    for (std::size_t i = 0; i < date.size(); ++i) date.at(i) = integer_field(line, 6 * i, 6);
    const auto second = number_field(line, 30, 13);
    if (!second || std::ranges::any_of(date, [](const auto& v) { return !v; })) return std::nullopt;
    return gps_time({*date[0], *date[1], *date[2], *date[3], *date[4], std::min(*second, 59.999)}, RinexTime::kGps);
  }

  /// "G01" is the first band of GPS.
  bool read_band(std::string_view line, const Grid& grid, record::AntennaCalibration& antenna) {
    const std::string band(field(line, 3, 3));
    const auto system = band.size() == 3 ? record::system_of(band[0]) : std::nullopt;
    record::PhaseCentre centre;
    bool whole = system && grid.possible();
    std::vector<double> mean;
    while (lines_.next(line)) {
      const std::string_view label = label_of(line);
      if (label == "END OF FREQUENCY" || label == "END OF ANTENNA") break;
      if (label == "NORTH / EAST / UP") {
        for (std::size_t i = 0; i < 3; ++i) {
          const auto value = number_field(line, 10 * i, 10);
          whole = whole && value;
          centre.offset(static_cast<Eigen::Index>(i)) = kMillimetre * value.value_or(0.0);
        }
      } else if (whole) {
        std::vector<double> row = row_of(line, grid.columns());
        if (row.empty()) {
          whole = false;
        } else if (trimmed(field(line, 0, 8)) == "NOAZI") {
          mean = std::move(row);
        } else {
          centre.variations.push_back(std::move(row));
        }
      }
    }
    const auto rows = grid.azimuth_step > 0.0 ? static_cast<std::size_t>(std::lround(360.0 / grid.azimuth_step)) + 1 : 0;
    if (!whole || mean.empty() || centre.variations.size() != rows) return false;
    if (rows == 0) centre.variations = {mean};
    centre.first = geo::kDegree * grid.first;
    centre.step = geo::kDegree * grid.step;
    antenna.bands[{*system, band[2]}] = std::move(centre);
    return true;
  }

  /// m; empty if a number is missing.
  static std::vector<double> row_of(std::string_view line, std::size_t columns) {
    constexpr std::size_t kWidth = 8;
    std::vector<double> row;
    for (std::size_t i = 0; i < columns; ++i) {
      const auto value = number_field(line, kWidth * (i + 1), kWidth);
      if (!value) return {};
      row.push_back(kMillimetre * *value);
    }
    return row;
  }

  LineReader lines_;
  record::AntennaTable table_;
  long spoiled_ = 0;
};

}  // namespace

record::AntennaTable read_antex(const std::filesystem::path& file) {
  return read_as(file, FileKind::Content::kOther, "an ANTEX file of antennas", [&] { return AntexReader(file).read(); });
}

}  // namespace coast::io
