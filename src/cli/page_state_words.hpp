#pragma once
// States in the words and units of people.

#include <string>
#include <string_view>
#include <vector>

#include "coast/geo/units.hpp"

namespace coast::cli {

struct StateWords {
  std::string what;                ///< "Gyro scale factor"
  std::string component;           ///< "x", "forward"; may be empty
  std::vector<std::string> units;  ///< candidates, coarsest first; none: SI
};
/// @param name  of estimate::state_names
[[nodiscard]] StateWords words_of(const std::string& name);

/// "bias, constant part"; the process's own name where there are no better words.
[[nodiscard]] std::string plain_name(const std::string& process);
/// Of a process of a gyro, or an accelerometer.
[[nodiscard]] std::vector<std::string> units_of(const std::string& process, bool gyro);
/// The coarsest unit in which a value is not mostly zeros; null: SI.
[[nodiscard]] const geo::Unit* unit_for(const std::vector<std::string>& candidates, double largest);

}  // namespace coast::cli
