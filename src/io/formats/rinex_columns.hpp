#pragma once
// Columns of a RINEX observation file, from its header. Private to the room.

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "../rinex_lines.hpp"
#include "coast/record/observation.hpp"

namespace coast::io {

/// Content of one column of a satellite's record.
struct ObservationType {
  char quantity = ' ';   ///< 'C', 'L', 'D', 'S'; ' ': not used
  std::size_t slot = 0;  ///< index of its signal
  double factor = 1.0;   ///< divisor of the stored numbers
};

/// SYS / SCALE FACTOR of one system: by type, and for the types that are not listed.
struct ScaleFactors {
  double others = 1.0;
  std::map<std::string, double> by_type;

  [[nodiscard]] double of(char quantity, record::Signal signal) const {
    const auto found = by_type.find({quantity, signal.band, signal.tracking});
    return found == by_type.end() ? others : found->second;
  }
};

/// The columns of one system.
struct SystemTypes {
  std::vector<ObservationType> columns;
  std::vector<record::Signal> signals;  ///< ascending

  void set(const std::vector<std::pair<char, record::Signal>>& types, const ScaleFactors& factors);
};

/// Collects the columns from header lines, in the header or in an event within the file.
class RinexColumns {
 public:
  explicit RinexColumns(const RinexLines& lines) : lines_(lines) {}
  /// A header line; one with another label is ignored. @throws InputError  an impossible type or factor
  void read(std::string_view line, std::string_view label, int major);
  /// At the end of the header. @throws InputError  no columns, or fewer than announced
  void check() const;
  [[nodiscard]] const SystemTypes& of(record::SatelliteSystem system) const {
    return types_.at(static_cast<std::size_t>(system));
  }
  [[nodiscard]] std::size_t of_rinex2() const { return named2_.size(); }  ///< the same for all systems

 private:
  void read_types3(std::string_view line);
  void begin_factor(std::string_view line);
  void read_factor(std::string_view line);
  void set_types3(record::SatelliteSystem system);
  void read_types2(std::string_view line);
  void set_types2();

  const RinexLines& lines_;
  int major_ = 0;
  std::array<SystemTypes, 7> types_;
  std::vector<std::string> named2_;
  std::size_t announced2_ = 0;
  char system3_ = ' ';
  std::array<std::vector<std::pair<char, record::Signal>>, 7> named3_;
  bool stated_ = false;
  /// A record SYS / SCALE FACTOR, which may be continued in the next lines.
  struct {
    char system = ' ';
    double factor = 1.0;
    std::size_t announced = 0, listed = 0;  ///< types; none: all of the system
  } scaled_;
  std::array<ScaleFactors, 7> factors_;
};

}  // namespace coast::io
