#pragma once
// SBF blocks as a Septentrio receiver writes them, from the fields of its reference guide. Shares no code with the reader.

#include <algorithm>
#include <cmath>
#include <vector>

#include "io/receiver_messages.hpp"

namespace coast::test {

constexpr unsigned kSbfTestWeek = 2360;
constexpr std::uint32_t kSbfTestTow = 212'541'000;  ///< ms
constexpr double kSbfUnknown = -2e10;

/// Header, time, contents, padding to a multiple of four.
inline std::string sbf(unsigned number, const std::string& contents, std::uint32_t tow_ms = kSbfTestTow,
                       unsigned week = kSbfTestWeek, unsigned revision = 0) {
  std::string body = Bytes().u4(tow_ms).u2(week).text(contents).str();
  while (body.size() % 4 != 0) body += '\xee';
  const std::string checked = Bytes().u2(number | revision << 13).u2(static_cast<unsigned>(body.size() + 8)).text(body).str();
  return "$@" + Bytes().u2(crc_bit_by_bit(checked, 0x1021, 16)).str() + checked;
}

/// One signal of MeasEpoch in its units; the encoder finds the differences.
struct SbfSignalSent {
  unsigned number = 0;
  double frequency = 1575.42e6;  ///< Hz
  double code = 21'000'000.125, phase = 110'350'000.25, doppler = -1234.5;
  double cn0 = 45.25;
  unsigned lock = 1000;  ///< s
  bool half_cycle = false;
  unsigned antenna = 0;
};

struct SbfSatelliteSent {
  unsigned svid = 5;
  std::vector<SbfSignalSent> signals;
  unsigned freq_nr = 0;  ///< GLONASS: channel + 8
};

inline unsigned sbf_type(const SbfSignalSent& s) {
  return (s.number >= 31 ? 31 : s.number) | s.antenna << 5;
}

inline unsigned sbf_info(const SbfSignalSent& s, unsigned freq_nr) {
  const unsigned upper = s.number >= 31 ? s.number - 32 : s.number >= 8 && s.number <= 11 ? freq_nr : 0;
  return (s.half_cycle ? 4U : 0U) | upper << 3;
}

inline unsigned sbf_cn0(const SbfSignalSent& s) {
  return static_cast<unsigned>(std::lround(4.0 * (s.cn0 - (s.number == 1 || s.number == 2 ? 0.0 : 10.0))));
}

/// Cycles beyond the code, in thousandths.
inline long long sbf_carrier(const SbfSignalSent& s, double code) {
  return std::llround(1e3 * (s.phase - code * s.frequency / 299'792'458.0));
}

/// @param extra  bytes by which sub-blocks are longer than their known fields
inline std::string meas_epoch(const std::vector<SbfSatelliteSent>& satellites, std::uint32_t tow_ms = kSbfTestTow,
                              unsigned flags = 0, unsigned week = kSbfTestWeek, std::size_t extra = 0) {
  Bytes b;
  b.u1(static_cast<unsigned>(satellites.size())).u1(static_cast<unsigned>(20 + extra)).u1(static_cast<unsigned>(12 + extra));
  b.u1(flags).u1(252).u1(0);
  for (const SbfSatelliteSent& satellite : satellites) {
    const SbfSignalSent& m = satellite.signals.front();
    const long long code = std::llround(1e3 * m.code), doppler = std::llround(1e4 * m.doppler);
    const long long carrier = sbf_carrier(m, 1e-3 * static_cast<double>(code));
    b.u1(1).u1(sbf_type(m)).u1(satellite.svid).u1(static_cast<unsigned>(code >> 32));
    b.u4(static_cast<std::uint32_t>(code & 0xffffffff)).i4(static_cast<std::int32_t>(doppler));
    b.u2(static_cast<unsigned>(carrier & 0xffff)).i1(static_cast<int>(carrier >> 16)).u1(sbf_cn0(m)).u2(m.lock);
    b.u1(sbf_info(m, satellite.freq_nr)).u1(static_cast<unsigned>(satellite.signals.size() - 1)).zeros(extra);
    for (std::size_t i = 1; i < satellite.signals.size(); ++i) {
      const SbfSignalSent& s = satellite.signals[i];
      const long long more = std::llround(1e3 * s.code) - code;
      const double ratio = s.frequency / m.frequency;
      const long long faster = std::llround(1e4 * (s.doppler - 1e-4 * static_cast<double>(doppler) * ratio));
      const long long cycles = sbf_carrier(s, 1e-3 * static_cast<double>(code + more));
      b.u1(sbf_type(s)).u1(std::min(s.lock, 254U)).u1(sbf_cn0(s));
      b.u1(static_cast<unsigned>((more >> 16 & 7) | (faster >> 16 & 31) << 3)).i1(static_cast<int>(cycles >> 16));
      b.u1(sbf_info(s, satellite.freq_nr)).u2(static_cast<unsigned>(more & 0xffff));
      b.u2(static_cast<unsigned>(cycles & 0xffff)).u2(static_cast<unsigned>(faster & 0xffff)).zeros(extra);
    }
  }
  return sbf(4027, b.str(), tow_ms, week, 1);
}

/// PVTGeodetic and PVTCartesian.
struct SbfPvt {
  std::uint32_t tow_ms = kSbfTestTow;
  unsigned week = kSbfTestWeek;
  unsigned mode = 4, error = 0;
  double a = 0.85, b = 0.16, c = 350.123;  ///< rad and m, or ECEF
  double v1 = 1.5, v2 = -2.5, v3 = 0.25;
  double clock_bias_ms = 0.4;
  unsigned datum = 0, satellites = 17;
  unsigned horizontal_cm = 6, vertical_cm = 10;  ///< twice the standard deviations
};

inline std::string sbf_pvt(unsigned number, const SbfPvt& p) {
  Bytes b;
  b.u1(p.mode).u1(p.error).r8(p.a).r8(p.b).r8(p.c).r4(47.4F);
  b.r4(static_cast<float>(p.v1)).r4(static_cast<float>(p.v2)).r4(static_cast<float>(p.v3)).r4(120.0F);
  b.r8(p.clock_bias_ms).r4(0.1F).u1(0).u1(p.datum).u1(p.satellites).u1(0).u2(65535).u2(120).u4(1).u1(0);
  b.u1(1).u2(0).u2(130).u2(p.horizontal_cm).u2(p.vertical_cm).u1(0);
  return sbf(number, b.str(), p.tow_ms, p.week, 2);
}

/// PosCov.. and VelCov..: variances, then covariances 12, 13, 23.
inline std::string sbf_covariance(unsigned number, const std::vector<float>& c, std::uint32_t tow_ms = kSbfTestTow,
                                  unsigned mode = 4) {
  Bytes b;
  b.u1(mode).u1(0).r4(c[0]).r4(c[1]).r4(c[2]).r4(9.0F).r4(c[3]).r4(c[4]).r4(0.5F).r4(c[5]).r4(0.5F).r4(0.5F);
  return sbf(number, b.str(), tow_ms);
}

inline std::string padded(std::string text, std::size_t size) {
  text.resize(size, '\0');
  return text;
}

inline std::string receiver_setup(const std::string& marker, const std::string& antenna, const std::string& product) {
  Bytes b;
  b.zeros(2).text(padded(marker, 60)).text(padded("Unknown", 20)).text(padded("", 20)).text(padded("", 40));
  b.text(padded("3679709", 20)).text(padded("GRB0051", 20)).text(padded("4.14.0", 20)).text(padded("1", 20));
  b.text(padded(antenna, 20)).r4(1.25F).r4(0.5F).r4(-0.25F);
  b.text(padded("Unknown", 20)).text(padded("6.14.7", 40)).text(padded(product, 40)).r8(kSbfUnknown).r8(kSbfUnknown);
  return sbf(5902, b.r4(-2e10F).zeros(36).str(), kSbfTestTow, kSbfTestWeek, 4);
}

/// ExtSensorMeas: sets of type, x, y, z.
struct SbfImuSet {
  unsigned type = 0;
  double x = 0.0, y = 0.0, z = 0.0;
  unsigned model = 10;
};

inline std::string ext_sensor_meas(std::uint32_t tow_ms, const std::vector<SbfImuSet>& sets, int temperature = -32768,
                                   unsigned week = kSbfTestWeek) {
  Bytes b;
  const bool warm = temperature != -32768;
  b.u1(static_cast<unsigned>(sets.size() + (warm ? 1 : 0))).u1(28);
  if (warm) b.u1(32).u1(10).u1(3).u1(1).u2(static_cast<unsigned>(temperature) & 0xffffU).zeros(22);
  for (const SbfImuSet& s : sets) b.u1(32).u1(s.model).u1(s.type).u1(1).r8(s.x).r8(s.y).r8(s.z);
  return sbf(4050, b.str(), tow_ms, week);
}

inline std::string ext_event(std::uint32_t tow_ms, unsigned source, unsigned polarity, float offset, double bias) {
  return sbf(5924, Bytes().u1(source).u1(polarity).r4(offset).r8(bias).u2(0).str(), tow_ms, kSbfTestWeek, 1);
}

}  // namespace coast::test
