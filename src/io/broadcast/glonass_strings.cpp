#include "glonass_strings.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "../ephemerides.hpp"
#include "bit_field.hpp"

namespace coast::io {

namespace {

constexpr std::size_t kStringBits = 85, kCheckBits = 8;
constexpr std::size_t kStringBytes = 11;
using GlonassBits = std::array<std::uint8_t, kStringBytes>;

/// Section 4.7: an extended Hamming code. Data bits, from bit 9 of the ICD on, have the places that are no powers of two; bits
/// 1 to 7 are the checks of the places' binary digits, bit 8 makes the sum of all even. Bit n of the ICD is bit 85 - n here.
bool hamming_holds(const BitField& string) {
  std::uint32_t syndrome = 0, sum = 0, place = 1;
  for (std::size_t n = 1; n <= kStringBits; ++n) {
    const std::uint32_t bit = string.bits(kStringBits - n, 1);
    sum ^= bit;
    if (n < kCheckBits) {
      syndrome ^= bit << (n - 1);
    } else if (n > kCheckBits) {
      do ++place;
      while (std::has_single_bit(place));
      if (bit != 0) syndrome ^= place;
    }
  }
  return syndrome == 0 && sum == 0;
}

/// Bits of the ICD from number `high` down.
std::size_t icd_bit(std::size_t high) {
  return kStringBits - high;
}

/// Position, velocity and acceleration along one axis: bits 35 to 9, 64 to 41, 40 to 36 of strings 1, 2, 3; km, km/s, km/s^2.
struct GlonassAxis {
  explicit GlonassAxis(const GlonassBits& string) {
    const BitField field(string);
    position = std::ldexp(field.magnitude_bits(icd_bit(35), 27), -11);
    velocity = std::ldexp(field.magnitude_bits(icd_bit(64), 24), -20);
    acceleration = std::ldexp(field.magnitude_bits(icd_bit(40), 5), -30);
  }
  double position, velocity, acceleration;
};

}  // namespace

MessageUse GlonassDecoder::take(record::Satellite satellite, std::span<const std::uint8_t> string, std::uint32_t frame,
                                int channel, geo::GpsTime now, record::NavigationRecording& into) {
  if (string.size() < kStringBytes || !hamming_holds(BitField(string.first(kStringBytes)))) return MessageUse::kWrong;
  const std::uint32_t number = BitField(string).bits(icd_bit(84), 4);
  if (number < 1 || number > 4) return number == 0 ? MessageUse::kWrong : MessageUse::kNotUsed;
  Strings& strings = satellites_[satellite];
  if (strings.frame != frame || number == 1) strings.known = {};
  strings.frame = frame;
  std::ranges::copy(string.first(kStringBytes), strings.data.at(number - 1).begin());
  strings.known.at(number - 1) = true;
  if (std::ranges::find(strings.known, false) != strings.known.end()) return MessageUse::kPart;
  strings.known = {};
  const auto& data = strings.data;
  const BitField second(data[1]), third(data[2]), fourth(data[3]);
  // The slot is zero on satellites of the first generation.
  const std::uint32_t slot = fourth.bits(icd_bit(15), 5);
  if (slot != 0 && slot != satellite.number) return MessageUse::kWrong;
  constexpr double kKilometre = 1000.0, kQuarter = 900.0;
  const GlonassAxis x(data[0]), y(data[1]), z(data[2]);
  record::TabulatedEphemeris e;
  e.satellite = satellite;
  e.t = nearest_second_of_moscow_day(now, kQuarter * second.bits(icd_bit(76), 7));  // t_b
  e.r_e = kKilometre * Eigen::Vector3d(x.position, y.position, z.position);
  e.v_e = kKilometre * Eigen::Vector3d(x.velocity, y.velocity, z.velocity);
  e.a_e = kKilometre * Eigen::Vector3d(x.acceleration, y.acceleration, z.acceleration);
  e.clock_bias = -std::ldexp(fourth.magnitude_bits(icd_bit(80), 22), -30);
  e.clock_drift = std::ldexp(third.magnitude_bits(icd_bit(79), 11), -40);
  // The highest bit of B_n, and l_n: a malfunction.
  e.health = second.bits(icd_bit(80), 1) != 0 || third.bits(icd_bit(65), 1) != 0 ? 1 : 0;
  e.channel = channel;
  if (!is_possible(e)) return MessageUse::kImpossible;
  if (e.t != strings.given) into.tabulated.push_back(e);
  strings.given = e.t;
  return MessageUse::kEphemeris;
}

}  // namespace coast::io
