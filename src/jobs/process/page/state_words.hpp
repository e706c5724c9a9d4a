#pragma once
// States in usual names and units.

#include <string>
#include <string_view>
#include <vector>

#include "coast/geo/units.hpp"

namespace coast::jobs {

struct StateWords {
  std::string what;                ///< "Gyro scale factor"
  std::string component;           ///< "x", "forward"; may be empty
  std::vector<std::string> units;  ///< candidates, coarsest first; none: SI
};
/// @param name  of estimate::state_names
[[nodiscard]] StateWords words_of(const std::string& name);

/// "bias, constant part"; the process's own name if there is no plainer one.
[[nodiscard]] std::string plain_name(const std::string& process);
/// For a process of a gyro or an accelerometer.
[[nodiscard]] std::vector<std::string> units_of(const std::string& process, bool gyro);
/// The coarsest unit in which a value has significant digits before its zeros; null: SI.
[[nodiscard]] const geo::Unit* unit_for(const std::vector<std::string>& candidates, double largest);

}  // namespace coast::jobs
