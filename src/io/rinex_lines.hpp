#pragma once
// Lines and fields of RINEX files. Private to the room.

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "coast/geo/time.hpp"
#include "coast/record/satellite.hpp"
#include "hatanaka.hpp"

namespace coast::io {

/// Lines of a RINEX file, compact or not.
class RinexLines {
 public:
  explicit RinexLines(const std::filesystem::path& file);
  /// The next line; the view holds until the next call.
  [[nodiscard]] bool next(std::string_view& line);
  /// Repeats the last line at the next call.
  void put_back() { again_ = true; }
  [[nodiscard]] const std::string& name() const { return lines_.name(); }
  [[nodiscard]] const record::Events& events() const { return lines_.events(); }
  [[noreturn]] void refuse(std::string found, std::string expected, std::string what_to_do = "") const;

 private:
  LineReader lines_;
  std::unique_ptr<Hatanaka> compact_;
  std::string first_;
  bool first_waits_ = false;
  std::string_view line_;
  bool again_ = false;
};

/// Text of a field; beyond the end of the line it is blank.
[[nodiscard]] std::string_view field(std::string_view line, std::size_t at, std::size_t width);
[[nodiscard]] std::optional<int> integer_field(std::string_view line, std::size_t at, std::size_t width);
/// With D or E as exponent letter. Finite.
[[nodiscard]] std::optional<double> number_field(std::string_view line, std::size_t at, std::size_t width);
/// An excerpt in quotation marks, for messages.
[[nodiscard]] std::string in_quotes(std::string_view text, std::size_t length = 40);
/// Columns 61 to 80 of a header line.
[[nodiscard]] std::string_view label_of(std::string_view line);

/// Content of the first line of a RINEX file.
struct RinexKind {
  int major = 0;       ///< version: 2, 3 or 4
  char type = ' ';     ///< 'O' observations, 'N' navigation messages; of version 2 also 'G' and 'H'
  char system = ' ';   ///< of all satellites, 'M' for several
  std::string stated;  ///< the type as in the file, for messages
};
/// @throws InputError  the first line is not of RINEX, or of an unknown version
[[nodiscard]] RinexKind read_kind(RinexLines& lines);

/// "G05", "G 5", " 5" (of `system`)
[[nodiscard]] std::optional<record::Satellite> satellite_field(std::string_view text, char system);

enum class RinexTime { kGps, kUtc, kBeidou };
/// Calendar fields to GPS time; none if invalid.
[[nodiscard]] std::optional<geo::GpsTime> gps_time(const geo::Calendar& calendar, RinexTime scale);
/// 2021 from 21, 1999 from 99 and from 1999
[[nodiscard]] int full_year(int year);

}  // namespace coast::io
