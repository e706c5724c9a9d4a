#include "coast/record/satellite.hpp"

#include <fmt/format.h>

#include <array>

namespace coast::record {

namespace {

struct Names {
  SatelliteSystem system;
  char letter;
  std::string_view name;
};
constexpr std::array kNames{Names{SatelliteSystem::kGps, 'G', "GPS"},         Names{SatelliteSystem::kGlonass, 'R', "GLONASS"},
                            Names{SatelliteSystem::kGalileo, 'E', "Galileo"}, Names{SatelliteSystem::kBeidou, 'C', "BeiDou"},
                            Names{SatelliteSystem::kQzss, 'J', "QZSS"},       Names{SatelliteSystem::kNavic, 'I', "NavIC"},
                            Names{SatelliteSystem::kSbas, 'S', "SBAS"}};

}  // namespace

char letter(SatelliteSystem system) {
  return kNames.at(static_cast<std::size_t>(system)).letter;
}

std::optional<SatelliteSystem> system_of(char letter) {
  for (const Names& names : kNames)
    if (names.letter == letter) return names.system;
  return std::nullopt;
}

std::string_view name_of(SatelliteSystem system) {
  return kNames.at(static_cast<std::size_t>(system)).name;
}

std::string to_string(Satellite satellite) {
  return fmt::format("{}{:02}", letter(satellite.system), satellite.number);
}

}  // namespace coast::record
