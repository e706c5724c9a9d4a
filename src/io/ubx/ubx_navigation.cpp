// Navigation messages of UBX-RXM-SFRBX (u-blox F9 HPG integration manual, "Broadcast navigation data"): how each system's
// message lies in words of 32 bits. Their content is decoded in broadcast/.

#include <fmt/format.h>

#include <vector>

#include "../binary.hpp"
#include "../broadcast/beidou_messages.hpp"
#include "../broadcast/galileo_fnav.hpp"
#include "../broadcast/galileo_inav.hpp"
#include "../broadcast/glonass_strings.hpp"
#include "../broadcast/gps_lnav.hpp"
#include "../counted.hpp"
#include "../ephemerides.hpp"
#include "ubx_messages.hpp"
#include "ubx_readers.hpp"
#include "ubx_signals.hpp"

namespace coast::io {

namespace {

using System = record::SatelliteSystem;

/// Head and words of one RXM-SFRBX.
struct Subframe {
  std::uint8_t gnss = 0, sv = 0, signal = 0;
  std::uint8_t frequency = 0;  ///< GLONASS: channel + 7
  std::vector<std::uint32_t> words;
};

std::optional<Subframe> subframe_of(std::string_view payload) {
  constexpr std::size_t kHead = 8;
  if (payload.size() < kHead) return std::nullopt;
  const auto byte = [&](std::size_t at) { return number_at<std::uint8_t>(payload, at); };
  const std::size_t words = byte(4);
  // Version 1 has no signal; it was of receivers with one signal a system.
  if (payload.size() != kHead + 4 * words || words == 0) return std::nullopt;
  Subframe s{byte(0), byte(1), byte(6) >= 2 ? byte(2) : std::uint8_t{0}, byte(3), {}};
  for (std::size_t i = 0; i < words; ++i) s.words.push_back(number_at<std::uint32_t>(payload, kHead + 4 * i));
  return s;
}

/// The words' bits in the order of transmission.
template <std::size_t Bytes>
std::array<std::uint8_t, Bytes> bytes_of(const std::vector<std::uint32_t>& words) {
  std::array<std::uint8_t, Bytes> bytes{};
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes.at(i) = static_cast<std::uint8_t>(words.at(i / 4) >> (24 - 8 * (i % 4)));
  return bytes;
}

/// Of B1I, B2I and B3I; the newer signals send the messages B-CNAV1 to 3.
bool is_beidou_d1_or_d2(std::uint8_t signal) {
  constexpr std::uint8_t kB3d1 = 4, kB3d2 = 10;
  return signal <= kB3d1 || signal == kB3d2;
}

std::string_view kind_of(System system, std::uint8_t signal) {
  switch (system) {
    case System::kGps:
      return signal == 0 ? "GPS LNAV" : "GPS CNAV";
    case System::kQzss:
      return signal == 0 ? "QZSS LNAV" : signal == 1 ? "QZSS L1S" : "QZSS CNAV";
    case System::kGalileo:
      return signal == 1 || signal == 5 ? "Galileo I/NAV" : signal == 3 ? "Galileo F/NAV" : "Galileo C/NAV";
    case System::kGlonass:
      return "GLONASS";
    case System::kBeidou:
      return is_beidou_d1_or_d2(signal) ? "BeiDou D1 and D2" : "BeiDou CNAV";
    case System::kSbas:
      return "SBAS";
    case System::kNavic:
      break;
  }
  return "NavIC";
}

class SubframeReader {
 public:
  explicit SubframeReader(const std::filesystem::path& file) : now_(first_stated_time(file)), stream_(file, kUbxLog) {}

  record::NavigationRecording read() {
    recording_.source = stream_.name();
    MessageFrame frame;
    while (stream_.next(frame)) {
      if (const auto t = stated_time(frame)) now_ = t;
      if (frame.protocol == Protocol::kUbx && frame.id == ubx::kRxmSfrbx) take(frame.payload);
    }
    static_cast<void>(sort_out(recording_));  // both frequencies of Galileo send the same
    if (recording_.kepler.empty() && recording_.tabulated.empty()) refuse();
    report();
    return std::move(recording_);
  }

 private:
  void take(std::string_view payload);
  [[nodiscard]] std::optional<MessageUse> decode(record::Satellite satellite, const Subframe& subframe);
  [[noreturn]] void refuse() const;
  void report();

  std::optional<geo::GpsTime> now_;  ///< the messages themselves state the week modulo a number
  FrameStream stream_;
  record::NavigationRecording recording_;
  LnavDecoder lnav_;
  InavDecoder inav_;
  FnavDecoder fnav_;
  BeidouDecoder beidou_;
  GlonassDecoder glonass_;
  long spoiled_ = 0, impossible_ = 0;
  std::map<std::string_view, long> not_decoded_;
};

void SubframeReader::take(std::string_view payload) {
  const auto subframe = subframe_of(payload);
  if (!subframe) {
    ++spoiled_;
    return;
  }
  const auto satellite = ubx_satellite(subframe->gnss, subframe->sv);
  if (!satellite) {
    ++not_decoded_["unknown satellites"];
    return;
  }
  if (!now_) return;
  const auto use = decode(*satellite, *subframe);
  if (!use) ++not_decoded_[kind_of(satellite->system, subframe->signal)];
  if (use == MessageUse::kWrong) ++spoiled_;
  if (use == MessageUse::kImpossible) ++impossible_;
}

/// None for a message that no decoder is for.
std::optional<MessageUse> SubframeReader::decode(record::Satellite satellite, const Subframe& subframe) {
  constexpr std::size_t kGalileoWords = 8, kInavBytes = 32, kFnavBytes = 31, kGlonassWords = 4, kGlonassBytes = 16;
  constexpr int kChannelOffset = 7;
  const std::size_t words = subframe.words.size();
  const bool ca = subframe.signal == 0;
  if ((satellite.system == System::kGps || satellite.system == System::kQzss) && ca)
    return lnav_.take(satellite, subframe.words, *now_, recording_);
  if (satellite.system == System::kGalileo && (subframe.signal == 1 || subframe.signal == 5) && words >= kGalileoWords)
    return inav_.take(satellite, bytes_of<kInavBytes>(subframe.words), *now_, recording_);
  if (satellite.system == System::kGalileo && subframe.signal == 3 && words >= kGalileoWords)
    return fnav_.take(satellite, bytes_of<kFnavBytes>(subframe.words), *now_, recording_);
  if (satellite.system == System::kBeidou && is_beidou_d1_or_d2(subframe.signal))
    return beidou_.take(satellite, subframe.words, *now_, recording_);
  if (satellite.system == System::kGlonass && words >= kGlonassWords)
    return glonass_.take(satellite, bytes_of<kGlonassBytes>(subframe.words), subframe.words[3],
                         subframe.frequency - kChannelOffset, *now_, recording_);
  return std::nullopt;
}

void SubframeReader::refuse() const {
  const long messages = stream_.census().number(Protocol::kUbx, ubx::kRxmSfrbx);
  if (messages == 0)
    throw InputError({stream_.name(), 0, "a UBX file without UBX-RXM-SFRBX", "navigation messages",
                      "Give a RINEX navigation file, or switch this message on in the receiver."});
  throw InputError({stream_.name(), 0,
                    fmt::format("{} UBX-RXM-SFRBX messages, but no whole ephemeris{}", messages,
                                now_ ? "" : "; no UBX-RXM-RAWX, NAV-PVT or NAV-TIMEGPS states the week"),
                    "at least one ephemeris", "An ephemeris takes 30 s to receive. Give a RINEX navigation file as well."});
}

void SubframeReader::report() {
  using Grade = record::Event::Severity;
  recording_.events = ubx_file_events(stream_.census(), recording_.source);
  const auto add = [&](long number, const char* kind, std::string what, Grade severity) {
    add_counted(recording_.events, recording_.source, {number},
                {kind, "navigation message", "navigation messages", std::move(what), severity});
  };
  add(spoiled_, "navigation_spoiled", "with a wrong parity, length or week left out", Grade::kWarning);
  add(impossible_, "navigation_impossible", "with an impossible orbit or clock left out", Grade::kWarning);
  for (const auto& [kind, number] : not_decoded_)
    add(number, "navigation_unknown", fmt::format("of {} not used", kind), Grade::kInfo);
}

}  // namespace

record::NavigationRecording read_ubx_navigation(const std::filesystem::path& file) {
  return SubframeReader(file).read();
}

}  // namespace coast::io
