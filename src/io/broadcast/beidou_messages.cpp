#include "beidou_messages.hpp"

#include <algorithm>

#include "../ephemerides.hpp"
#include "bit_field.hpp"
#include "coast/geo/units.hpp"

namespace coast::io {

namespace {

using BeidouData = std::array<std::uint8_t, 28>;

constexpr std::size_t kBeidouWords = 10;
constexpr std::size_t kBeidouSecond = 18;   // bit at which the second of week begins
constexpr std::size_t kBeidouContent = 38;  // bit at which the content begins

/// Section 5.1.3: the remainder of 15 bits by x^4 + x + 1 is zero.
bool bch_holds(std::uint32_t bits) {
  constexpr std::uint32_t kGenerator = 0b10011;
  for (int bit = 14; bit >= 4; --bit)
    if ((bits >> bit & 1U) != 0) bits ^= kGenerator << (bit - 4);
  return (bits & 15U) == 0;
}

/// Every other of eight bits, from the second or the first one on.
std::uint32_t alternate(std::uint32_t bits, int offset) {
  std::uint32_t value = 0;
  for (int bit = 6 + offset; bit >= 0; bit -= 2) value = value << 1 | (bits >> bit & 1U);
  return value;
}

/// A word but the first has two codes of 11 bits of data and 4 of check.
bool codes_hold(std::uint32_t word, bool in_turn) {
  const std::uint32_t first = word >> 19 & 0x7ffU, second = word >> 8 & 0x7ffU, checks = word & 0xffU;
  return bch_holds(first << 4 | (in_turn ? alternate(checks, 1) : checks >> 4)) &&
         bch_holds(second << 4 | (in_turn ? alternate(checks, 0) : checks & 15U));
}

/// Of the first word only the last 15 bits are a code.
bool codes_hold(std::span<const std::uint32_t> words) {
  const auto all = [&](bool in_turn) {
    return std::ranges::all_of(words.subspan(1), [=](std::uint32_t word) { return codes_hold(word, in_turn); });
  };
  return bch_holds(words[0] & 0x7fffU) && (all(false) || all(true));
}

BeidouData beidou_data(std::span<const std::uint32_t> words) {
  constexpr std::size_t kFirst = 26, kOther = 22;
  BeidouData data{};
  std::size_t at = 0;
  for (std::size_t word = 0; word < kBeidouWords; ++word) {
    const std::size_t count = word == 0 ? kFirst : kOther;
    for (std::size_t i = 0; i < count; ++i, ++at)
      data.at(at / 8) = static_cast<std::uint8_t>(data.at(at / 8) | (words[word] >> (29 - i) & 1U) << (7 - at % 8));
  }
  return data;
}

geo::GpsTime beidou_time(geo::GpsTime now, double second_of_week) {
  return nearest_second_of_week(now - kGpsMinusBeidou, second_of_week) + kGpsMinusBeidou;
}

/// Subframe 1 of D1 and page 1 of D2 from the health on: figures 5-8 and 5-14. Group delays are in 0.1 ns.
void read_beidou_state(BitCursor& c, geo::GpsTime now, record::KeplerEphemeris& e) {
  constexpr double kDelay = 1e-10;
  e.health = c.integer(1);
  c.skip(5);  // AODC
  e.accuracy_m = accuracy_of_ura(c.integer(4));
  c.skip(13);  // week
  e.toc = beidou_time(now, c.number(17, 3));
  e.group_delay[0] = kDelay * c.signed_integer(10);
  e.group_delay[1] = kDelay * c.signed_integer(10);
}

double semicircles(BitCursor& c, std::size_t bits, int exponent) {
  return geo::kPi * c.signed_number(bits, exponent);
}

/// Figures 5-8 to 5-10.
void read_d1(const std::array<BeidouData, 10>& subframes, geo::GpsTime now, record::KeplerEphemeris& e) {
  const BitField one(subframes[0]), two(subframes[1]), three(subframes[2]);
  BitCursor a(one, kBeidouContent);
  read_beidou_state(a, now, e);
  a.skip(64);  // ionosphere
  e.clock[2] = a.signed_number(11, -66);
  e.clock[0] = a.signed_number(24, -33);
  e.clock[1] = a.signed_number(22, -50);
  e.issue = a.integer(5);
  BitCursor b(two, kBeidouContent);
  e.delta_n = semicircles(b, 16, -43);
  e.cuc = b.signed_number(18, -31);
  e.mean_anomaly = semicircles(b, 32, -31);
  e.eccentricity = b.number(32, -33);
  e.cus = b.signed_number(18, -31);
  e.crc = b.signed_number(18, -6);
  e.crs = b.signed_number(18, -6);
  e.sqrt_a = b.number(32, -19);
  const int toe_high = b.integer(2);
  BitCursor c(three, kBeidouContent);
  e.toe = beidou_time(now, 8.0 * (toe_high << 15 | c.integer(15)));
  e.inclination = semicircles(c, 32, -31);
  e.cic = c.signed_number(18, -31);
  e.node_rate = semicircles(c, 24, -43);
  e.cis = c.signed_number(18, -31);
  e.inclination_rate = semicircles(c, 14, -43);
  e.node = semicircles(c, 32, -31);
  e.perigee = semicircles(c, 32, -31);
}

/// Figures 5-14 to 5-23: from page 3 on, fields go on from one page to the next; page 2 is of the ionosphere.
void read_d2(const std::array<BeidouData, 10>& pages, geo::GpsTime now, record::KeplerEphemeris& e) {
  struct Piece {
    std::size_t page, at, bits;
  };
  constexpr std::array<Piece, 8> kPieces = {
      {{3, 80, 28}, {4, 42, 64}, {5, 42, 64}, {6, 42, 64}, {7, 42, 64}, {8, 42, 66}, {9, 42, 64}, {10, 42, 19}}};
  BitWriter<56> writer;
  for (const Piece& piece : kPieces) writer.append(BitField(pages.at(piece.page - 1)), piece.at, piece.bits);
  const BitField first(pages[0]), rest(writer.bytes());
  BitCursor a(first, kBeidouContent + 4);  // after the number of the page
  read_beidou_state(a, now, e);
  BitCursor c(rest, 0);
  e.clock[0] = c.signed_number(24, -33);
  e.clock[1] = c.signed_number(22, -50);
  e.clock[2] = c.signed_number(11, -66);
  e.issue = c.integer(5);
  e.delta_n = semicircles(c, 16, -43);
  e.cuc = c.signed_number(18, -31);
  e.mean_anomaly = semicircles(c, 32, -31);
  e.cus = c.signed_number(18, -31);
  e.eccentricity = c.number(32, -33);
  e.sqrt_a = c.number(32, -19);
  e.cic = c.signed_number(18, -31);
  e.cis = c.signed_number(18, -31);
  e.toe = beidou_time(now, c.number(17, 3));
  e.inclination = semicircles(c, 32, -31);
  e.crc = c.signed_number(18, -6);
  e.crs = c.signed_number(18, -6);
  e.node_rate = semicircles(c, 24, -43);
  e.node = semicircles(c, 32, -31);
  e.perigee = semicircles(c, 32, -31);
  e.inclination_rate = semicircles(c, 14, -43);
}

bool is_beidou_week(geo::GpsTime now, std::uint32_t stated) {
  return is_stated_week(now - kGpsMinusBeidou, static_cast<int>(stated), kBeidouFirstWeek, kBeidouWeeks);
}

}  // namespace

bool BeidouDecoder::completes(Parts& parts, const Data& data, int part, int last, int frame) const {
  if (parts.frame != frame) parts.known = {};
  parts.frame = frame;
  const auto index = static_cast<std::size_t>(part - 1);
  parts.data.at(index) = data;
  parts.known.at(index) = true;
  const auto all = std::span(parts.known).first(static_cast<std::size_t>(last));
  if (std::ranges::find(all, false) != all.end()) return false;
  parts.known = {};
  return true;
}

MessageUse BeidouDecoder::take(record::Satellite satellite, std::span<const std::uint32_t> words, geo::GpsTime now,
                               record::NavigationRecording& into) {
  constexpr std::uint32_t kPreamble = 0b11100010010;
  if (words.size() != kBeidouWords || !codes_hold(words)) return MessageUse::kWrong;
  const Data data = beidou_data(words);
  if (BitField(data).bits(0, 11) != kPreamble) return MessageUse::kWrong;
  return is_beidou_geostationary(satellite) ? take_d2(satellite, data, now, into) : take_d1(satellite, data, now, into);
}

MessageUse BeidouDecoder::take_d1(record::Satellite satellite, const Data& data, geo::GpsTime now,
                                  record::NavigationRecording& into) {
  constexpr int kLast = 3, kSubframes = 5, kSeconds = 6;  // between subframes
  const BitField bits(data);
  const auto number = static_cast<int>(bits.bits(15, 3)), second = static_cast<int>(bits.bits(kBeidouSecond, 20));
  if (number < 1 || number > kSubframes) return MessageUse::kWrong;
  if (number > kLast) return MessageUse::kNotUsed;
  if (number == 1 && !is_beidou_week(now, bits.bits(kBeidouContent + 10, 13))) return MessageUse::kWrong;
  Parts& parts = satellites_[satellite];
  if (!completes(parts, data, number, kLast, second - kSeconds * (number - 1))) return MessageUse::kPart;
  record::KeplerEphemeris e;
  e.satellite = satellite;
  read_d1(parts.data, now, e);
  return give(e, parts.given, into);
}

MessageUse BeidouDecoder::take_d2(record::Satellite satellite, const Data& data, geo::GpsTime now,
                                  record::NavigationRecording& into) {
  constexpr int kLast = 10, kSubframes = 5, kSeconds = 3;  // between pages
  const BitField bits(data);
  const auto number = static_cast<int>(bits.bits(15, 3)), second = static_cast<int>(bits.bits(kBeidouSecond, 20));
  if (number < 1 || number > kSubframes) return MessageUse::kWrong;
  if (number != 1) return MessageUse::kNotUsed;
  const auto page = static_cast<int>(bits.bits(kBeidouContent, 4));
  if (page < 1 || page > kLast) return MessageUse::kWrong;
  if (page == 1 && !is_beidou_week(now, bits.bits(kBeidouContent + 14, 13))) return MessageUse::kWrong;
  Parts& parts = satellites_[satellite];
  if (!completes(parts, data, page, kLast, second - kSeconds * (page - 1))) return MessageUse::kPart;
  record::KeplerEphemeris e;
  e.satellite = satellite;
  read_d2(parts.data, now, e);
  return give(e, parts.given, into);
}

}  // namespace coast::io
