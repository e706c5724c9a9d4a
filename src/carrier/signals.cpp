#include "coast/carrier/signals.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace coast::carrier {

namespace {

using record::SatelliteSystem;

struct Carrier {
  SatelliteSystem system;
  char band;
  double mhz;
  double mhz_per_channel = 0.0;
};

constexpr std::array kCarriers{Carrier{SatelliteSystem::kGps, '1', 1575.42},
                               Carrier{SatelliteSystem::kGps, '2', 1227.60},
                               Carrier{SatelliteSystem::kGps, '5', 1176.45},
                               Carrier{SatelliteSystem::kGlonass, '1', 1602.0, 0.5625},
                               Carrier{SatelliteSystem::kGlonass, '2', 1246.0, 0.4375},
                               Carrier{SatelliteSystem::kGlonass, '3', 1202.025},
                               Carrier{SatelliteSystem::kGlonass, '4', 1600.995},
                               Carrier{SatelliteSystem::kGlonass, '6', 1248.06},
                               Carrier{SatelliteSystem::kGalileo, '1', 1575.42},
                               Carrier{SatelliteSystem::kGalileo, '5', 1176.45},
                               Carrier{SatelliteSystem::kGalileo, '6', 1278.75},
                               Carrier{SatelliteSystem::kGalileo, '7', 1207.14},
                               Carrier{SatelliteSystem::kGalileo, '8', 1191.795},
                               Carrier{SatelliteSystem::kBeidou, '1', 1575.42},
                               Carrier{SatelliteSystem::kBeidou, '2', 1561.098},
                               Carrier{SatelliteSystem::kBeidou, '5', 1176.45},
                               Carrier{SatelliteSystem::kBeidou, '6', 1268.52},
                               Carrier{SatelliteSystem::kBeidou, '7', 1207.14},
                               Carrier{SatelliteSystem::kBeidou, '8', 1191.795},
                               Carrier{SatelliteSystem::kQzss, '1', 1575.42},
                               Carrier{SatelliteSystem::kQzss, '2', 1227.60},
                               Carrier{SatelliteSystem::kQzss, '5', 1176.45},
                               Carrier{SatelliteSystem::kQzss, '6', 1278.75},
                               Carrier{SatelliteSystem::kNavic, '5', 1176.45},
                               Carrier{SatelliteSystem::kNavic, '9', 2492.028},
                               Carrier{SatelliteSystem::kSbas, '1', 1575.42},
                               Carrier{SatelliteSystem::kSbas, '5', 1176.45}};

}  // namespace

std::optional<double> carrier_frequency(SatelliteSystem system, char band, int glonass_channel) {
  constexpr double kMHz = 1e6;
  const auto found = std::ranges::find_if(kCarriers, [&](const Carrier& c) { return c.system == system && c.band == band; });
  if (found == kCarriers.end()) return std::nullopt;
  return (found->mhz + found->mhz_per_channel * glonass_channel) * kMHz;
}

double glonass_channel(char band, double frequency) {
  const std::optional<double> zero = carrier_frequency(SatelliteSystem::kGlonass, band, 0);
  const std::optional<double> one = carrier_frequency(SatelliteSystem::kGlonass, band, 1);
  return zero && one && *one != *zero ? std::round((frequency - *zero) / (*one - *zero)) : 0.0;
}

}  // namespace coast::carrier
