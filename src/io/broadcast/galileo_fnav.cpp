#include "galileo_fnav.hpp"

#include <algorithm>

#include "../ephemerides.hpp"
#include "../frames/checksums.hpp"
#include "bit_field.hpp"
#include "coast/geo/units.hpp"

namespace coast::io {

namespace {

using FnavPage = std::array<std::uint8_t, 31>;

/// 4.2.2.2: the CRC is over the 214 bits before it.
bool fnav_crc_holds(const BitField& page) {
  constexpr std::size_t kData = 214, kCrc = 24, kBytes = 27;
  BitWriter<kBytes> writer(8 * kBytes - kData);  // zeros in front do not change it
  writer.append(page, 0, kData);
  const auto& bytes = writer.bytes();
  return crc24q({reinterpret_cast<const char*>(bytes.data()), bytes.size()}) == page.bits(kData, kCrc);
}

/// Bit at which IODnav begins: after the type, and in page 1 after the satellite's number.
std::size_t fnav_issue_at(std::size_t type) {
  return type == 1 ? 12 : 6;
}

/// Table 30: clock, accuracy, group delay, health. Health in the bits of RINEX 3.05, table A8.
void read_fnav_clock(const FnavPage& page, geo::GpsTime now, record::KeplerEphemeris& e) {
  constexpr double kMinute = 60.0;
  const BitField one(page);
  BitCursor c(one, fnav_issue_at(1) + 10);
  e.toc = nearest_second_of_week(now, kMinute * c.number(14, 0));
  e.clock[0] = c.signed_number(31, -34);
  e.clock[1] = c.signed_number(21, -46);
  e.clock[2] = c.signed_number(6, -59);
  e.accuracy_m = accuracy_of_sisa(c.integer(8));
  c.skip(11 + 11 + 14 + 5);  // the ionosphere and its regions
  e.group_delay[0] = c.signed_number(10, -32);
  const int health = c.integer(2);
  c.skip(12 + 20);  // week and second of week
  e.health = c.integer(1) << 3 | health << 4;
}

/// Tables 31 to 33; angles are in semicircles.
void read_fnav_orbit(const std::array<FnavPage, 4>& pages, geo::GpsTime now, record::KeplerEphemeris& e) {
  constexpr double kMinute = 60.0;
  constexpr std::size_t kAfterIssueOfOthers = 16;
  const BitField two(pages[1]), three(pages[2]), four(pages[3]);
  BitCursor b(two, kAfterIssueOfOthers);
  e.mean_anomaly = geo::kPi * b.signed_number(32, -31);
  e.node_rate = geo::kPi * b.signed_number(24, -43);
  e.eccentricity = b.number(32, -33);
  e.sqrt_a = b.number(32, -19);
  e.node = geo::kPi * b.signed_number(32, -31);
  e.inclination_rate = geo::kPi * b.signed_number(14, -43);
  BitCursor c(three, kAfterIssueOfOthers);
  e.inclination = geo::kPi * c.signed_number(32, -31);
  e.perigee = geo::kPi * c.signed_number(32, -31);
  e.delta_n = geo::kPi * c.signed_number(16, -43);
  e.cuc = c.signed_number(16, -29);
  e.cus = c.signed_number(16, -29);
  e.crc = c.signed_number(16, -5);
  e.crs = c.signed_number(16, -5);
  e.toe = nearest_second_of_week(now, kMinute * c.number(14, 0));
  BitCursor d(four, kAfterIssueOfOthers);
  e.cic = d.signed_number(16, -29);
  e.cis = d.signed_number(16, -29);
}

/// Bit at which the week begins; page 4 has none.
std::size_t fnav_week_at(std::size_t type) {
  return type == 1 ? 155 : type == 2 ? 182 : 174;
}

}  // namespace

MessageUse FnavDecoder::take(record::Satellite satellite, std::span<const std::uint8_t, 31> page, geo::GpsTime now,
                             record::NavigationRecording& into) {
  constexpr std::size_t kPages = 4;
  const BitField bits(page);
  if (!fnav_crc_holds(bits)) return MessageUse::kWrong;
  const std::size_t type = bits.bits(0, 6);
  if (type < 1 || type > kPages) return MessageUse::kNotUsed;
  if (type == 1 && bits.bits(6, 6) != satellite.number) return MessageUse::kWrong;
  if (type < kPages &&
      !is_stated_week(now, static_cast<int>(bits.bits(fnav_week_at(type), 12)), kGalileoFirstWeek, kGalileoWeeks))
    return MessageUse::kWrong;
  Pages& pages = satellites_[satellite];
  std::ranges::copy(page, pages.data.at(type - 1).begin());
  pages.known.at(type - 1) = true;
  if (std::ranges::find(pages.known, false) != pages.known.end()) return MessageUse::kPart;
  const auto issue = [&](std::size_t i) { return BitField(pages.data.at(i)).bits(fnav_issue_at(i + 1), 10); };
  for (std::size_t i = 1; i < kPages; ++i)
    if (issue(i) != issue(0)) return MessageUse::kPart;  // the rest of the new issue is still to come
  constexpr int kSources = 1 << 1 | 1 << 8;              // F/NAV of E5a-I, clock of E5a and E1 (RINEX 3.05, table A8)
  record::KeplerEphemeris e;
  e.satellite = satellite;
  e.issue = static_cast<int>(issue(0));
  e.sources = kSources;
  read_fnav_clock(pages.data[0], now, e);
  read_fnav_orbit(pages.data, now, e);
  pages.known = {};
  return give(e, pages.given, into);
}

}  // namespace coast::io
