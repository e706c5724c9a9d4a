#include "carriers.hpp"

#include <array>

namespace coast::io {

namespace {

using System = record::SatelliteSystem;

struct Carrier {
  System system;
  char band;
  double mhz;
};
constexpr std::array<Carrier, 28> kCarriers = {{
    {System::kGps, '1', 1575.42},      {System::kGps, '2', 1227.60},      {System::kGps, '5', 1176.45},
    {System::kGlonass, '3', 1202.025}, {System::kGlonass, '4', 1600.995}, {System::kGlonass, '6', 1248.06},
    {System::kGalileo, '1', 1575.42},  {System::kGalileo, '5', 1176.45},  {System::kGalileo, '6', 1278.75},
    {System::kGalileo, '7', 1207.14},  {System::kGalileo, '8', 1191.795}, {System::kBeidou, '1', 1575.42},
    {System::kBeidou, '2', 1561.098},  {System::kBeidou, '5', 1176.45},   {System::kBeidou, '6', 1268.52},
    {System::kBeidou, '7', 1207.14},   {System::kBeidou, '8', 1191.795},  {System::kQzss, '1', 1575.42},
    {System::kQzss, '2', 1227.60},     {System::kQzss, '5', 1176.45},     {System::kQzss, '6', 1278.75},
    {System::kSbas, '1', 1575.42},     {System::kSbas, '5', 1176.45},     {System::kNavic, '1', 1575.42},
    {System::kNavic, '5', 1176.45},    {System::kNavic, '9', 2492.028},   {System::kGlonass, '1', 1602.0},
    {System::kGlonass, '2', 1246.0},
}};
constexpr double kMega = 1e6;

}  // namespace

std::optional<double> carrier_frequency(System system, char band, std::optional<int> channel) {
  constexpr double kStep1 = 0.5625, kStep2 = 0.4375;  // MHz
  const bool divided = system == System::kGlonass && (band == '1' || band == '2');
  if (divided && !channel) return std::nullopt;
  const double step = divided ? (band == '1' ? kStep1 : kStep2) * *channel : 0.0;
  for (const Carrier& carrier : kCarriers)
    if (carrier.system == system && carrier.band == band) return kMega * (carrier.mhz + step);
  return std::nullopt;
}

}  // namespace coast::io
