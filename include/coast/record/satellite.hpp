#pragma once
// Names of satellites and of their signals, as in RINEX 3.

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace coast::record {

enum class SatelliteSystem : std::uint8_t { kGps, kGlonass, kGalileo, kBeidou, kQzss, kNavic, kSbas };

/// 'G', 'R', 'E', 'C', 'J', 'I', 'S'
[[nodiscard]] char letter(SatelliteSystem system);
[[nodiscard]] std::optional<SatelliteSystem> system_of(char letter);
/// "GPS"
[[nodiscard]] std::string_view name_of(SatelliteSystem system);

/// A system and a number in it: PRN; GLONASS: slot; SBAS: PRN - 100; QZSS: PRN - 192.
struct Satellite {
  SatelliteSystem system = SatelliteSystem::kGps;
  std::uint8_t number = 0;  ///< 1 to 99

  auto operator<=>(const Satellite&) const = default;
};
[[nodiscard]] std::string to_string(Satellite satellite);  ///< "G05"

/// A frequency band and how it is tracked: {'1', 'C'} of L1 C/A.
struct Signal {
  char band = '1';      ///< '1' to '9'
  char tracking = 'C';  ///< 'C', 'P', 'W', 'X', ...

  auto operator<=>(const Signal&) const = default;
};

}  // namespace coast::record
