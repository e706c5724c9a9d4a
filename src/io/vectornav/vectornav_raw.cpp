// RawMeas of the GNSS groups (VectorNav ICD for VN-310): time of week (f64, s), week (u16), number (u8), reserved (u8); for
// each signal system, satellite, frequency, channel (u8), GLONASS slot (i8), C/N0 (u8, dBHz), flags (u16), pseudorange (f64,
// m), phase (f64, cycles, grows with range), Doppler (f32, Hz, positive when the satellite approaches).

#include "vectornav_raw.hpp"

#include <array>
#include <cmath>

#include "../binary.hpp"
#include "../carriers.hpp"
#include "../ubx/ubx_signals.hpp"
#include "vectornav_values.hpp"

namespace coast::io {

namespace {

using System = record::SatelliteSystem;

constexpr std::size_t kRawSignal = 28;

/// One signal of RawMeas.
struct RawSignal {
  explicit RawSignal(std::string_view b)
      : system(number_at<std::uint8_t>(b, 0)),
        satellite(number_at<std::uint8_t>(b, 1)),
        frequency(number_at<std::uint8_t>(b, 2)),
        channel(number_at<std::uint8_t>(b, 3)),
        slot(number_at<std::int8_t>(b, 4)),
        cn0(number_at<std::uint8_t>(b, 5)),
        flags(number_at<std::uint16_t>(b, 6)),
        code(number_at<double>(b, 8)),
        phase(number_at<double>(b, 16)),
        doppler(number_at<float>(b, 24)) {}

  [[nodiscard]] bool flag(unsigned bit) const { return (flags >> bit & 1U) != 0; }
  [[nodiscard]] bool code_locked() const { return flag(3); }
  [[nodiscard]] bool phase_locked() const { return flag(4); }
  [[nodiscard]] bool half_cycle_unknown() const { return flag(5); }
  [[nodiscard]] bool slip() const { return flag(7); }

  std::uint8_t system, satellite, frequency, channel;
  std::int8_t slot;
  std::uint8_t cn0;
  std::uint16_t flags;
  double code, phase, doppler;
};

/// Band of RINEX 3.05 by the ICD's numbers of frequencies (L1, L2, L5, E6, E5b, E5a+b); ' ': none.
char listed_band(System system, std::uint8_t frequency) {
  constexpr std::string_view kBands = " 125678", kBeidouBands = " 2  67 ";
  const std::string_view bands = system == System::kBeidou ? kBeidouBands : kBands;
  return frequency < bands.size() ? bands[frequency] : ' ';
}

/// Sensors were seen to send 7 for E5b, its RINEX band, where the ICD lists 5. The carrier tells: phases begin aligned with the
/// code, so that pseudorange and phase differ by the wavelength.
std::optional<char> band_of(System system, const RawSignal& raw) {
  constexpr double kTolerance = 1e-3;  // E5b and B2 are 2.5e-2 from their neighbours, B1 and E1 9e-3
  const double carrier = kSpeedOfLight * raw.phase / raw.code;
  for (const char band : {listed_band(system, raw.frequency), static_cast<char>('0' + raw.frequency % 10)}) {
    const auto frequency = carrier_frequency(system, band, raw.slot);
    if (frequency && std::abs(carrier / *frequency - 1.0) < kTolerance) return band;
  }
  return std::nullopt;
}

/// RINEX 3.05, tables 9 to 15, by the ICD's numbers of channels: P, C/A or C, semi-codeless, Y, M, codeless, A, B, I, Q, M or
/// D, L or P, both together, Z tracking, A+B+C.
std::optional<record::Signal> signal_of(System system, const RawSignal& raw) {
  constexpr std::string_view kAttributes = "PCDYMNABIQSLXWZ";
  if (raw.channel >= kAttributes.size()) return std::nullopt;
  const auto band = band_of(system, raw);
  if (!band) return std::nullopt;
  return record::Signal{*band, kAttributes[raw.channel]};
}

/// A signal that is tracked in code and phase.
void take_signal(const RawSignal& raw, VectorNavRaw& epoch) {
  constexpr double kFarthest = 1e9, kMostCycles = 1e11, kMostHertz = 1e6;
  constexpr int kLowestSlot = -7, kHighestSlot = 6;
  if (!raw.code_locked() || !raw.phase_locked()) return;
  // Comparisons that NaN does not pass.
  const bool possible =
      raw.code > 0.0 && raw.code < kFarthest && std::abs(raw.phase) < kMostCycles && std::abs(raw.doppler) < kMostHertz;
  if (!possible) {
    ++epoch.impossible;
    return;
  }
  const auto satellite = ubx_satellite(raw.system, raw.satellite);  // numbered as u-blox does
  const auto signal = satellite ? signal_of(satellite->system, raw) : std::nullopt;
  if (!signal) {
    ++epoch.unknown;
    return;
  }
  VectorNavRaw::Measurement m;
  m.observation.satellite = *satellite;
  m.observation.signal = *signal;
  m.observation.code_m = raw.code;
  m.observation.phase_cycles = raw.phase;
  m.observation.doppler_hz = raw.doppler;
  if (raw.cn0 > 0) m.observation.cn0_dbhz = raw.cn0;
  m.observation.half_cycle = raw.half_cycle_unknown();
  m.observation.lost_lock = raw.slip();
  if (satellite->system == System::kGlonass && raw.slot >= kLowestSlot && raw.slot <= kHighestSlot) m.channel = raw.slot;
  epoch.measurements.push_back(m);
}

std::optional<geo::GpsTime> raw_time(std::string_view field) {
  constexpr double kWeek = 604800.0, kNano = 1e9;
  const auto tow = number_at<double>(field, 0);
  if (!(tow >= 0.0 && tow < kWeek)) return std::nullopt;
  return week_and_nanoseconds(number_at<std::uint16_t>(field, 8), static_cast<std::uint64_t>(std::llround(kNano * tow)));
}

}  // namespace

std::optional<VectorNavRaw> vectornav_raw(const VectorNavMessage& message, VectorNavGroup group) {
  constexpr std::size_t kNumber = 10;
  const auto field = message.field(group, 16);
  if (!field) return std::nullopt;
  const std::size_t number = number_at<std::uint8_t>(*field, kNumber);
  if (number == 0) return std::nullopt;
  const std::size_t head = kNumber + (message.form() == VectorNavMessage::Form::kSent ? 2 : 1);
  VectorNavRaw epoch;
  epoch.t = raw_time(*field);
  for (std::size_t i = 0; i < number; ++i) take_signal(RawSignal(field->substr(head + i * kRawSignal, kRawSignal)), epoch);
  return epoch;
}

}  // namespace coast::io
