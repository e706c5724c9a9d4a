// Observations of RTCM 3: MSM4 to MSM7, and 1002, 1004, 1010, 1012.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "../carriers.hpp"
#include "../counted.hpp"
#include "coast/record/error.hpp"
#include "rtcm_measurement.hpp"
#include "rtcm_messages.hpp"
#include "rtcm_readers.hpp"
#include "rtcm_station.hpp"
#include "rtcm_survey.hpp"

namespace coast::io {

namespace {

using record::Observation;
using System = record::SatelliteSystem;

/// What a signal was when it was last seen.
struct RtcmLock {
  std::optional<geo::GpsTime> t;
  double lock_s = 0.0;
  bool slip_waits = true;                  ///< a loss of lock that no phase has carried yet; a signal begins with one
  std::optional<double> phase_minus_code;  ///< cycles, of 1002 to 1012
};

class RtcmObservationReader {
 public:
  RtcmObservationReader(const std::filesystem::path& file, std::optional<geo::GpsTime> near)
      : survey_(survey_rtcm(file, near)), now_(survey_.start), stream_(file, kRtcmLog) {}

  record::ObservationRecording read() {
    recording_.source = stream_.name();
    MessageFrame frame;
    while (stream_.next(frame)) take(frame);
    std::erase_if(recording_.epochs, [](const record::ObservationEpoch& epoch) { return epoch.observations.empty(); });
    if (recording_.epochs.empty()) refuse();
    for (record::ObservationEpoch& epoch : recording_.epochs)
      std::ranges::stable_sort(epoch.observations, {}, [](const Observation& o) { return std::pair(o.satellite, o.signal); });
    if (station_) put_station(stations_[*station_], recording_);
    recording_.glonass_channels = survey_.glonass_channels;
    report();
    return std::move(recording_);
  }

 private:
  void take(const MessageFrame& frame);
  void take_epoch(const MessageFrame& frame);
  [[nodiscard]] record::ObservationEpoch* epoch_at(geo::GpsTime t);
  void take_measurement(const RtcmMeasurement& m, geo::GpsTime t, record::ObservationEpoch& epoch);
  [[nodiscard]] Observation observation(const RtcmMeasurement& m, RtcmLock& lock);
  [[nodiscard]] static double turned_back(const RtcmMeasurement& m, double wavelength, RtcmLock& lock);
  [[nodiscard]] std::optional<int> channel_of(record::Satellite satellite) const;
  [[noreturn]] void refuse() const;
  void report();

  RtcmSurvey survey_;
  std::optional<geo::GpsTime> now_;
  FrameStream stream_;
  record::ObservationRecording recording_;
  std::map<int, RtcmStation> stations_;
  std::optional<int> station_;  ///< of the first observations
  std::map<std::pair<record::Satellite, record::Signal>, RtcmLock> locks_;
  long epochs_ = 0;
  Counted spoiled_, other_station_, legacy_, unknown_, impossible_, doubled_, no_channel_, reversed_;
};

void RtcmObservationReader::take(const MessageFrame& frame) {
  const auto id = rtcm_station_id(frame);
  if (!id) return;
  take_station(frame, stations_[*id]);
  const auto msm = msm_kind(frame.id);
  const auto legacy = legacy_system(frame.id);
  if (!(msm && msm->is_read()) && !legacy) {
    if (now_)
      if (const auto t = rtcm_time(frame, *now_)) now_ = t;
    return;
  }
  ++epochs_;
  if (!now_) return;
  if (!station_) station_ = id;
  if (station_ != id) return other_station_.add();
  if (legacy && survey_.msm.contains(*legacy)) return legacy_.add();
  take_epoch(frame);
}

void RtcmObservationReader::take_epoch(const MessageFrame& frame) {
  const auto t = rtcm_time(frame, *now_);
  const auto measurements = msm_kind(frame.id) ? read_msm(frame) : read_legacy(frame);
  if (!t || !measurements) return spoiled_.add();
  now_ = t;
  for (long i = 0; i < measurements->unknown; ++i) unknown_.add(t);
  record::ObservationEpoch* epoch = epoch_at(*t);
  if (epoch == nullptr) return reversed_.add(t);
  for (const RtcmMeasurement& m : measurements->signals) take_measurement(m, *t, *epoch);
}

/// Messages of one time are one epoch, whatever their bit for "more to come" says: casters clear it. Those of different systems
/// may come some epochs apart.  @return null for a time before all of these epochs
record::ObservationEpoch* RtcmObservationReader::epoch_at(geo::GpsTime t) {
  constexpr std::ptrdiff_t kBack = 64;
  auto& epochs = recording_.epochs;
  auto at = epochs.end();
  while (at != epochs.begin() && std::prev(at)->t > t && epochs.end() - at < kBack) --at;
  if (at != epochs.begin() && std::prev(at)->t > t) return nullptr;
  if (at != epochs.begin() && std::prev(at)->t == t) return &*std::prev(at);
  return &*epochs.insert(at, {t, {}});
}

void RtcmObservationReader::take_measurement(const RtcmMeasurement& m, geo::GpsTime t, record::ObservationEpoch& epoch) {
  constexpr double kFarthest = 1e9, kMostCycles = 1e11, kMostHertz = 1e6, kMillisecond = 1e-3;
  RtcmLock& lock = locks_[{m.satellite, m.signal}];
  if (lock.t && *lock.t >= t) return doubled_.add(t);
  const double since = lock.t ? t - *lock.t : 0.0;
  // The phase is continuous since the signal was last seen if it has been locked for at least as long.
  const bool interrupted = m.lock_s < lock.lock_s || m.lock_s + kMillisecond < since;
  lock.slip_waits = lock.slip_waits || interrupted;
  if (interrupted) lock.phase_minus_code.reset();
  lock.t = t;
  lock.lock_s = m.lock_s;
  Observation o = observation(m, lock);
  const bool possible = (!o.code_m || (*o.code_m > 0.0 && *o.code_m < kFarthest)) &&
                        std::abs(o.phase_cycles.value_or(0.0)) < kMostCycles &&
                        std::abs(o.doppler_hz.value_or(0.0)) < kMostHertz;
  if (!possible) return impossible_.add(t);
  if (m.phase_m && !o.phase_cycles) no_channel_.add(t);
  if (!o.code_m && !o.phase_cycles) return;
  if (o.phase_cycles) o.lost_lock = std::exchange(lock.slip_waits, false);
  epoch.observations.push_back(o);
}

Observation RtcmObservationReader::observation(const RtcmMeasurement& m, RtcmLock& lock) {
  Observation o;
  o.satellite = m.satellite;
  o.signal = m.signal;
  o.code_m = m.code_m;
  o.cn0_dbhz = m.cn0_dbhz;
  const auto frequency = carrier_frequency(m.satellite.system, m.signal.band, channel_of(m.satellite));
  if (!frequency) return o;
  const double wavelength = kSpeedOfLight / *frequency;
  if (m.phase_m) o.phase_cycles = m.turns_about_m ? turned_back(m, wavelength, lock) : *m.phase_m / wavelength;
  if (m.rate_mps) o.doppler_hz = -*m.rate_mps / wavelength;
  o.half_cycle = o.phase_cycles && m.half_cycle;
  return o;
}

/// DF012: where phase and code drift apart by more than the field holds, the station turns the phase back by 1500 cycles.
double RtcmObservationReader::turned_back(const RtcmMeasurement& m, double wavelength, RtcmLock& lock) {
  constexpr double kTurn = 1500.0;
  double difference = (*m.phase_m - *m.turns_about_m) / wavelength;
  if (lock.phase_minus_code) difference -= kTurn * std::round((difference - *lock.phase_minus_code) / kTurn);
  lock.phase_minus_code = difference;
  return *m.turns_about_m / wavelength + difference;
}

std::optional<int> RtcmObservationReader::channel_of(record::Satellite satellite) const {
  if (satellite.system != System::kGlonass) return std::nullopt;
  const auto found = survey_.glonass_channels.find(satellite.number);
  return found == survey_.glonass_channels.end() ? std::nullopt : std::optional(found->second);
}

void RtcmObservationReader::refuse() const {
  if (epochs_ == 0)
    throw InputError({stream_.name(), 0, "an RTCM 3 file without MSM4 to MSM7, 1002, 1004, 1010 and 1012", "observations",
                      "Let the station send one of these; MSM1 to MSM3, 1001, 1003, 1009 and 1011 leave out parts of them."});
  if (!now_)
    throw InputError({stream_.name(), 0,
                      fmt::format("{} messages of observations, and nothing that states the GPS week", epochs_),
                      "ephemerides (1019, 1042, 1044, 1045, 1046) or 1013 beside them",
                      "`nav` of a ppk.yaml gives the week, and `coast inspect --gps-week 2374 FILE` states it."});
  throw InputError({stream_.name(), 0, fmt::format("{} messages of observations, none with a signal", epochs_), "observations",
                    "Was the antenna connected?"});
}

void RtcmObservationReader::report() {
  using Grade = record::Event::Severity;
  recording_.events = rtcm_file_events(stream_.census(), recording_.source);
  const CountedEvents add(recording_.events, recording_.source);
  if (!survey_.week_is_of_file)
    recording_.events.push_back({Grade::kInfo, "rtcm_week_not_stated",
                                 fmt::format("{}: nothing in it states the week: {} is taken for the first epoch",
                                             recording_.source, recording_.epochs.front().t.week()),
                                 recording_.epochs.front().t, 1});
  add(spoiled_, "rtcm_spoiled", "message", "messages", "of observations that are too short or have no time left out",
      Grade::kWarning);
  add(other_station_, "rtcm_other_station", "message", "messages", "of observations of another station left out",
      Grade::kWarning);
  add(legacy_, "rtcm_legacy_left_out", "message", "messages", "of 1002 to 1012 not used, as MSM states the same", Grade::kInfo);
  add(unknown_, "rtcm_unknown_signal", "measurement", "measurements", "of an unknown satellite or signal left out",
      Grade::kInfo);
  add(impossible_, "rtcm_impossible", "measurement", "measurements", "that no receiver measures left out", Grade::kWarning);
  add(doubled_, "rtcm_repeated_signal", "measurement", "measurements", "of a signal that the epoch has already left out",
      Grade::kWarning);
  add(no_channel_, "rtcm_no_channel", "phase", "phases",
      "of GLONASS left out: neither 1020, MSM5, MSM7, 1010 nor 1012 states the frequency number", Grade::kWarning);
  add(reversed_, "rtcm_reversed_epoch", "message", "messages", "of observations earlier than the epochs before left out",
      Grade::kWarning);
}

}  // namespace

record::ObservationRecording read_rtcm_observations(const std::filesystem::path& file, std::optional<geo::GpsTime> near) {
  return RtcmObservationReader(file, near).read();
}

}  // namespace coast::io
