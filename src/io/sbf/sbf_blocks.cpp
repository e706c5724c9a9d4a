#include "sbf_blocks.hpp"

#include <algorithm>
#include <array>

namespace coast::io {

std::optional<std::uint32_t> sbf_milliseconds(std::string_view payload) {
  constexpr std::uint32_t kWeekMs = 604'800'000;  // what is not known has all bits set
  const auto tow = number_at<std::uint32_t>(payload, 0);
  return tow < kWeekMs ? std::optional(tow) : std::nullopt;
}

std::optional<geo::GpsTime> sbf_time(std::string_view payload) {
  constexpr int kLargestWeek = 9999;  // beyond, not known, or damage that the checksum has missed
  if (payload.size() < kSbfBody) return std::nullopt;
  const auto ms = sbf_milliseconds(payload);
  const int week = number_at<std::uint16_t>(payload, 4);
  if (!ms || week == 0 || week > kLargestWeek) return std::nullopt;
  return geo::GpsTime::from_week(week, 1e-3 * *ms);
}

std::string SbfFields::text(std::size_t size) {
  std::string text;
  for (const char c : payload_.substr(at_, size)) {
    if (c == '\0') break;
    if (c >= ' ' && c <= '~') text += c;
  }
  at_ += size;
  return text;
}

record::Events sbf_file_events(const FrameCensus& census, const std::string& file) {
  static constexpr std::array kRead = {sbf::kGalNav,         sbf::kGloNav,          sbf::kPvtCartesian,   sbf::kPvtGeodetic,
                                       sbf::kGpsRawCa,       sbf::kGalRawInav,      sbf::kGloRawCa,       sbf::kMeasEpoch,
                                       sbf::kExtSensorMeas,  sbf::kQzsRawL1Ca,      sbf::kBdsNav,         sbf::kQzsNav,
                                       sbf::kGpsNav,         sbf::kGpsIon,          sbf::kReceiverSetup,  sbf::kPosCovCartesian,
                                       sbf::kPosCovGeodetic, sbf::kVelCovCartesian, sbf::kVelCovGeodetic, sbf::kExtEvent};
  return file_events(census, file, [](Protocol protocol, std::uint32_t id) {
    return protocol == Protocol::kSbf && std::ranges::find(kRead, id) != kRead.end();
  });
}

bool begins_as_sbf(std::string_view head) {
  for (std::size_t at = head.find("$@"); at != std::string_view::npos; at = head.find("$@", at + 1)) {
    const FrameTrial trial = try_sbf(head.substr(at));
    // A long first block may go on beyond what has been read of the file; then its beginning has to do.
    if (trial.verdict == FrameTrial::Verdict::kFrame || (trial.verdict == FrameTrial::Verdict::kMore && at == 0)) return true;
  }
  return false;
}

}  // namespace coast::io
