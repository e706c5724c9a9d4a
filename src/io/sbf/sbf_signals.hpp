#pragma once
// Satellites and signals by Septentrio's numbers. Private to the room.

#include <cstdint>
#include <optional>

#include "coast/record/satellite.hpp"

namespace coast::io {

struct SbfSignal {
  std::uint8_t number;
  record::SatelliteSystem system;
  record::Signal signal;  ///< name in RINEX 3.05
  double mhz;             ///< carrier; of GLONASS FDMA that of channel 0
  double mhz_per_channel = 0.0;

  /// Carrier in Hz; none for FDMA of an unknown channel.
  [[nodiscard]] std::optional<double> frequency(std::optional<int> channel) const;
};

/// @param svid  satellite ID, or PRN, of a block. None: undefined, or a GLONASS satellite whose slot is not known
[[nodiscard]] std::optional<record::Satellite> sbf_satellite(std::uint8_t svid);
/// @param number  signal number. Null: undefined, or without a name in RINEX
[[nodiscard]] const SbfSignal* sbf_signal(unsigned number);
/// Frequency number of GLONASS from the field with an offset of 8; none: not known.
[[nodiscard]] std::optional<int> sbf_channel(unsigned field);

}  // namespace coast::io
