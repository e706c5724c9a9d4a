#pragma once
// UBX messages as a receiver writes them, from the fields of the interface description.

#include <cmath>
#include <vector>

#include "io/receiver_messages.hpp"

namespace coast::test {

/// One block of RXM-RAWX, in its units.
struct RawxSignal {
  unsigned gnss = 0, sv = 5, signal = 0, frequency = 0;
  double code = 21'000'000.125;
  double phase = 110'000'000.25;
  float doppler = -1234.5F;
  unsigned lock_ms = 64500, cn0 = 45, phase_sd = 2, tracking = 15;
};

inline std::string rawx(unsigned week, double tow, const std::vector<RawxSignal>& signals, unsigned status = 1) {
  Bytes b;
  b.r8(tow).u2(week).i1(18).u1(static_cast<unsigned>(signals.size())).u1(status).u1(1).zeros(2);
  for (const RawxSignal& s : signals)
    b.r8(s.code)
        .r8(s.phase)
        .r4(s.doppler)
        .u1(s.gnss)
        .u1(s.sv)
        .u1(s.signal)
        .u1(s.frequency)
        .u2(s.lock_ms)
        .u1(s.cn0)
        .u1(4)
        .u1(s.phase_sd)
        .u1(3)
        .u1(s.tracking)
        .zeros(1);
  return ubx(0x02, 0x15, b.str());
}

/// NAV-PVT, in its units: 2023-01-08 10:00:00 GPS time and whole milliseconds after.
struct Pvt {
  unsigned tow_ms = 36'000'000;
  unsigned hour = 9, minute = 59, second = 42;  ///< UTC
  unsigned valid = 7;
  int nano = 0;
  unsigned fix = 3, flags = 0x83, satellites = 17;  ///< integers fixed
  int lon = 93'000'000, lat = 487'000'000, height_mm = 350'123;
  unsigned horizontal_mm = 14, vertical_mm = 20;
  int north = 1500, east = -2500, down = 250;
  unsigned speed_sd = 30;
  unsigned flags3 = 0;
};

inline std::string nav_pvt(const Pvt& p) {
  Bytes b;
  b.u4(p.tow_ms).u2(2023).u1(1).u1(8).u1(p.hour).u1(p.minute).u1(p.second).u1(p.valid).u4(20).i4(p.nano);
  b.u1(p.fix).u1(p.flags).u1(0).u1(p.satellites).i4(p.lon).i4(p.lat).i4(p.height_mm).i4(p.height_mm - 48'000);
  b.u4(p.horizontal_mm).u4(p.vertical_mm).i4(p.north).i4(p.east).i4(p.down).i4(2915).i4(0).u4(p.speed_sd).u4(0).u2(120);
  b.u2(p.flags3).zeros(12);
  return ubx(0x01, 0x07, b.str());
}

/// NAV-HPPOSLLH: the high-precision parts in 1e-9 deg and 0.1 mm, accuracies in 0.1 mm.
inline std::string nav_hpposllh(const Pvt& p, int lon_hp, int lat_hp, int height_hp, unsigned horizontal, unsigned vertical,
                                unsigned flags = 0) {
  Bytes b;
  b.zeros(3).u1(flags).u4(p.tow_ms).i4(p.lon).i4(p.lat).i4(p.height_mm).i4(0);
  b.i1(lon_hp).i1(lat_hp).i1(height_hp).i1(0).u4(horizontal).u4(vertical);
  return ubx(0x01, 0x14, b.str());
}

/// ESF-MEAS of a gyro and an accelerometer; 24-bit numbers in their units.
inline std::string esf_meas(std::uint32_t tag, const std::vector<std::pair<unsigned, int>>& data) {
  Bytes b;
  b.u4(tag).u2(static_cast<unsigned>(data.size()) << 11).u2(0);
  for (const auto& [type, value] : data) b.u4(type << 24 | (static_cast<std::uint32_t>(value) & 0xffffffU));
  return ubx(0x10, 0x02, b.str());
}

inline std::string esf_raw(const std::vector<std::pair<std::uint32_t, std::vector<std::pair<unsigned, int>>>>& samples) {
  Bytes b;
  b.zeros(4);
  for (const auto& [tag, data] : samples)
    for (const auto& [type, value] : data) b.u4(type << 24 | (static_cast<std::uint32_t>(value) & 0xffffffU)).u4(tag);
  return ubx(0x10, 0x03, b.str());
}

inline std::string sfrbx(unsigned gnss, unsigned sv, unsigned signal, unsigned frequency,
                         const std::vector<std::uint32_t>& words) {
  Bytes b;
  b.u1(gnss).u1(sv).u1(signal).u1(frequency).u1(static_cast<unsigned>(words.size())).u1(0).u1(2).u1(0);
  for (const std::uint32_t word : words) b.u4(word);
  return ubx(0x02, 0x13, b.str());
}

}  // namespace coast::test
