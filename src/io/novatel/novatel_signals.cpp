#include "novatel_signals.hpp"

#include <algorithm>
#include <array>
#include <span>

namespace coast::io {

namespace {

using System = record::SatelliteSystem;

constexpr std::array kTrackedSystems = {System::kGps,    System::kGlonass, System::kSbas, System::kGalileo,
                                        System::kBeidou, System::kQzss,    System::kNavic};

/// A signal by its number in three numberings (0: none has it; the tracking status has 0 itself, so that it is kept as one
/// more).
struct NovAtelSignal {
  System system;
  record::Signal signal;
  std::uint8_t tracked;    ///< "signal type" of the tracking status, plus 1
  std::uint8_t rangecmp2;  ///< RANGECMP2, "signal type"
  std::uint8_t rangecmp4;  ///< RANGECMP4 and RANGECMP5, bit of the mask of signals
};
/// OEM7 manual: RANGE, RANGECMP2, RANGECMP4; observation codes of RINEX 3.05, tables 9 to 15.
constexpr std::array<NovAtelSignal, 36> kNovAtelSignals = {{
    {System::kGps, {'1', 'C'}, 1, 1, 1},       {System::kGps, {'2', 'P'}, 6, 6, 6},
    {System::kGps, {'2', 'W'}, 10, 4, 4},      {System::kGps, {'5', 'Q'}, 15, 7, 7},
    {System::kGps, {'1', 'L'}, 17, 15, 15},    {System::kGps, {'2', 'S'}, 18, 5, 5},
    {System::kGlonass, {'1', 'C'}, 1, 1, 1},   {System::kGlonass, {'2', 'C'}, 2, 3, 3},
    {System::kGlonass, {'2', 'P'}, 6, 4, 4},   {System::kGlonass, {'3', 'Q'}, 7, 6, 6},
    {System::kSbas, {'1', 'C'}, 1, 1, 1},      {System::kSbas, {'5', 'I'}, 7, 2, 2},
    {System::kGalileo, {'1', 'B'}, 2, 0, 0},   {System::kGalileo, {'1', 'C'}, 3, 1, 1},
    {System::kGalileo, {'6', 'B'}, 7, 12, 12}, {System::kGalileo, {'6', 'C'}, 8, 5, 5},
    {System::kGalileo, {'5', 'Q'}, 13, 2, 2},  {System::kGalileo, {'7', 'Q'}, 18, 3, 3},
    {System::kGalileo, {'8', 'Q'}, 21, 4, 4},  {System::kBeidou, {'2', 'I'}, 1, 1, 1},
    {System::kBeidou, {'7', 'I'}, 2, 3, 3},    {System::kBeidou, {'6', 'I'}, 3, 13, 5},
    {System::kBeidou, {'2', 'I'}, 5, 2, 2},    {System::kBeidou, {'7', 'I'}, 6, 4, 4},
    {System::kBeidou, {'6', 'I'}, 7, 16, 6},   {System::kBeidou, {'1', 'P'}, 8, 19, 7},
    {System::kBeidou, {'5', 'P'}, 10, 20, 9},  {System::kBeidou, {'7', 'D'}, 12, 21, 11},
    {System::kQzss, {'1', 'C'}, 1, 1, 1},      {System::kQzss, {'5', 'Q'}, 15, 4, 4},
    {System::kQzss, {'1', 'L'}, 17, 8, 8},     {System::kQzss, {'2', 'S'}, 18, 3, 3},
    {System::kQzss, {'1', 'E'}, 25, 2, 2},     {System::kQzss, {'6', 'L'}, 28, 11, 11},
    {System::kQzss, {'6', 'S'}, 29, 10, 10},   {System::kNavic, {'5', 'A'}, 1, 1, 1},
}};

template <class Number>
std::optional<record::Signal> signal_by(System system, Number NovAtelSignal::*numbering, std::uint32_t number) {
  if (number == 0) return std::nullopt;
  const auto found = std::ranges::find_if(kNovAtelSignals,
                                          [&](const NovAtelSignal& s) { return s.system == system && s.*numbering == number; });
  if (found == kNovAtelSignals.end()) return std::nullopt;
  return found->signal;
}

struct NovAtelPrns {
  System system;
  std::uint32_t first, last;  ///< PRN
  std::uint32_t offset;       ///< PRN minus the number of the satellite
};
constexpr std::array<NovAtelPrns, 7> kNovAtelPrns = {{{System::kGps, 1, 32, 0},
                                                      {System::kGlonass, 38, 64, 37},
                                                      {System::kSbas, 120, 158, 100},
                                                      {System::kGalileo, 1, 36, 0},
                                                      {System::kBeidou, 1, 63, 0},
                                                      {System::kQzss, 193, 202, 192},
                                                      {System::kNavic, 1, 14, 0}}};

/// The compressed logs state phases as lengths. RINEX 3.05, tables 9 to 15.
struct NovAtelCarrier {
  System system;
  char band;
  double mhz, mhz_per_channel;
};
constexpr std::array<NovAtelCarrier, 24> kNovAtelCarriers = {{
    {System::kGps, '1', 1575.42, 0.0},       {System::kGps, '2', 1227.60, 0.0},       {System::kGps, '5', 1176.45, 0.0},
    {System::kGlonass, '1', 1602.0, 0.5625}, {System::kGlonass, '2', 1246.0, 0.4375}, {System::kGlonass, '3', 1202.025, 0.0},
    {System::kGalileo, '1', 1575.42, 0.0},   {System::kGalileo, '5', 1176.45, 0.0},   {System::kGalileo, '6', 1278.75, 0.0},
    {System::kGalileo, '7', 1207.14, 0.0},   {System::kGalileo, '8', 1191.795, 0.0},  {System::kBeidou, '1', 1575.42, 0.0},
    {System::kBeidou, '2', 1561.098, 0.0},   {System::kBeidou, '5', 1176.45, 0.0},    {System::kBeidou, '6', 1268.52, 0.0},
    {System::kBeidou, '7', 1207.14, 0.0},    {System::kQzss, '1', 1575.42, 0.0},      {System::kQzss, '2', 1227.60, 0.0},
    {System::kQzss, '5', 1176.45, 0.0},      {System::kQzss, '6', 1278.75, 0.0},      {System::kNavic, '5', 1176.45, 0.0},
    {System::kSbas, '1', 1575.42, 0.0},      {System::kSbas, '5', 1176.45, 0.0},      {System::kNavic, '9', 2492.028, 0.0},
}};

}  // namespace

std::optional<System> NovAtelTracking::system() const {
  const std::size_t number = word >> 16 & 7U;
  if (number >= kTrackedSystems.size()) return std::nullopt;
  return kTrackedSystems.at(number);
}

std::optional<record::Signal> NovAtelTracking::signal() const {
  const auto of = system();
  return of ? signal_by(*of, &NovAtelSignal::tracked, (word >> 21 & 31U) + 1) : std::nullopt;
}

std::optional<record::Satellite> novatel_satellite(System system, std::uint32_t prn) {
  for (const NovAtelPrns& prns : kNovAtelPrns)
    if (prns.system == system && prn >= prns.first && prn <= prns.last)
      return record::Satellite{system, static_cast<std::uint8_t>(prn - prns.offset)};
  return std::nullopt;
}

std::optional<System> compressed_system(std::uint32_t number) {
  switch (number) {
    case 0:
      return System::kGps;
    case 1:
      return System::kGlonass;
    case 2:
      return System::kSbas;
    case 5:
      return System::kGalileo;
    case 6:
      return System::kBeidou;
    case 7:
      return System::kQzss;
    case 9:
      return System::kNavic;
    default:
      return std::nullopt;  // L-band corrections
  }
}

std::optional<record::Signal> rangecmp2_signal(System system, std::uint32_t number) {
  return signal_by(system, &NovAtelSignal::rangecmp2, number);
}

std::optional<record::Signal> rangecmp4_signal(System system, std::uint32_t number) {
  return signal_by(system, &NovAtelSignal::rangecmp4, number);
}

std::optional<double> novatel_frequency(System system, char band, int glonass_channel) {
  constexpr double kMegahertz = 1e6;
  const auto found =
      std::ranges::find_if(kNovAtelCarriers, [&](const NovAtelCarrier& c) { return c.system == system && c.band == band; });
  if (found == kNovAtelCarriers.end()) return std::nullopt;
  return kMegahertz * (found->mhz + found->mhz_per_channel * glonass_channel);
}

}  // namespace coast::io
