#include "gps_lnav.hpp"

#include <bit>

#include "../ephemerides.hpp"
#include "bit_field.hpp"
#include "coast/geo/units.hpp"

namespace coast::io {

namespace {

constexpr std::size_t kLnavWords = 10;
using LnavData = std::array<std::uint8_t, 30>;  // 24 bits of each word

/// Table 20-XIV: data bits that each parity bit D25 to D30 sums, d1 the highest of 24, and whether it begins with D29 or D30 of
/// the word before.
struct ParityRow {
  std::uint32_t data;
  bool with_d30;
};
constexpr std::array<ParityRow, 6> kParity = {{{0b111011000111110011010010, false},
                                               {0b011101100011111001101001, true},
                                               {0b101110110001111100110100, false},
                                               {0b010111011000111110011010, true},
                                               {0b101011101100011111001101, true},
                                               {0b001011011110101000100111, false}}};

std::uint32_t parity_of(std::uint32_t data, bool d29, bool d30) {
  std::uint32_t parity = 0;
  for (const ParityRow& row : kParity) {
    const bool odd = std::popcount(row.data & data) % 2 != 0;
    parity = parity << 1 | ((odd != (row.with_d30 ? d30 : d29)) ? 1U : 0U);
  }
  return parity;
}

/// Parity of a word after another, in either form that receivers give it.
bool parity_holds(std::uint32_t before, std::uint32_t word) {
  const bool d29 = (before & 2U) != 0, d30 = (before & 1U) != 0;
  const std::uint32_t data = word >> 6 & 0xffffffU, stated = word & 0x3fU;
  // Inverted as a whole with D30, a word has the parity that follows from D29 + D30 and 0; the sum is the same if the word
  // before has been inverted.
  return stated == parity_of(data, d29, d30) || stated == parity_of(data, d29 != d30, false);
}

bool parities_hold(std::span<const std::uint32_t> words) {
  std::uint32_t before = 0;  // the last word of a subframe ends with two zeros
  for (const std::uint32_t word : words) {
    if (!parity_holds(before, word)) return false;
    before = word;
  }
  return true;
}

LnavData data_of(std::span<const std::uint32_t> words) {
  LnavData data{};
  for (std::size_t i = 0; i < kLnavWords; ++i)
    for (std::size_t byte = 0; byte < 3; ++byte) data.at(3 * i + byte) = static_cast<std::uint8_t>(words[i] >> (22 - 8 * byte));
  return data;
}

/// Bit of the data at which a word begins, 1 to 10.
constexpr std::size_t word_at(std::size_t word) {
  return 24 * (word - 1);
}

struct Issues {
  int clock = 0, orbit2 = 0, orbit3 = 0;
  [[nodiscard]] bool agree() const { return (clock & 0xff) == orbit2 && orbit2 == orbit3; }
};

Issues issues_of(const std::array<LnavData, 3>& subframes) {
  const BitField one(subframes[0]), two(subframes[1]), three(subframes[2]);
  return {static_cast<int>(one.bits(word_at(3) + 22, 2) << 8 | one.bits(word_at(8), 8)),
          static_cast<int>(two.bits(word_at(3), 8)), static_cast<int>(three.bits(word_at(10), 8))};
}

/// Table 20-I.
void read_lnav_clock(const LnavData& subframe, geo::GpsTime now, record::KeplerEphemeris& e) {
  const BitField field(subframe);
  BitCursor head(field, word_at(3) + 10);  // after the week
  e.sources = head.integer(2);
  e.accuracy_m = accuracy_of_ura(head.integer(4));
  e.health = head.integer(6);
  BitCursor tail(field, word_at(7) + 16);
  e.group_delay[0] = tail.signed_number(8, -31);
  tail.skip(8);  // the low bits of IODC
  e.toc = nearest_second_of_week(now, tail.number(16, 4));
  e.clock[2] = tail.signed_number(8, -55);
  e.clock[1] = tail.signed_number(16, -43);
  e.clock[0] = tail.signed_number(22, -31);
}

/// Tables 20-II and 20-III; angles are in semicircles.
void read_lnav_orbit(const LnavData& second, const LnavData& third, geo::GpsTime now, record::KeplerEphemeris& e) {
  const BitField two(second), three(third);
  BitCursor a(two, word_at(3));
  e.issue = a.integer(8);
  e.crs = a.signed_number(16, -5);
  e.delta_n = geo::kPi * a.signed_number(16, -43);
  e.mean_anomaly = geo::kPi * a.signed_number(32, -31);
  e.cuc = a.signed_number(16, -29);
  e.eccentricity = a.number(32, -33);
  e.cus = a.signed_number(16, -29);
  e.sqrt_a = a.number(32, -19);
  e.toe = nearest_second_of_week(now, a.number(16, 4));
  BitCursor b(three, word_at(3));
  e.cic = b.signed_number(16, -29);
  e.node = geo::kPi * b.signed_number(32, -31);
  e.cis = b.signed_number(16, -29);
  e.inclination = geo::kPi * b.signed_number(32, -31);
  e.crc = b.signed_number(16, -5);
  e.perigee = geo::kPi * b.signed_number(32, -31);
  e.node_rate = geo::kPi * b.signed_number(24, -43);
  b.skip(8);  // IODE
  e.inclination_rate = geo::kPi * b.signed_number(14, -43);
}

/// Subframe 4, page 18: figure 20-1, sheet 8.
std::optional<record::Klobuchar> ionosphere_of(const LnavData& subframe) {
  constexpr int kPage18 = 56;
  const BitField field(subframe);
  BitCursor c(field, word_at(3) + 2);
  if (c.integer(6) != kPage18) return std::nullopt;
  record::Klobuchar k;
  constexpr std::array<int, 4> kAlpha = {-30, -27, -24, -24}, kBeta = {11, 14, 16, 16};
  for (std::size_t i = 0; i < 4; ++i) k.alpha.at(i) = c.signed_number(8, kAlpha.at(i));
  for (std::size_t i = 0; i < 4; ++i) k.beta.at(i) = c.signed_number(8, kBeta.at(i));
  return k;
}

}  // namespace

MessageUse LnavDecoder::take(record::Satellite satellite, std::span<const std::uint32_t> words, geo::GpsTime now,
                             record::NavigationRecording& into) {
  if (words.size() != kLnavWords || !parities_hold(words)) return MessageUse::kWrong;
  return take_data(satellite, data_of(words), now, into);
}

MessageUse LnavDecoder::take_data(record::Satellite satellite, const std::array<std::uint8_t, 30>& data, geo::GpsTime now,
                                  record::NavigationRecording& into) {
  constexpr std::uint32_t kPreamble = 0x8b;
  constexpr int kWeeks = 1024;
  const BitField field(data);
  if (field.bits(0, 8) != kPreamble) return MessageUse::kWrong;
  const std::uint32_t number = field.bits(word_at(2) + 19, 3);
  if (number == 4 && satellite.system == record::SatelliteSystem::kGps && !into.gps_ionosphere) {
    into.gps_ionosphere = ionosphere_of(data);
    return into.gps_ionosphere ? MessageUse::kEphemeris : MessageUse::kNotUsed;
  }
  if (number < 1 || number > 3) return number == 4 || number == 5 ? MessageUse::kNotUsed : MessageUse::kWrong;
  if (number == 1 && !is_stated_week(now, static_cast<int>(field.bits(word_at(3), 10)), 0, kWeeks)) return MessageUse::kWrong;
  Subframes& subframes = satellites_[satellite];
  subframes.data.at(number - 1) = data;
  subframes.known.at(number - 1) = true;
  if (!subframes.known[0] || !subframes.known[1] || !subframes.known[2]) return MessageUse::kPart;
  // Of different issues: the rest of the new one is still to come.
  if (!issues_of(subframes.data).agree()) return MessageUse::kPart;
  record::KeplerEphemeris e;
  e.satellite = satellite;
  read_lnav_clock(subframes.data[0], now, e);
  read_lnav_orbit(subframes.data[1], subframes.data[2], now, e);
  subframes.known = {};
  return give(e, subframes.given, into);
}

}  // namespace coast::io
