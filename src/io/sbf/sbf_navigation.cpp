// Navigation messages of SBF: decoded by the receiver, or the bits of GPSRawCA, QZSRawL1CA, GALRawINAV and GLORawCA (mosaic-X5
// reference guide 4.14.10, 4.2.2 to 4.2.8). Where a file has both, the ephemerides are the same, and one of them is kept.

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "../broadcast/bit_field.hpp"
#include "../broadcast/galileo_inav.hpp"
#include "../broadcast/glonass_strings.hpp"
#include "../broadcast/gps_lnav.hpp"
#include "../counted.hpp"
#include "../ephemerides.hpp"
#include "coast/record/error.hpp"
#include "sbf_blocks.hpp"
#include "sbf_ephemerides.hpp"
#include "sbf_readers.hpp"
#include "sbf_signals.hpp"

namespace coast::io {

namespace {

using System = record::SatelliteSystem;

constexpr std::size_t kSbfBits = 12;  // where the bits of a raw block begin, after satellite, source and channel

/// Words of 32 bits, the first received bit the highest, as bytes.
template <std::size_t Words>
std::array<std::uint8_t, 4 * Words> sbf_bits(std::string_view payload) {
  std::array<std::uint8_t, 4 * Words> bytes{};
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const auto word = number_at<std::uint32_t>(payload, kSbfBits + 4 * (i / 4));
    bytes.at(i) = static_cast<std::uint8_t>(word >> (24 - 8 * (i % 4)));
  }
  return bytes;
}

/// The page has 114 bits of its even part and then 120 of its odd part; the decoder wants the latter from bit 128 on.
std::array<std::uint8_t, 32> inav_page(std::string_view payload) {
  constexpr std::size_t kEven = 114, kBits = 234, kOddPart = 128;
  const auto bytes = sbf_bits<8>(payload);
  const BitField from(bytes);
  std::array<std::uint8_t, 32> page{};
  for (std::size_t i = 0; i < kBits; ++i) {
    const std::size_t to = i < kEven ? i : i - kEven + kOddPart;
    page.at(to / 8) = static_cast<std::uint8_t>(page.at(to / 8) | from.bits(i, 1) << (7 - to % 8));
  }
  return page;
}

class SbfNavigationReader {
 public:
  explicit SbfNavigationReader(const std::filesystem::path& file) : stream_(file, kSbfLog) {}

  record::NavigationRecording read() {
    recording_.source = stream_.name();
    MessageFrame frame;
    while (stream_.next(frame)) take(frame);
    static_cast<void>(sort_out(recording_));
    if (recording_.kepler.empty() && recording_.tabulated.empty()) refuse();
    report();
    return std::move(recording_);
  }

 private:
  void take(const MessageFrame& frame);
  [[nodiscard]] std::optional<MessageUse> decode(std::uint32_t id, std::string_view payload, geo::GpsTime now);
  [[nodiscard]] MessageUse decode_raw(std::uint32_t id, std::string_view payload, geo::GpsTime now);
  template <class Ephemeris>
  [[nodiscard]] static MessageUse keep(const std::optional<Ephemeris>& ephemeris, std::vector<Ephemeris>& into);
  [[noreturn]] void refuse() const;
  void report();

  FrameStream stream_;
  record::NavigationRecording recording_;
  LnavDecoder lnav_;
  InavDecoder inav_;
  GlonassDecoder glonass_;
  std::optional<geo::GpsTime> known_;  ///< last time that a block states
  long spoiled_ = 0, impossible_ = 0, no_time_ = 0;
};

void SbfNavigationReader::take(const MessageFrame& frame) {
  if (frame.protocol != Protocol::kSbf) return;
  const auto stated = sbf_time(frame.payload);
  if (stated) known_ = stated;
  const auto use = decode(frame.id, frame.payload, known_.value_or(geo::GpsTime()));
  if (use == MessageUse::kWrong) ++spoiled_;
  if (use == MessageUse::kImpossible) ++impossible_;
}

/// None for other blocks, and before a time is known, which tells the week.
std::optional<MessageUse> SbfNavigationReader::decode(std::uint32_t id, std::string_view payload, geo::GpsTime now) {
  switch (id) {
    case sbf::kGpsNav:
    case sbf::kQzsNav:
    case sbf::kBdsNav:
    case sbf::kGalNav:
    case sbf::kGloNav:
    case sbf::kGpsRawCa:
    case sbf::kQzsRawL1Ca:
    case sbf::kGalRawInav:
    case sbf::kGloRawCa:
      break;
    case sbf::kGpsIon:
      if (!recording_.gps_ionosphere) recording_.gps_ionosphere = sbf_gps_ionosphere(payload);
      return MessageUse::kNotUsed;
    default:
      return std::nullopt;
  }
  if (!known_) return ++no_time_, std::nullopt;
  if (id == sbf::kGpsNav || id == sbf::kQzsNav) return keep(sbf_gps_ephemeris(payload, now), recording_.kepler);
  if (id == sbf::kBdsNav) return keep(sbf_beidou_ephemeris(payload, now), recording_.kepler);
  if (id == sbf::kGalNav) return keep(sbf_galileo_ephemeris(payload, now), recording_.kepler);
  if (id == sbf::kGloNav) return keep(sbf_glonass_ephemeris(payload, now), recording_.tabulated);
  return decode_raw(id, payload, now);
}

template <class Ephemeris>
MessageUse SbfNavigationReader::keep(const std::optional<Ephemeris>& ephemeris, std::vector<Ephemeris>& into) {
  if (!ephemeris) return MessageUse::kWrong;
  if (!is_possible(*ephemeris)) return MessageUse::kImpossible;
  into.push_back(*ephemeris);
  return MessageUse::kEphemeris;
}

/// SVID, result of the receiver's own check, errors that it corrected, source, frequency number, channel, bits.
MessageUse SbfNavigationReader::decode_raw(std::uint32_t id, std::string_view payload, geo::GpsTime now) {
  constexpr std::size_t kLnavWords = 10, kInavWords = 8, kGlonassWords = 3;
  const auto holds = [&](std::size_t words) { return payload.size() >= kSbfBits + 4 * words; };
  if (!holds(0)) return MessageUse::kWrong;
  const auto byte = [&](std::size_t at) { return number_at<std::uint8_t>(payload, at); };
  const auto satellite = sbf_satellite(byte(kSbfBody));
  if (!satellite) return MessageUse::kNotUsed;  // of GLONASS before its slot is known
  if (byte(kSbfBody + 1) == 0) return MessageUse::kWrong;
  if (id == sbf::kGpsRawCa || id == sbf::kQzsRawL1Ca) {
    if (!holds(kLnavWords) || (satellite->system != System::kGps && satellite->system != System::kQzss))
      return MessageUse::kWrong;
    std::array<std::uint32_t, kLnavWords> words{};
    constexpr std::uint32_t kThirtyBits = 0x3fffffff;
    for (std::size_t i = 0; i < words.size(); ++i)
      words.at(i) = number_at<std::uint32_t>(payload, kSbfBits + 4 * i) & kThirtyBits;
    return lnav_.take(*satellite, words, now, recording_);
  }
  if (id == sbf::kGalRawInav) {
    if (!holds(kInavWords) || satellite->system != System::kGalileo) return MessageUse::kWrong;
    return inav_.take(*satellite, inav_page(payload), now, recording_);
  }
  const auto channel = sbf_channel(byte(kSbfBody + 4));
  if (!holds(kGlonassWords) || satellite->system != System::kGlonass || !channel) return MessageUse::kWrong;
  // The stamp is the end of the string, and string m ends 2 m seconds after the begin of its frame.
  const auto string = sbf_bits<kGlonassWords>(payload);
  const std::uint32_t number = BitField(string).bits(1, 4);
  const auto ends = static_cast<std::uint32_t>(std::llround(now.sow()));
  return glonass_.take(*satellite, string, ends - 2 * number, *channel, now, recording_);
}

void SbfNavigationReader::refuse() const {
  const long messages = spoiled_ + impossible_ + no_time_;
  throw InputError({stream_.name(), 0,
                    messages == 0
                        ? std::string("an SBF file without an ephemeris")
                        : fmt::format("an SBF file without an ephemeris: {} messages left out, {} of them before a time",
                                      messages, no_time_),
                    "GPSNav, GALNav, GLONav, BDSNav, QZSNav, or GPSRawCA, GALRawINAV, GLORawCA, QZSRawL1CA",
                    "Give a RINEX navigation file, or let the receiver log these blocks."});
}

void SbfNavigationReader::report() {
  recording_.events = sbf_file_events(stream_.census(), recording_.source);
  const auto add = [&](long number, const char* kind, const char* what) {
    add_counted(recording_.events, recording_.source, {number}, {kind, "navigation message", "navigation messages", what});
  };
  add(spoiled_, "navigation_spoiled", "with a wrong parity, length or issue left out");
  add(impossible_, "navigation_impossible", "with an impossible orbit or clock left out");
  add(no_time_, "navigation_no_time", "before a block with a time left out");
}

}  // namespace

record::NavigationRecording read_sbf_navigation(const std::filesystem::path& file) {
  return SbfNavigationReader(file).read();
}

}  // namespace coast::io
