#include "rtcm_signals.hpp"

#include <array>
#include <string_view>

namespace coast::io {

namespace {

using System = record::SatelliteSystem;

/// RTCM 10403.3, tables 3.5-91, -96, -99, -102, -105 and -108, and that of NavIC: the codes of RINEX, two letters for each of
/// the 32 places of the mask.
struct MsmSignals {
  System system;
  std::string_view codes;
};
constexpr std::array<MsmSignals, 7> kMsmSignals = {
    {{System::kGps, "  1C1P1W      2C2P2W        2S2L2X        5I5Q5X          1S1L1X"},
     {System::kGlonass, "  1C1P        2C2P                                              "},
     {System::kGalileo, "  1C1A1B1X1Z  6C6A6B6X6Z  7I7Q7X  8I8Q8X  5I5Q5X                "},
     {System::kSbas, "  1C                                      5I5Q5X                "},
     {System::kQzss, "  1C            6S6L6X      2S2L2X        5I5Q5X          1S1L1X"},
     {System::kBeidou, "  2I2Q2X      6I6Q6X      7I7Q7X          5D5P5X7D        1D1P1X"},
     {System::kNavic, "              9A                          5A                    "}}};

/// Numbers that MSM has places for; of SBAS and QZSS the first place is PRN 120 and 193.
struct MsmSatellites {
  System system;
  std::size_t last;
  std::size_t offset;  ///< number of the satellite minus place
};
constexpr std::array<MsmSatellites, 7> kMsmSatellites = {{{System::kGps, 32, 0},
                                                          {System::kGlonass, 32, 0},
                                                          {System::kGalileo, 50, 0},
                                                          {System::kSbas, 39, 19},
                                                          {System::kQzss, 10, 0},
                                                          {System::kBeidou, 63, 0},
                                                          {System::kNavic, 14, 0}}};

}  // namespace

std::optional<record::Satellite> msm_satellite(System system, std::size_t index) {
  for (const MsmSatellites& one : kMsmSatellites)
    if (one.system == system && index >= 1 && index <= one.last)
      return record::Satellite{system, static_cast<std::uint8_t>(index + one.offset)};
  return std::nullopt;
}

std::optional<record::Signal> msm_signal(System system, std::size_t index) {
  for (const MsmSignals& one : kMsmSignals) {
    if (one.system != system || index < 1 || 2 * index > one.codes.size()) continue;
    const std::string_view code = one.codes.substr(2 * (index - 1), 2);
    if (code != "  ") return record::Signal{code[0], code[1]};
  }
  return std::nullopt;
}

}  // namespace coast::io
