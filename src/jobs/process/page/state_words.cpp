#include "process/page/state_words.hpp"

#include <fmt/format.h>

#include <array>

namespace coast::jobs {

namespace {

struct Words {
  std::string_view name;
  const char* what;
  const char* unit;
};
constexpr std::array kOthers{Words{"position", "position", "m"},
                             Words{"velocity", "velocity", "m/s"},
                             Words{"attitude", "attitude", "deg"},
                             Words{"lever_arm", "lever arm", "m"},
                             Words{"gnss_time_offset", "GNSS time offset", "ms"},
                             Words{"vehicle_mounting", "vehicle against body", "deg"},
                             Words{"base_offset", "offset of all GNSS positions", "m"},
                             Words{"gnss_error", "correlated GNSS error", "m"}};

// "gyro_x misalignment to y of left #2"
StateWords sensor_words(const std::string& name) {
  const std::size_t space = name.find(' ');
  const std::size_t end = name.find(' ', space + 1);
  const std::string process = name.substr(space + 1, end == std::string::npos ? end : end - space - 1);
  const bool gyro = name.starts_with("gyro");
  StateWords words{fmt::format("{} {}", gyro ? "gyro" : "accelerometer", plain_name(process)), name.substr(space - 1, 1),
                   units_of(process, gyro)};
  if (end != std::string::npos) words.component += name.substr(end);
  return words;
}

}  // namespace

StateWords words_of(const std::string& name) {
  if (name.starts_with("gyro_") || name.starts_with("accel_")) return sensor_words(name);
  const std::size_t space = name.find(' ');
  const std::string first = name.substr(0, space);
  const std::string component = space == std::string::npos ? "" : name.substr(space + 1);
  for (const Words& words : kOthers)
    if (first == words.name) return {words.what, component, {words.unit}};
  return {first, component, {}};
}

std::string plain_name(const std::string& process) {
  if (process == "random_constant") return "bias, constant part";
  if (process == "gauss_markov") return "bias, Gauss-Markov part";
  if (process == "random_walk") return "bias, random walk part";
  if (process == "scale_factor") return "scale factor";
  return process;
}

std::vector<std::string> units_of(const std::string& process, bool gyro) {
  if (process == "scale_factor") return {"ppm"};
  if (process == "misalignment") return {"mrad"};
  if (gyro) return {"deg/s", "deg/h"};
  return {"mg", "ug"};
}

const geo::Unit* unit_for(const std::vector<std::string>& candidates, double largest) {
  constexpr double kLeast = 0.1;
  const geo::Unit* unit = nullptr;
  for (const std::string& name : candidates) {
    unit = &geo::unit(name);
    if (largest / unit->to_si >= kLeast) break;
  }
  return unit;
}

}  // namespace coast::jobs
