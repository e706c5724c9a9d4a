#include "coast/carrier/signals.hpp"

namespace coast::carrier {

namespace {

constexpr double kMHz = 1e6;

std::optional<double> of_gps(char band) {
  switch (band) {
    case '1':
      return kL1Frequency;
    case '2':
      return 1227.60 * kMHz;
    case '5':
      return 1176.45 * kMHz;
    default:
      return std::nullopt;
  }
}

std::optional<double> of_glonass(char band, int channel) {
  switch (band) {
    case '1':
      return (1602.0 + 0.5625 * channel) * kMHz;
    case '2':
      return (1246.0 + 0.4375 * channel) * kMHz;
    case '3':
      return 1202.025 * kMHz;
    case '4':
      return 1600.995 * kMHz;
    case '6':
      return 1248.06 * kMHz;
    default:
      return std::nullopt;
  }
}

std::optional<double> of_galileo(char band) {
  switch (band) {
    case '1':
      return kL1Frequency;
    case '5':
      return 1176.45 * kMHz;
    case '6':
      return 1278.75 * kMHz;
    case '7':
      return 1207.14 * kMHz;
    case '8':
      return 1191.795 * kMHz;
    default:
      return std::nullopt;
  }
}

std::optional<double> of_beidou(char band) {
  switch (band) {
    case '1':
      return kL1Frequency;
    case '2':
      return 1561.098 * kMHz;
    case '5':
      return 1176.45 * kMHz;
    case '6':
      return 1268.52 * kMHz;
    case '7':
      return 1207.14 * kMHz;
    case '8':
      return 1191.795 * kMHz;
    default:
      return std::nullopt;
  }
}

}  // namespace

std::optional<double> carrier_frequency(record::SatelliteSystem system, char band, int glonass_channel) {
  using record::SatelliteSystem;
  switch (system) {
    case SatelliteSystem::kGlonass:
      return of_glonass(band, glonass_channel);
    case SatelliteSystem::kGalileo:
      return of_galileo(band);
    case SatelliteSystem::kBeidou:
      return of_beidou(band);
    case SatelliteSystem::kQzss:
      return band == '6' ? std::optional(1278.75 * kMHz) : of_gps(band);
    case SatelliteSystem::kNavic:
      if (band == '9') return 2492.028 * kMHz;
      return band == '5' ? of_gps(band) : std::nullopt;
    case SatelliteSystem::kSbas:
      return band == '2' ? std::nullopt : of_gps(band);
    case SatelliteSystem::kGps:
      break;
  }
  return of_gps(band);
}

}  // namespace coast::carrier
