#pragma once
// RTCM 3 messages as a station sends them, bit by bit from the tables of RTCM 10403.3. Shares no code with the readers.

#include <set>
#include <string>
#include <vector>

#include "io/navigation_messages.hpp"
#include "io/receiver_messages.hpp"

namespace coast::test {

/// A message, filled up to whole bytes, in its frame.
inline std::string rtcm_frame(const BitString& message) {
  std::string content;
  for (std::size_t at = 0; at < message.size(); at += 8) content += static_cast<char>(message.number(at, 8));
  const std::string body =
      Bytes().u1(0xd3).u1(static_cast<unsigned>(content.size() >> 8)).u1(content.size() & 255U).text(content).str();
  const std::uint32_t crc = crc_bit_by_bit(body, 0x864CFB, 24);
  return body + Bytes().u1(crc >> 16).u1(crc >> 8 & 255U).u1(crc & 255U).str();
}

/// One cell of MSM, in its units.
struct MsmCell {
  int satellite = 5, signal = 2;  ///< places in the masks, from 1
  int code = 1000, phase = -2000, lock = 9, half = 0, cn0 = 700, rate = 1234;
};
/// The rough values of one satellite.
struct MsmRough {
  int satellite = 5;
  int whole = 70, part = 512, extended = 0, rate = -321;
};

struct Msm {
  int number = 1077;
  std::int64_t epoch = 36'000'000;  ///< 30 bits
  int station = 12;
  bool more = false;
  std::vector<MsmRough> rough = {{}};
  std::vector<MsmCell> cells = {{}};  ///< by satellite, then by signal
};

inline std::string msm(const Msm& m) {
  const int kind = m.number % 10;
  const bool rates = kind == 5 || kind == 7, fine = kind >= 6;
  std::set<int> satellites, signals, cells;
  for (const MsmRough& r : m.rough) satellites.insert(r.satellite);
  for (const MsmCell& c : m.cells) signals.insert(c.signal);
  for (const MsmCell& c : m.cells) cells.insert(100 * c.satellite + c.signal);
  BitString b;
  b.put(m.number, 12).put(m.station, 12).put(m.epoch, 30).put(m.more ? 1 : 0, 1).put(0, 3 + 7 + 2 + 2 + 1 + 3);
  for (int i = 1; i <= 64; ++i) b.put(satellites.contains(i) ? 1 : 0, 1);
  for (int i = 1; i <= 32; ++i) b.put(signals.contains(i) ? 1 : 0, 1);
  for (const int satellite : satellites)
    for (const int signal : signals) b.put(cells.contains(100 * satellite + signal) ? 1 : 0, 1);
  for (const MsmRough& r : m.rough) b.put(r.whole, 8);
  if (rates)
    for (const MsmRough& r : m.rough) b.put(r.extended, 4);
  for (const MsmRough& r : m.rough) b.put(r.part, 10);
  if (rates)
    for (const MsmRough& r : m.rough) b.put(r.rate, 14);
  for (const MsmCell& c : m.cells) b.put(c.code, fine ? 20 : 15);
  for (const MsmCell& c : m.cells) b.put(c.phase, fine ? 24 : 22);
  for (const MsmCell& c : m.cells) b.put(c.lock, fine ? 10 : 4);
  for (const MsmCell& c : m.cells) b.put(c.half, 1);
  for (const MsmCell& c : m.cells) b.put(c.cn0, fine ? 10 : 6);
  if (rates)
    for (const MsmCell& c : m.cells) b.put(c.rate, 15);
  return rtcm_frame(b);
}

/// Second of the week and day of GLONASS: day of the week, millisecond of the day in Moscow.
inline std::int64_t glonass_epoch(int day, std::int64_t ms) {
  return static_cast<std::int64_t>(day) << 27 | ms;
}

/// The orbit as 1019, 1042, 1044, 1045 and 1046 have it, in the units of the message, from crs to the rate of the node.
struct RtcmOrbit {
  int harmonic_bits = 16, time_bits = 16;
  std::int64_t toe = 36'000 / 16, root = 2'701'983'744;  ///< 5153.625 sqrt(m)
  [[nodiscard]] BitString bits() const {
    BitString b;
    b.put(-1100, harmonic_bits).put(12'345, 16).put(-1'717'986'918, 32).put(-222, harmonic_bits).put(104'857'600, 32);
    b.put(3333, harmonic_bits).put(root, 32).put(toe, time_bits).put(-44, harmonic_bits).put(-1'000'000'001, 32);
    b.put(55, harmonic_bits).put(657'000'000, 32).put(7001, harmonic_bits).put(999'999'999, 32).put(-21'000, 24);
    return b;
  }
};

inline std::string rtcm_1019(int satellite, int week, std::int64_t toe = 36'000 / 16, int issue = 0xa5) {
  RtcmOrbit orbit;
  orbit.toe = toe;
  BitString b;
  b.put(1019, 12).put(satellite, 6).put(week, 10).put(2, 4).put(1, 2).put(-777, 14).put(issue, 8).put(toe, 16);
  b.put(-1, 8).put(-1234, 16).put(-345'678, 22).put(0x2a5, 10).put(orbit.bits()).put(-11, 8).put(0, 6).put(0, 2);
  return rtcm_frame(b);
}

inline std::string rtcm_1044(int satellite, int week) {
  BitString b;
  b.put(1044, 12).put(satellite, 4).put(36'000 / 16, 16).put(-1, 8).put(-1234, 16).put(-345'678, 22).put(0xa5, 8);
  b.put(RtcmOrbit().bits()).put(-777, 14).put(1, 2).put(week, 10).put(2, 4).put(0, 6).put(-11, 8).put(0x2a5, 10).put(0, 1);
  return rtcm_frame(b);
}

inline std::string rtcm_1042(int satellite, int week) {
  RtcmOrbit orbit;
  orbit.harmonic_bits = 18;
  orbit.time_bits = 17;
  orbit.toe = 36'000 / 8;
  orbit.root = 3'404'464'128;  // 6493.5 sqrt(m)
  BitString b;
  b.put(1042, 12).put(satellite, 6).put(week, 13).put(2, 4).put(-777, 14).put(17, 5).put(orbit.toe, 17).put(-3, 11);
  b.put(-1234, 22).put(-345'678, 24).put(9, 5).put(orbit.bits()).put(-56, 10).put(30, 10).put(1, 1);
  return rtcm_frame(b);
}

/// 1045 and 1046.
inline std::string rtcm_galileo(int number, int satellite, int week) {
  RtcmOrbit orbit;
  orbit.time_bits = 14;
  orbit.toe = 600;
  orbit.root = 2'852'441'293;  // 5440.6 sqrt(m)
  BitString b;
  b.put(number, 12).put(satellite, 6).put(week, 12).put(77, 10).put(107, 8).put(-777, 14).put(601, 14).put(-9, 6);
  b.put(800, 21).put(-700'000, 31).put(orbit.bits()).put(-33, 10);
  if (number == 1045)
    b.put(2, 2).put(1, 1).put(0, 7);
  else
    b.put(44, 10).put(1, 2).put(1, 1).put(2, 2).put(0, 1).put(0, 2);
  return rtcm_frame(b);
}

/// Position, velocity, acceleration of an orbit that GLONASS could have.
inline std::string rtcm_1020(int slot, int channel, int quarter, int malfunction = 0) {
  BitString b;
  b.put(1020, 12).put(slot, 6).put(channel + 7, 5).put(0, 1 + 1 + 2 + 5 + 6 + 1).put(malfunction, 1).put(0, 1).put(quarter, 7);
  b.put_signed(-1'500'000, 24).put_signed(30'000'000, 27).put_signed(-3, 5);
  b.put_signed(2'000'000, 24).put_signed(-20'000'000, 27).put_signed(2, 5);
  b.put_signed(-500'000, 24).put_signed(37'000'000, 27).put_signed(-1, 5);
  b.put(0, 1).put_signed(-5, 11).put(0, 2).put(0, 1).put_signed(123'456, 22).put_signed(0, 5).put(0, 5).put(0, 1);
  b.put(0, 4).put(0, 11).put(1, 2).put(0, 1).put(0, 11).put(0, 32).put(0, 5).put_signed(0, 22).put(0, 1).put(0, 7);
  return rtcm_frame(b);
}

/// Modified Julian day, second of the day in UTC.
inline std::string rtcm_1013(int day, int second, int leap, int station = 12) {
  return rtcm_frame(BitString().put(1013, 12).put(station, 12).put(day, 16).put(second, 17).put(0, 5).put(leap, 8));
}

/// Coordinates in 0.1 mm.
inline std::string rtcm_1006(std::int64_t x, std::int64_t y, std::int64_t z, int height, int station = 12) {
  BitString b;
  b.put(1006, 12).put(station, 12).put(0, 6 + 4).put(x, 38).put(0, 2).put(y, 38).put(0, 2).put(z, 38).put(height, 16);
  return rtcm_frame(b);
}

inline std::string rtcm_1033(const std::vector<std::string>& texts, int station = 12) {
  BitString b;
  b.put(1033, 12).put(station, 12);
  for (std::size_t i = 0; i < texts.size(); ++i) {
    b.put(static_cast<std::int64_t>(texts[i].size()), 8);
    for (const char c : texts[i]) b.put(c, 8);
    if (i == 0) b.put(0, 8);
  }
  return rtcm_frame(b);
}

/// One satellite of 1004 and 1012, in its units; `code`, `channel` and bits as the message has them.
struct LegacySatellite {
  int number = 7, channel = 0;
  int range = 1'234'567, phase = -1000, lock = 40, whole = 73, cn0 = 180;
  int second_code = 3, difference = -77, second_phase = 2000, second_lock = 30, second_cn0 = 170;
};

inline std::string legacy(int number, std::int64_t ms, const std::vector<LegacySatellite>& satellites) {
  const bool gps = number == 1004;
  BitString b;
  b.put(number, 12).put(12, 12).put(ms, gps ? 30 : 27).put(0, 1).put(static_cast<std::int64_t>(satellites.size()), 5).put(0, 4);
  for (const LegacySatellite& s : satellites) {
    b.put(s.number, 6).put(0, 1);
    if (!gps) b.put(s.channel + 7, 5);
    b.put(s.range, gps ? 24 : 25).put(s.phase, 20).put(s.lock, 7).put(s.whole, gps ? 8 : 7).put(s.cn0, 8);
    b.put(s.second_code, 2).put(s.difference, 14).put(s.second_phase, 20).put(s.second_lock, 7).put(s.second_cn0, 8);
  }
  return rtcm_frame(b);
}

}  // namespace coast::test
