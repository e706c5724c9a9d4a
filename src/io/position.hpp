#pragma once
// Positions of a table, in any supported frame, to ECEF.

#include <Eigen/Core>
#include <optional>

#include "coast/io/gnss.hpp"

namespace coast::io {

/// Converts the three position columns of a row.
class PositionConverter {
 public:
  /// @param name  of the file, for messages  @param error  makes the error of the current row
  /// @throws InputError  the options lack values required for the frame (zone, origin)
  PositionConverter(const PositionOptions& options, std::string name, WeekClock::MakeError error);
  PositionConverter(const PositionOptions& options, const TableReader& table)
      : PositionConverter(options, table.name(), [&table](auto found, auto expected, auto what_to_do) {
          return table.error(found, expected, what_to_do);
        }) {}

  /// @throws InputError  outside its range, or impossibly far from the Earth's surface; with the line
  [[nodiscard]] Eigen::Vector3d to_ecef(double a, double b, double c) const;
  /// The warning that heights remain above mean sea level, if so.
  [[nodiscard]] record::Events events() const;

 private:
  [[nodiscard]] double ellipsoidal(double height) const;
  [[nodiscard]] Eigen::Vector3d from_geodetic(double latitude_deg, double longitude_deg, double height) const;

  std::string name_;
  WeekClock::MakeError error_;
  PositionOptions options_;
  std::optional<geo::LocalFrame> local_;
};

}  // namespace coast::io
