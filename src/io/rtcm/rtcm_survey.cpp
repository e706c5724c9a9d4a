#include "rtcm_survey.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "../ephemerides.hpp"
#include "coast/geo/units.hpp"
#include "rtcm_ephemerides.hpp"
#include "rtcm_measurement.hpp"
#include "rtcm_messages.hpp"

namespace coast::io {

namespace {

constexpr double kHalfRtcmWeek = 302400.0;  // s

/// Follows the observations in a week of its own, and finds how far that is from the week that other messages state.
class Surveyor {
 public:
  Surveyor(const std::filesystem::path& file, std::optional<geo::GpsTime> near) : stream_(file, kRtcmLog), near_(near) {}

  RtcmSurvey survey() {
    MessageFrame frame;
    while (stream_.next(frame)) {
      follow(frame);
      if (const auto week = rtcm_week(frame, near_)) consider(*week);
      note(frame);
    }
    survey_.has_epochs = now_.has_value();
    survey_.week_is_of_file = survey_.start.has_value();
    const bool certain = near_ || rank_ == 0 || rank_ > kOfTenBits;
    if (!certain) survey_.start = by_leap_seconds(*survey_.start);
    if (!survey_.start && near_) survey_.start = now_ ? nearest_second_of_week(*near_, first_.sow()) : *near_;
    return std::move(survey_);
  }

 private:
  void follow(const MessageFrame& frame) {
    constexpr int kAnyWeek = 2000;
    const bool follows = now_ || !is_of_day(frame);
    const auto t = follows ? rtcm_time(frame, now_.value_or(geo::GpsTime::from_week(kAnyWeek, kHalfRtcmWeek))) : std::nullopt;
    if (!t) return;
    if (!now_) first_ = *t;
    now_ = t;
    if (const auto second = second_of_moscow_day(frame))
      vote(*second);
    else
      gps_ = t;
    if (const auto waiting = std::exchange(waiting_, std::nullopt)) consider(*waiting);
  }

  /// Seconds from the week of its own to the one in which the present second of week is nearest to `t`.
  [[nodiscard]] double weeks_to(geo::GpsTime t) const { return nearest_second_of_week(t, now_->sow()) - *now_; }

  /// A week that is not modulo 1024 tells more than one that is; so does an ephemeris of the week in which it is sent, as near
  /// the turn of the week it is not known which of the two weeks a message means.
  void consider(const RtcmWeek& week) {
    if (!now_) {
      if (!waiting_ || week.certain) waiting_ = week;
      if (rank_ < 1) survey_.start = week.t;
      return;
    }
    const bool clear = week.of_message || std::abs(week.t.sow() - now_->sow()) < kHalfRtcmWeek;
    const int rank = 1 + (clear ? 1 : 0) + (week.certain ? kOfTenBits : 0);
    if (rank <= rank_) return;
    rank_ = rank;
    survey_.start = first_ + weeks_to(week.t);
  }

  /// Observations of GPS and GLONASS of one epoch differ by the leap seconds.
  void vote(double moscow) {
    constexpr double kDay = 86400.0, kMoscow = 3.0 * geo::kHour, kMost = 40.0;
    if (!gps_) return;
    const double ahead = std::remainder(gps_->sow() - (moscow - kMoscow), kDay);
    if (ahead >= 0.0 && ahead < kMost) ++leap_seconds_[static_cast<int>(std::lround(ahead))];
  }

  /// Of the weeks that are the same modulo 1024, an earlier one only if it is the one with as many leap seconds.
  [[nodiscard]] geo::GpsTime by_leap_seconds(geo::GpsTime start) const {
    constexpr double kTurn = 1024.0 * 2.0 * kHalfRtcmWeek;
    constexpr int kFirstWeek = 1250;  // 2004, the year of RTCM 3
    if (leap_seconds_.empty()) return start;
    const auto found = std::ranges::max_element(leap_seconds_, {}, [](const auto& one) { return one.second; })->first;
    const geo::GpsTime earlier = start - kTurn;
    const bool is_earlier = earlier.week() > kFirstWeek && geo::leap_seconds(earlier) == found;
    return is_earlier && geo::leap_seconds(start) != found ? earlier : start;
  }

  void note(const MessageFrame& frame) {
    if (const auto channel = channel_in_ephemeris(frame)) survey_.glonass_channels.insert(*channel);
    if (frame.protocol != Protocol::kRtcm3) return;
    const auto msm = msm_kind(frame.id);
    if (msm && msm->is_read()) survey_.msm.insert(msm->system);
    const bool glonass = (msm && msm->system == record::SatelliteSystem::kGlonass && msm->has_rates()) ||
                         legacy_system(frame.id) == record::SatelliteSystem::kGlonass;
    if (!glonass) return;
    const auto measurements = msm ? read_msm(frame) : read_legacy(frame);
    if (measurements)
      for (const auto& channel : measurements->glonass_channels) survey_.glonass_channels.insert(channel);
  }

  static constexpr int kOfTenBits = 2;  ///< the highest rank of a week modulo 1024
  FrameStream stream_;
  std::optional<geo::GpsTime> near_;
  std::optional<geo::GpsTime> now_;   ///< in the week of its own
  std::optional<geo::GpsTime> gps_;   ///< of the last observations of another system than GLONASS
  std::map<int, long> leap_seconds_;  ///< how often GPS was as many seconds ahead
  geo::GpsTime first_;
  std::optional<RtcmWeek> waiting_;  ///< stated before the first observations
  int rank_ = 0;
  RtcmSurvey survey_;
};

}  // namespace

RtcmSurvey survey_rtcm(const std::filesystem::path& file, std::optional<geo::GpsTime> near) {
  return Surveyor(file, near).survey();
}

}  // namespace coast::io
