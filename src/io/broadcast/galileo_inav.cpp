#include "galileo_inav.hpp"

#include <algorithm>
#include <string_view>

#include "../ephemerides.hpp"
#include "../frames/checksums.hpp"
#include "bit_field.hpp"
#include "coast/geo/units.hpp"

namespace coast::io {

namespace {

using InavWord = std::array<std::uint8_t, 16>;

constexpr std::size_t kOddPart = 128;  // bit at which it begins in the page

/// Copies bits to the end of a string of bits.
template <std::size_t Bytes>
class BitWriter {
 public:
  explicit BitWriter(std::size_t at = 0) : at_(at) {}
  void append(const BitField& from, std::size_t at, std::size_t count) {
    for (std::size_t i = at; i < at + count; ++i, ++at_)
      bytes_.at(at_ / 8) = static_cast<std::uint8_t>(bytes_.at(at_ / 8) | from.bits(i, 1) << (7 - at_ % 8));
  }
  [[nodiscard]] const std::array<std::uint8_t, Bytes>& bytes() const { return bytes_; }

 private:
  std::array<std::uint8_t, Bytes> bytes_{};
  std::size_t at_;
};

/// Table 40: the CRC is over the even part without its tail and the odd part up to the CRC.
bool crc_holds(const BitField& page) {
  constexpr std::size_t kEven = 114, kOdd = 82, kCrc = 24, kBytes = 25;
  BitWriter<kBytes> writer(8 * kBytes - kEven - kOdd);  // zeros in front do not change it
  writer.append(page, 0, kEven);
  writer.append(page, kOddPart, kOdd);
  const auto& bytes = writer.bytes();
  return crc24q({reinterpret_cast<const char*>(bytes.data()), bytes.size()}) == page.bits(kOddPart + kOdd, kCrc);
}

/// The 128 bits of the word: 112 in the even part, 16 in the odd one.
InavWord word_of(const BitField& page) {
  BitWriter<16> writer;
  writer.append(page, 2, 112);
  writer.append(page, kOddPart + 2, 16);
  return writer.bytes();
}

constexpr std::size_t kAfterIssue = 16;  // type and IODnav

/// Tables 42 to 45; angles are in semicircles.
void read_inav_orbit(const std::array<InavWord, 5>& words, geo::GpsTime now, record::KeplerEphemeris& e) {
  constexpr double kMinute = 60.0;
  const BitField one(words[0]), two(words[1]), three(words[2]), four(words[3]);
  BitCursor a(one, kAfterIssue);
  e.toe = nearest_second_of_week(now, kMinute * a.number(14, 0));
  e.mean_anomaly = geo::kPi * a.signed_number(32, -31);
  e.eccentricity = a.number(32, -33);
  e.sqrt_a = a.number(32, -19);
  BitCursor b(two, kAfterIssue);
  e.node = geo::kPi * b.signed_number(32, -31);
  e.inclination = geo::kPi * b.signed_number(32, -31);
  e.perigee = geo::kPi * b.signed_number(32, -31);
  e.inclination_rate = geo::kPi * b.signed_number(14, -43);
  BitCursor c(three, kAfterIssue);
  e.node_rate = geo::kPi * c.signed_number(24, -43);
  e.delta_n = geo::kPi * c.signed_number(16, -43);
  e.cuc = c.signed_number(16, -29);
  e.cus = c.signed_number(16, -29);
  e.crc = c.signed_number(16, -5);
  e.crs = c.signed_number(16, -5);
  e.accuracy_m = galileo_accuracy(c.integer(8));
  BitCursor d(four, kAfterIssue + 6);  // after the satellite's number
  e.cic = d.signed_number(16, -29);
  e.cis = d.signed_number(16, -29);
  e.toc = nearest_second_of_week(now, kMinute * d.number(14, 0));
  e.clock[0] = d.signed_number(31, -34);
  e.clock[1] = d.signed_number(21, -46);
  e.clock[2] = d.signed_number(6, -59);
}

/// Table 46: group delays, health, week. Health in the bits of RINEX 3.05, table A8.
void read_inav_state(const InavWord& word, record::KeplerEphemeris& e) {
  const BitField five(word);
  BitCursor c(five, 6 + 36 + 5);  // after the ionosphere and its regions
  e.group_delay[0] = c.signed_number(10, -32);
  e.group_delay[1] = c.signed_number(10, -32);
  const int health_e5b = c.integer(2), health_e1 = c.integer(2), valid_e5b = c.integer(1), valid_e1 = c.integer(1);
  e.health = valid_e1 | health_e1 << 1 | valid_e5b << 6 | health_e5b << 7;
}

int inav_week(geo::GpsTime t) {
  constexpr int kFirstWeek = 1024, kWeeks = 4096;
  return (t.week() - kFirstWeek) % kWeeks;
}

}  // namespace

double galileo_accuracy(int index) {
  if (index < 50) return 0.01 * index;
  if (index < 75) return 0.5 + 0.02 * (index - 50);
  if (index < 100) return 1.0 + 0.04 * (index - 75);
  return index <= 125 ? 2.0 + 0.16 * (index - 100) : 0.0;
}

MessageUse InavDecoder::take(record::Satellite satellite, std::span<const std::uint8_t, 32> page, geo::GpsTime now,
                             record::NavigationRecording& into) {
  const BitField bits(page);
  const bool alert = bits.bits(1, 1) != 0 || bits.bits(kOddPart + 1, 1) != 0;
  if (alert) return MessageUse::kNotUsed;
  if (bits.bits(0, 1) != 0 || bits.bits(kOddPart, 1) != 1 || !crc_holds(bits)) return MessageUse::kWrong;
  const InavWord word = word_of(bits);
  const std::uint32_t type = BitField(word).bits(0, 6);
  if (type < 1 || type > 5) return MessageUse::kNotUsed;
  if (type == 4 && BitField(word).bits(kAfterIssue, 6) != satellite.number) return MessageUse::kWrong;
  if (type == 5) {
    const auto week = static_cast<int>(BitField(word).bits(73, 12));
    if (week != inav_week(now - geo::kHour) && week != inav_week(now + geo::kHour)) return MessageUse::kWrong;
  }
  Words& words = satellites_[satellite];
  words.data.at(type - 1) = word;
  words.known.at(type - 1) = true;
  if (std::ranges::find(words.known, false) != words.known.end()) return MessageUse::kPart;
  const auto issue = [&](std::size_t i) { return BitField(words.data.at(i)).bits(6, 10); };
  for (std::size_t i = 1; i < 4; ++i)
    if (issue(i) != issue(0)) return MessageUse::kPart;  // the rest of the new issue is still to come
  constexpr int kSources = 1 | 1 << 2 | 1 << 9;  // I/NAV of E1-B and of E5b-I, clock of E5b and E1 (RINEX 3.05, table A8)
  record::KeplerEphemeris e;
  e.satellite = satellite;
  e.issue = static_cast<int>(issue(0));
  e.sources = kSources;
  read_inav_orbit(words.data, now, e);
  read_inav_state(words.data[4], e);
  words.known = {};
  return give(e, words.given, into);
}

}  // namespace coast::io
