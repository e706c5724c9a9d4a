#include <fmt/format.h>

#include "../counted.hpp"
#include "../ephemerides.hpp"
#include "coast/record/error.hpp"
#include "rtcm_ephemerides.hpp"
#include "rtcm_messages.hpp"
#include "rtcm_readers.hpp"
#include "rtcm_survey.hpp"

namespace coast::io {

namespace {

class RtcmNavigationReader {
 public:
  RtcmNavigationReader(const std::filesystem::path& file, std::optional<geo::GpsTime> near)
      : survey_(survey_rtcm(file, near)), now_(survey_.start), stream_(file, kRtcmLog) {}

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
  [[noreturn]] void refuse() const;
  void report();

  RtcmSurvey survey_;
  std::optional<geo::GpsTime> now_;
  FrameStream stream_;
  record::NavigationRecording recording_;
  RtcmEphemerides ephemerides_;
  long messages_ = 0, spoiled_ = 0, impossible_ = 0;
};

void RtcmNavigationReader::take(const MessageFrame& frame) {
  if (!now_) return;
  if (const auto t = rtcm_time(frame, *now_)) now_ = t;
  // Without observations the ephemerides are the clock.
  if (!survey_.has_epochs)
    if (const auto week = rtcm_week(frame, now_)) now_ = week->t;
  const auto use = ephemerides_.take(frame, *now_, recording_);
  if (!use) return;
  ++messages_;
  if (use == MessageUse::kWrong) ++spoiled_;
  if (use == MessageUse::kImpossible) ++impossible_;
}

void RtcmNavigationReader::refuse() const {
  const bool has_glonass = stream_.census().number(Protocol::kRtcm3, rtcm::kGlonassEphemeris) > 0;
  if (messages_ == 0 && !has_glonass)
    throw InputError({stream_.name(), 0, "an RTCM 3 file without 1019, 1020, 1042, 1044, 1045 and 1046", "ephemerides",
                      "Give a RINEX navigation file, or let the station send these messages."});
  throw InputError({stream_.name(), 0,
                    now_ ? fmt::format("{} messages of ephemerides, none that can be used", messages_)
                         : std::string("ephemerides of GLONASS, and nothing that states the GPS week"),
                    "at least one ephemeris", "Give a RINEX navigation file as well."});
}

void RtcmNavigationReader::report() {
  using Grade = record::Event::Severity;
  recording_.events = rtcm_file_events(stream_.census(), recording_.source);
  const auto add = [&](long number, const char* kind, const char* what) {
    add_counted(recording_.events, recording_.source, {number},
                {kind, "navigation message", "navigation messages", what, Grade::kWarning});
  };
  add(spoiled_, "navigation_spoiled", "with a wrong length, satellite or week left out");
  add(impossible_, "navigation_impossible", "with an impossible orbit or clock left out");
}

}  // namespace

record::NavigationRecording read_rtcm_navigation(const std::filesystem::path& file, std::optional<geo::GpsTime> near) {
  return RtcmNavigationReader(file, near).read();
}

}  // namespace coast::io
