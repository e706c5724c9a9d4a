// Observations of RANGE and its compressed forms.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "../counted.hpp"
#include "coast/record/error.hpp"
#include "novatel_ranges.hpp"
#include "novatel_readers.hpp"

namespace coast::io {

namespace {

using record::Observation;

/// What the lock of a signal was when it was last seen.
struct NovAtelLock {
  geo::GpsTime t;
  double lock_s = 0.0;
  bool half_cycle_added = false;
  bool slip_waits = true;  ///< a loss of lock that no phase has carried yet; a signal begins with one
};

class NovAtelObservationReader {
 public:
  explicit NovAtelObservationReader(const std::filesystem::path& file) : stream_(file) {}

  record::ObservationRecording read() {
    recording_.source = stream_.name();
    recording_.receiver = "NovAtel";
    NovAtelLog log;
    while (stream_.next(log))
      if (is_range_log(log.id)) take(log);
    if (recording_.epochs.empty()) refuse();
    report();
    return std::move(recording_);
  }

 private:
  void take(const NovAtelLog& log);
  void take_range(const NovAtelRange& range, geo::GpsTime t);
  [[nodiscard]] bool lost_lock(const NovAtelRange& range, geo::GpsTime t);
  [[noreturn]] void refuse() const;
  void report();

  NovAtelStream stream_;
  NovAtelRangeDecoder decoder_;
  record::ObservationRecording recording_;
  std::vector<Observation> row_;
  std::map<std::pair<record::Satellite, record::Signal>, NovAtelLock> locks_;
  std::optional<std::uint32_t> kind_;  ///< the log that the recording is of
  Counted spoiled_, no_time_, empty_, unknown_, reference_, impossible_, doubled_, repeated_, reversed_, other_kind_, second_;
};

void NovAtelObservationReader::take(const NovAtelLog& log) {
  const auto t = log.time();
  if (log.second_antenna) return second_.add(t);
  // A file with two forms of the same measurements: the first one.
  if (kind_ && *kind_ != log.id) return other_kind_.add(t);
  const NovAtelRanges ranges = decoder_.decode(log);
  if (!ranges.whole) return spoiled_.add(t);
  if (!t) return no_time_.add();
  if (ranges.ranges.empty()) return empty_.add(t);
  kind_ = log.id;
  const auto& epochs = recording_.epochs;
  if (!epochs.empty() && *t == epochs.back().t) return repeated_.add(t);
  if (!epochs.empty() && *t < epochs.back().t) return reversed_.add(t);
  for (long i = 0; i < ranges.unknown; ++i) unknown_.add(t);
  for (long i = 0; i < ranges.reference; ++i) reference_.add(t);
  row_.clear();
  for (const NovAtelRange& range : ranges.ranges) take_range(range, *t);
  if (row_.empty()) return empty_.add(t);
  std::ranges::stable_sort(row_, {}, [](const Observation& o) { return std::pair(o.satellite, o.signal); });
  recording_.epochs.push_back({*t, row_});
}

void NovAtelObservationReader::take_range(const NovAtelRange& range, geo::GpsTime t) {
  constexpr double kFarthest = 1e9, kMostCycles = 1e11, kMostHertz = 1e6, kMostCn0 = 100.0;
  constexpr int kLowestChannel = -7, kHighestChannel = 6;
  const auto same = [&](const Observation& o) { return o.satellite == range.satellite && o.signal == range.signal; };
  if (std::ranges::any_of(row_, same)) return doubled_.add(t);
  // Comparisons that NaN does not pass.
  const bool possible = (!range.code_m || (*range.code_m > 0.0 && *range.code_m < kFarthest)) &&
                        (!range.phase_cycles || std::abs(*range.phase_cycles) < kMostCycles) &&
                        (!range.doppler_hz || std::abs(*range.doppler_hz) < kMostHertz) && range.cn0_dbhz >= 0.0 &&
                        range.cn0_dbhz < kMostCn0 && range.lock_s >= 0.0;
  if (!possible) return impossible_.add(t);
  Observation o;
  o.satellite = range.satellite;
  o.signal = range.signal;
  o.code_m = range.code_m;
  o.phase_cycles = range.phase_cycles;
  o.doppler_hz = range.doppler_hz;
  if (range.cn0_dbhz > 0.0) o.cn0_dbhz = range.cn0_dbhz;
  o.half_cycle = o.phase_cycles && !range.half_cycle_known;
  o.lost_lock = lost_lock(range, t);
  if (range.glonass_channel && *range.glonass_channel >= kLowestChannel && *range.glonass_channel <= kHighestChannel)
    recording_.glonass_channels[range.satellite.number] = *range.glonass_channel;
  if (o.code_m || o.phase_cycles) row_.push_back(o);
}

/// The phase is continuous if the time of lock has grown with time.
bool NovAtelObservationReader::lost_lock(const NovAtelRange& range, geo::GpsTime t) {
  constexpr double kTolerance = 0.05;  // s: the time of lock is of the tracking loop, which has epochs of its own
  NovAtelLock& lock = locks_[{range.satellite, range.signal}];
  const bool seen = lock.t != geo::GpsTime();
  const bool interrupted = seen && range.lock_up_to_s + kTolerance < lock.lock_s + (t - lock.t);
  lock.slip_waits = lock.slip_waits || interrupted || (seen && range.half_cycle_added != lock.half_cycle_added);
  lock.t = t;
  lock.lock_s = range.lock_s;
  lock.half_cycle_added = range.half_cycle_added;
  if (!range.phase_cycles) return false;
  return std::exchange(lock.slip_waits, false);
}

void NovAtelObservationReader::refuse() const {
  long logs = 0;
  for (const std::uint32_t id :
       {novatel::kRange, novatel::kRangeCmp, novatel::kRangeCmp2, novatel::kRangeCmp4, novatel::kRangeCmp5})
    logs += stream_.number(id);
  throw InputError({stream_.name(), 0,
                    logs == 0 ? std::string("NovAtel logs without RANGE, RANGECMP, RANGECMP2, RANGECMP4 and RANGECMP5")
                              : fmt::format("{} logs of ranges, none with a time and a signal", logs),
                    "observations",
                    logs == 0 ? "Log one of them; positions and ephemerides are read without." : "Was the antenna connected?"});
}

void NovAtelObservationReader::report() {
  using Grade = record::Event::Severity;
  recording_.events = stream_.events();
  const CountedEvents add(recording_.events, recording_.source);
  add(spoiled_, "range_spoiled", "epoch", "epochs", "whose body contradicts its length left out", Grade::kWarning);
  add(no_time_, "range_no_time", "epoch", "epochs", "before the receiver knew GPS time finely left out", Grade::kInfo);
  add(empty_, "range_empty", "epoch", "epochs", "without a signal left out", Grade::kInfo);
  add(second_, "range_second_antenna", "epoch", "epochs", "of the second antenna left out", Grade::kInfo);
  add(other_kind_, "range_other_log", "epoch", "epochs", "of a further log of ranges left out", Grade::kInfo);
  add(unknown_, "range_unknown_signal", "measurement", "measurements", "of an unknown satellite or signal left out",
      Grade::kInfo);
  add(reference_, "range_no_reference", "measurement", "measurements",
      "as differences from an epoch that is not in the file left out", Grade::kWarning);
  add(impossible_, "range_impossible", "measurement", "measurements", "that no receiver measures left out", Grade::kWarning);
  add(doubled_, "range_repeated_signal", "measurement", "measurements", "of a signal that the epoch has already left out",
      Grade::kInfo);
  add(repeated_, "range_repeated_epoch", "epoch", "epochs", "with the time of the one before left out", Grade::kWarning);
  add(reversed_, "range_reversed_epoch", "epoch", "epochs", "earlier than the one before left out", Grade::kWarning);
}

}  // namespace

record::ObservationRecording read_novatel_observations(const std::filesystem::path& file) {
  return NovAtelObservationReader(file).read();
}

}  // namespace coast::io
