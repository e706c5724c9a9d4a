#include <algorithm>
#include <cmath>

#include "../broadcast/bit_field.hpp"
#include "../carriers.hpp"
#include "rtcm_measurement.hpp"
#include "rtcm_messages.hpp"

namespace coast::io {

namespace {

using System = record::SatelliteSystem;

constexpr double kCodeUnit = 0.02, kPhaseUnit = 0.0005, kLegacyCn0Unit = 0.25;  // m, m, dBHz

/// What differs between 1002 and 1004 of GPS and SBAS, and 1010 and 1012 of GLONASS.
struct LegacyLayout {
  System system;
  bool two_bands;
  std::size_t head, satellite;         ///< bits
  std::size_t range_bits, whole_bits;  ///< of the code within its unit, and of the number of units
  double whole_m;                      ///< that unit: the range of light in 1 ms, or 2 ms
};

LegacyLayout legacy_layout(std::uint32_t id) {
  constexpr double kMs = 1e-3 * kSpeedOfLight;
  if (id == rtcm::kGpsL1) return {System::kGps, false, 64, 74, 24, 8, kMs};
  if (id == rtcm::kGpsL1L2) return {System::kGps, true, 64, 125, 24, 8, kMs};
  return {System::kGlonass, id == rtcm::kGlonassL1L2, 61, id == rtcm::kGlonassL1L2 ? std::size_t{130} : std::size_t{79}, 25, 7,
          2.0 * kMs};
}

/// DF013: seconds to 23, then 24 steps each of 2, 4, .. s; 937 s and more is the last.
double legacy_lock(int indicator) {
  constexpr int kSteps = 24;
  constexpr double kMost = 937.0;
  const int doublings = indicator / kSteps;
  const double turn = std::exp2(doublings);
  return std::min(turn * (indicator - kSteps * doublings) + kSteps * (turn - 1.0), kMost);
}

/// DF016 of GPS: C/A or L2C, P directly, P by correlation with L1, P by demodulation. DF046 of GLONASS: C/A, P.
record::Signal second_signal(System system, int code) {
  if (system == System::kGlonass) return {'2', code == 0 ? 'C' : 'P'};
  constexpr std::string_view kTracking = "XPDW";
  return {'2', kTracking.at(static_cast<std::size_t>(code))};
}

/// PRN of GPS; 40 to 58: PRN 120 to 138 of SBAS. GLONASS: slot.
std::optional<record::Satellite> legacy_satellite(System system, int number) {
  constexpr int kFirstSbas = 40, kLastSbas = 58, kSbasOffset = 20, kLastGps = 32, kLastSlot = 32;
  if (system == System::kGps && number >= kFirstSbas && number <= kLastSbas)
    return record::Satellite{System::kSbas, static_cast<std::uint8_t>(number - kSbasOffset)};
  if (number < 1 || number > (system == System::kGps ? kLastGps : kLastSlot)) return std::nullopt;
  return record::Satellite{system, static_cast<std::uint8_t>(number)};
}

/// Numbers in units; the most negative one stands for "not measured".
std::optional<double> measured(BitCursor& c, std::size_t bits, double unit) {
  const int n = c.signed_integer(bits);
  if (n == -(1 << (bits - 1))) return std::nullopt;
  return unit * n;
}

void read_lock_and_cn0(BitCursor& c, RtcmMeasurement& m, std::size_t between, int& whole) {
  m.lock_s = legacy_lock(c.integer(7));
  if (between > 0) whole = c.integer(between);
  const int cn0 = c.integer(8);
  if (cn0 > 0) m.cn0_dbhz = kLegacyCn0Unit * cn0;
}

/// One satellite: code of the first band, and all else against it.
void read_legacy_satellite(const LegacyLayout& layout, BitCursor c, RtcmMeasurements& into) {
  constexpr int kChannels = 21, kChannelOffset = 7;  // to 13, as satellites had before 2005
  const auto satellite = legacy_satellite(layout.system, c.integer(6));
  RtcmMeasurement first;
  first.signal = {'1', c.integer(1) == 0 ? 'C' : 'P'};
  const int channel = layout.system == System::kGlonass ? c.integer(5) : 0;
  const int range = c.integer(layout.range_bits);
  const auto phase = measured(c, 20, kPhaseUnit);
  int whole = 0;
  read_lock_and_cn0(c, first, layout.whole_bits, whole);
  if (!satellite) {
    ++into.unknown;
    return;
  }
  if (layout.system == System::kGlonass && channel < kChannels)
    into.glonass_channels.emplace_back(satellite->number, channel - kChannelOffset);
  const double code = kCodeUnit * range + layout.whole_m * whole;
  const auto keep = [&](RtcmMeasurement m, std::optional<double> phase_minus_code) {
    m.satellite = *satellite;
    m.turns_about_m = code;
    if (phase_minus_code) m.phase_m = code + *phase_minus_code;
    into.signals.push_back(m);
  };
  first.code_m = code;
  keep(first, phase);
  if (!layout.two_bands || satellite->system == System::kSbas) return;  // which has no second band
  RtcmMeasurement second;
  second.signal = second_signal(layout.system, c.integer(2));
  const auto difference = measured(c, 14, kCodeUnit);
  const auto second_phase = measured(c, 20, kPhaseUnit);
  read_lock_and_cn0(c, second, 0, whole);
  if (difference) second.code_m = code + *difference;
  keep(second, second_phase);
}

}  // namespace

std::optional<RtcmMeasurements> read_legacy(const MessageFrame& frame) {
  const LegacyLayout layout = legacy_layout(frame.id);
  const BitField bits = bits_of(frame.payload);
  constexpr std::size_t kSatellites = 5, kAfter = 4;  // bits of their number, and after it
  const std::size_t size = 8 * frame.payload.size();
  if (size < layout.head) return std::nullopt;
  const std::size_t satellites = bits.bits(layout.head - kAfter - kSatellites, kSatellites);
  if (size < layout.head + satellites * layout.satellite) return std::nullopt;
  RtcmMeasurements all;
  for (std::size_t i = 0; i < satellites; ++i)
    read_legacy_satellite(layout, BitCursor(bits, layout.head + i * layout.satellite), all);
  return all;
}

}  // namespace coast::io
