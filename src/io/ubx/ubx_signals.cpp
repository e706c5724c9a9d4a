#include "ubx_signals.hpp"

#include <array>

namespace coast::io {

namespace {

using System = record::SatelliteSystem;

/// u-blox F9 interface description, "GNSS identifiers" and "satellite numbering": the numbers that each system has.
struct UbxSystem {
  std::uint8_t gnss;
  System system;
  std::uint8_t first, last;  ///< svId
  std::uint8_t offset;       ///< svId minus the number of the satellite
};
constexpr std::array<UbxSystem, 7> kUbxSystems = {{{0, System::kGps, 1, 32, 0},
                                                   {1, System::kSbas, 120, 158, 100},
                                                   {2, System::kGalileo, 1, 36, 0},
                                                   {3, System::kBeidou, 1, 63, 0},
                                                   {5, System::kQzss, 1, 10, 0},
                                                   {6, System::kGlonass, 1, 32, 0},
                                                   {7, System::kNavic, 1, 14, 0}}};

/// "Signal identifiers" of the same, with the observation codes of RINEX 3.05, tables 9 to 15.
struct UbxSignal {
  System system;
  std::uint8_t id;
  record::Signal signal;
};
constexpr std::array<UbxSignal, 35> kUbxSignals = {{
    {System::kGps, 0, {'1', 'C'}},     {System::kGps, 3, {'2', 'L'}},     {System::kGps, 4, {'2', 'S'}},
    {System::kGps, 6, {'5', 'I'}},     {System::kGps, 7, {'5', 'Q'}},     {System::kSbas, 0, {'1', 'C'}},
    {System::kGalileo, 0, {'1', 'C'}}, {System::kGalileo, 1, {'1', 'B'}}, {System::kGalileo, 3, {'5', 'I'}},
    {System::kGalileo, 4, {'5', 'Q'}}, {System::kGalileo, 5, {'7', 'I'}}, {System::kGalileo, 6, {'7', 'Q'}},
    {System::kGalileo, 8, {'6', 'B'}}, {System::kGalileo, 9, {'6', 'C'}}, {System::kGalileo, 10, {'6', 'A'}},
    {System::kBeidou, 0, {'2', 'I'}},  {System::kBeidou, 1, {'2', 'I'}},  {System::kBeidou, 2, {'7', 'I'}},
    {System::kBeidou, 3, {'7', 'I'}},  {System::kBeidou, 4, {'6', 'I'}},  {System::kBeidou, 10, {'6', 'I'}},
    {System::kBeidou, 5, {'1', 'P'}},  {System::kBeidou, 6, {'1', 'D'}},  {System::kBeidou, 7, {'5', 'P'}},
    {System::kBeidou, 8, {'5', 'D'}},  {System::kQzss, 0, {'1', 'C'}},    {System::kQzss, 1, {'1', 'Z'}},
    {System::kQzss, 4, {'2', 'S'}},    {System::kQzss, 5, {'2', 'L'}},    {System::kQzss, 8, {'5', 'I'}},
    {System::kQzss, 9, {'5', 'Q'}},    {System::kQzss, 12, {'1', 'E'}},   {System::kGlonass, 0, {'1', 'C'}},
    {System::kGlonass, 2, {'2', 'C'}}, {System::kNavic, 0, {'5', 'A'}},
}};

}  // namespace

std::optional<record::Satellite> ubx_satellite(std::uint8_t gnss, std::uint8_t sv) {
  for (const UbxSystem& system : kUbxSystems)
    if (system.gnss == gnss && sv >= system.first && sv <= system.last)
      return record::Satellite{system.system, static_cast<std::uint8_t>(sv - system.offset)};
  return std::nullopt;
}

std::optional<record::Signal> ubx_signal(record::SatelliteSystem system, std::uint8_t signal) {
  for (const UbxSignal& one : kUbxSignals)
    if (one.system == system && one.id == signal) return one.signal;
  return std::nullopt;
}

}  // namespace coast::io
