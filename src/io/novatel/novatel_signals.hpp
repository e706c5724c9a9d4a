#pragma once
// Satellites and signals by NovAtel's numbers. Private to the room.

#include <cstdint>
#include <optional>

#include "coast/record/satellite.hpp"

namespace coast::io {

/// Status of a channel (OEM7 manual, RANGE, "channel tracking status").
struct NovAtelTracking {
  std::uint32_t word = 0;
  [[nodiscard]] bool phase_locked() const { return (word >> 10 & 1U) != 0; }
  [[nodiscard]] bool half_cycle_known() const { return (word >> 11 & 1U) != 0; }  ///< "parity known"
  [[nodiscard]] bool code_locked() const { return (word >> 12 & 1U) != 0; }
  [[nodiscard]] bool half_cycle_added() const { return (word >> 28 & 1U) != 0; }
  [[nodiscard]] std::optional<record::SatelliteSystem> system() const;
  /// The signal's name in RINEX 3.05.
  [[nodiscard]] std::optional<record::Signal> signal() const;
};

/// @param prn  as in RANGE: GLONASS slot + 37, SBAS 120 to 158, QZSS 193 to 202
[[nodiscard]] std::optional<record::Satellite> novatel_satellite(record::SatelliteSystem system, std::uint32_t prn);

/// System and signal by the numbers of the compressed logs from RANGECMP2 on.
[[nodiscard]] std::optional<record::SatelliteSystem> compressed_system(std::uint32_t number);
[[nodiscard]] std::optional<record::Signal> rangecmp2_signal(record::SatelliteSystem system, std::uint32_t number);
[[nodiscard]] std::optional<record::Signal> rangecmp4_signal(record::SatelliteSystem system, std::uint32_t number);

/// Frequency of a signal in Hz.  @param glonass_channel  of GLONASS
[[nodiscard]] std::optional<double> novatel_frequency(record::SatelliteSystem system, char band, int glonass_channel);

}  // namespace coast::io
