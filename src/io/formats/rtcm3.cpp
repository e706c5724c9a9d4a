// RTCM 3, the messages of base stations and casters: observations, ephemerides, the station.

#include "../rtcm/rtcm_messages.hpp"
#include "../rtcm/rtcm_readers.hpp"
#include "formats.hpp"

namespace coast::io {

namespace {

bool sniff_rtcm3(const FileHead& head) {
  // The answer of a caster or text of the receiver may come first.
  return begins_as_rtcm3(head.text) || head.path.ends_with(".rtcm3") || head.path.ends_with(".rtcm");
}

}  // namespace

Format rtcm3_format() {
  Format format{"rtcm3", "RTCM 3 of base stations and casters", sniff_rtcm3, {}, {}, {}};
  format.read_observations = [](const std::filesystem::path& file) { return read_rtcm_observations(file, std::nullopt); };
  format.read_observations_near = read_rtcm_observations;
  format.read_navigation = [](const std::filesystem::path& file) { return read_rtcm_navigation(file, std::nullopt); };
  format.read_navigation_near = read_rtcm_navigation;
  format.count_messages = [](const std::filesystem::path& file) { return count_frames(file, kRtcmLog); };
  return format;
}

}  // namespace coast::io
