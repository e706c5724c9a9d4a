#include "sbf_signals.hpp"

#include <algorithm>
#include <array>

namespace coast::io {

namespace {

using System = record::SatelliteSystem;

/// mosaic-X5 reference guide 4.14.10, 4.1.9: the IDs of each system, and what they are more than the satellite's number.
struct SbfSatellites {
  std::uint8_t first, last;
  System system;
  std::uint8_t offset;
};
constexpr std::array<SbfSatellites, 11> kSbfSatellites = {{{1, 37, System::kGps, 0},
                                                           {38, 61, System::kGlonass, 37},
                                                           {63, 68, System::kGlonass, 38},
                                                           {71, 106, System::kGalileo, 70},
                                                           {120, 140, System::kSbas, 100},
                                                           {141, 180, System::kBeidou, 140},
                                                           {181, 187, System::kQzss, 180},
                                                           {191, 197, System::kNavic, 190},
                                                           {198, 215, System::kSbas, 157},
                                                           {216, 222, System::kNavic, 208},
                                                           {223, 245, System::kBeidou, 182}}};

/// The same, 4.1.10. L6 of QZSS (27) has no name of RINEX there: which of its two codes is tracked is not told.
constexpr std::array<SbfSignal, 32> kSbfSignals = {{{0, System::kGps, {'1', 'C'}, 1575.42},
                                                    {1, System::kGps, {'1', 'W'}, 1575.42},
                                                    {2, System::kGps, {'2', 'W'}, 1227.60},
                                                    {3, System::kGps, {'2', 'L'}, 1227.60},
                                                    {4, System::kGps, {'5', 'Q'}, 1176.45},
                                                    {5, System::kGps, {'1', 'L'}, 1575.42},
                                                    {6, System::kQzss, {'1', 'C'}, 1575.42},
                                                    {7, System::kQzss, {'2', 'L'}, 1227.60},
                                                    {8, System::kGlonass, {'1', 'C'}, 1602.0, 0.5625},
                                                    {9, System::kGlonass, {'1', 'P'}, 1602.0, 0.5625},
                                                    {10, System::kGlonass, {'2', 'P'}, 1246.0, 0.4375},
                                                    {11, System::kGlonass, {'2', 'C'}, 1246.0, 0.4375},
                                                    {12, System::kGlonass, {'3', 'Q'}, 1202.025},
                                                    {13, System::kBeidou, {'1', 'P'}, 1575.42},
                                                    {14, System::kBeidou, {'5', 'P'}, 1176.45},
                                                    {15, System::kNavic, {'5', 'A'}, 1176.45},
                                                    {17, System::kGalileo, {'1', 'C'}, 1575.42},
                                                    {19, System::kGalileo, {'6', 'C'}, 1278.75},
                                                    {20, System::kGalileo, {'5', 'Q'}, 1176.45},
                                                    {21, System::kGalileo, {'7', 'Q'}, 1207.14},
                                                    {22, System::kGalileo, {'8', 'Q'}, 1191.795},
                                                    {24, System::kSbas, {'1', 'C'}, 1575.42},
                                                    {25, System::kSbas, {'5', 'I'}, 1176.45},
                                                    {26, System::kQzss, {'5', 'Q'}, 1176.45},
                                                    {28, System::kBeidou, {'2', 'I'}, 1561.098},
                                                    {29, System::kBeidou, {'7', 'I'}, 1207.14},
                                                    {30, System::kBeidou, {'6', 'I'}, 1268.52},
                                                    {32, System::kQzss, {'1', 'L'}, 1575.42},
                                                    {33, System::kQzss, {'1', 'Z'}, 1575.42},
                                                    {34, System::kBeidou, {'7', 'D'}, 1207.14},
                                                    {38, System::kQzss, {'1', 'E'}, 1575.42},
                                                    {39, System::kQzss, {'5', 'P'}, 1176.45}}};

}  // namespace

std::optional<double> SbfSignal::frequency(std::optional<int> channel) const {
  constexpr double kMHz = 1e6;
  if (mhz_per_channel == 0.0) return kMHz * mhz;
  if (!channel) return std::nullopt;
  return kMHz * (mhz + mhz_per_channel * *channel);
}

std::optional<record::Satellite> sbf_satellite(std::uint8_t svid) {
  for (const SbfSatellites& range : kSbfSatellites)
    if (svid >= range.first && svid <= range.last)
      return record::Satellite{range.system, static_cast<std::uint8_t>(svid - range.offset)};
  return std::nullopt;
}

const SbfSignal* sbf_signal(unsigned number) {
  const auto found = std::ranges::find(kSbfSignals, number, &SbfSignal::number);
  return found == kSbfSignals.end() ? nullptr : &*found;
}

std::optional<int> sbf_channel(unsigned field) {
  constexpr unsigned kLargest = 21;
  constexpr int kOffset = 8;
  if (field == 0 || field > kLargest) return std::nullopt;
  return static_cast<int>(field) - kOffset;
}

}  // namespace coast::io
