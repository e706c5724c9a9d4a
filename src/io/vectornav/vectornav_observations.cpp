// Observations of a VectorNav's GNSS receiver, from RawMeas; of the second one where the file has none of the first.

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "../counted.hpp"
#include "../observation_rows.hpp"
#include "coast/record/error.hpp"
#include "vectornav_raw.hpp"
#include "vectornav_readers.hpp"
#include "vectornav_stream.hpp"
#include "vectornav_values.hpp"

namespace coast::io {

namespace {

/// What the lock of a signal was when it was last seen.
struct VectorNavLock {
  geo::GpsTime t;
  bool half_cycle = false;
};

class VectorNavRawReader {
 public:
  VectorNavRawReader(const std::filesystem::path& file, VectorNavGroup receiver) : stream_(file), receiver_(receiver) {}

  /// Nothing if this receiver has not measured.
  std::optional<record::ObservationRecording> read() {
    recording_.source = stream_.name();
    recording_.receiver = "VectorNav";
    VectorNavMessage message;
    while (stream_.next(message)) take(message);
    if (recording_.epochs.empty()) return std::nullopt;
    report();
    return std::move(recording_);
  }

 private:
  void take(const VectorNavMessage& message);
  void take_epoch(const VectorNavRaw& epoch);
  void take_measurement(const VectorNavRaw::Measurement& measurement, geo::GpsTime t);
  void report();

  VectorNavStream stream_;
  VectorNavGroup receiver_;
  record::ObservationRecording recording_;
  ObservationRows rows_{recording_};
  std::map<std::pair<record::Satellite, record::Signal>, VectorNavLock> locks_;
  std::optional<geo::GpsTime> last_, before_last_;
  Counted no_time_, unknown_, impossible_;
};

void VectorNavRawReader::take(const VectorNavMessage& message) {
  if (!recording_.approximate_r_e) recording_.approximate_r_e = vectornav_position(message);
  if (const auto epoch = vectornav_raw(message, receiver_)) take_epoch(*epoch);
}

void VectorNavRawReader::take_epoch(const VectorNavRaw& epoch) {
  if (!epoch.t) return no_time_.add();
  if (epoch.t == last_) return;  // the sensor repeats measurements until there are new ones
  if (!rows_.begin(*epoch.t)) return;
  before_last_ = std::exchange(last_, epoch.t);
  for (long i = 0; i < epoch.unknown; ++i) unknown_.add(*epoch.t);
  for (long i = 0; i < epoch.impossible; ++i) impossible_.add(*epoch.t);
  for (const VectorNavRaw::Measurement& measurement : epoch.measurements) take_measurement(measurement, *epoch.t);
  rows_.end();
}

/// The sensor states slips and no time of lock: a signal that was away for an epoch has lost it, too.
void VectorNavRawReader::take_measurement(const VectorNavRaw::Measurement& m, geo::GpsTime t) {
  record::Observation o = m.observation;
  if (!rows_.is_new(o.satellite, o.signal)) return;
  if (m.channel) recording_.glonass_channels[o.satellite.number] = *m.channel;
  const auto [lock, first] = locks_.try_emplace({o.satellite, o.signal});
  const bool away = first || lock->second.t != before_last_;
  o.lost_lock = o.lost_lock || away || (lock->second.half_cycle && !o.half_cycle);
  lock->second = {t, o.half_cycle};
  rows_.add(o);
}

void VectorNavRawReader::report() {
  using Grade = record::Event::Severity;
  recording_.events = vectornav_file_events(stream_.census(), recording_.source);
  const CountedEvents add(recording_.events, recording_.source);
  add(no_time_, "vectornav_no_time", "epoch", "epochs", "before the receiver knew the time left out", Grade::kInfo);
  add(unknown_, "vectornav_unknown_signal", "measurement", "measurements", "of an unknown satellite or signal left out",
      Grade::kInfo);
  add(impossible_, "vectornav_impossible", "measurement", "measurements", "that no receiver makes left out", Grade::kWarning);
  rows_.report("vectornav");
}

}  // namespace

record::ObservationRecording read_vectornav_observations(const std::filesystem::path& file) {
  for (const VectorNavGroup receiver : {VectorNavGroup::kGnss1, VectorNavGroup::kGnss2})
    if (auto recording = VectorNavRawReader(file, receiver).read()) return *std::move(recording);
  throw InputError({file.string(), 0, "VectorNav messages without measurements in RawMeas", "observations",
                    "Add RawMeas of the GNSS group to the output; positions are read without."});
}

}  // namespace coast::io
