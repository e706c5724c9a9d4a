// Observations of SBF MeasEpoch, with the names of ReceiverSetup and the first position of the receiver (mosaic-X5 reference
// guide 4.14.10).

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "../counted.hpp"
#include "../observation_rows.hpp"
#include "coast/record/error.hpp"
#include "sbf_blocks.hpp"
#include "sbf_meas_epoch.hpp"
#include "sbf_pvt.hpp"
#include "sbf_readers.hpp"

namespace coast::io {

namespace {

/// What the lock of a signal was when it last had a phase.
struct SbfLock {
  geo::GpsTime t;
  int lock_s = 0;
  bool half_cycle = false;
  bool seen = false;

  /// The phase is continuous since then if it has been locked for at least as long. Times are cut to whole seconds: in the
  /// first second after a loss the phase counts as interrupted. A half cycle may be added when it becomes known.
  [[nodiscard]] bool interrupted(const SbfMeasurement& m, geo::GpsTime now) const {
    constexpr double kStamp = 1e-3;  // s
    if (!seen || (half_cycle && !m.observation.half_cycle)) return true;
    if (*m.lock_s < std::min(lock_s, m.longest_lock_s)) return true;
    return *m.lock_s < m.longest_lock_s && *m.lock_s + kStamp < now - t;
  }
};

class SbfObservationReader {
 public:
  explicit SbfObservationReader(const std::filesystem::path& file) : stream_(file, kSbfLog) {}

  record::ObservationRecording read() {
    recording_.source = stream_.name();
    MessageFrame frame;
    while (stream_.next(frame)) {
      if (frame.protocol != Protocol::kSbf) continue;
      if (frame.id == sbf::kMeasEpoch) take_epoch(frame.payload);
      if (frame.id == sbf::kReceiverSetup) take_setup(frame.payload);
      if (!recording_.approximate_r_e) take_position(frame);
    }
    if (recording_.epochs.empty()) refuse();
    report();
    return std::move(recording_);
  }

 private:
  void take_setup(std::string_view payload);
  void take_position(const MessageFrame& frame);
  void take_epoch(std::string_view payload);
  void take_measurement(SbfMeasurement& measurement, geo::GpsTime t);
  [[noreturn]] void refuse() const;
  void report();

  FrameStream stream_;
  record::ObservationRecording recording_;
  ObservationRows rows_{recording_};
  std::map<std::pair<record::Satellite, record::Signal>, SbfLock> locks_;
  std::optional<int> clock_jumps_ms_;
  Counted spoiled_, no_time_, scrambled_, unknown_, other_antenna_, clock_resets_;
};

/// Names, and the antenna reference point from the marker. What has not been set reads "Unknown".
void SbfObservationReader::take_setup(std::string_view payload) {
  constexpr std::size_t kOffsets = 260, kProduct = 360;
  if (payload.size() < kOffsets) return;
  const auto named = [](std::string name) { return name == "Unknown" ? std::string() : std::move(name); };
  SbfFields f(payload, kSbfBody + 2);
  recording_.marker = named(f.text(60));
  f.skip(20 + 20 + 40 + 20);  // marker number, observer, agency, serial number
  recording_.receiver = named(f.text(20));
  f.skip(20 + 20);  // version, serial number of the antenna
  recording_.antenna = named(f.text(20));
  const double up = f.f4(), east = f.f4(), north = f.f4();
  const Eigen::Vector3d offset(east, north, up);
  constexpr double kHighestMast = 1000.0;  // m
  if (offset.norm() < kHighestMast) recording_.antenna_offset_enu = offset;
  if (payload.size() < kProduct) return;
  f.skip(20 + 40);  // type of the marker, version
  if (const std::string product = named(f.text(40)); !product.empty()) recording_.receiver = "Septentrio " + product;
}

void SbfObservationReader::take_position(const MessageFrame& frame) {
  const auto solution = sbf_solution(frame);
  if (solution && solution->three_dimensional()) recording_.approximate_r_e = solution->r_ea_e;
}

void SbfObservationReader::take_epoch(std::string_view payload) {
  auto epoch = sbf_meas_epoch(payload);
  if (!epoch) return spoiled_.add(sbf_time(payload));
  const auto t = sbf_time(payload);
  if (!t) return no_time_.add();
  if (epoch->scrambled) return scrambled_.add(*t);
  if (clock_jumps_ms_ && *clock_jumps_ms_ != epoch->clock_jumps_ms) clock_resets_.add(*t);
  clock_jumps_ms_ = epoch->clock_jumps_ms;
  if (!rows_.begin(*t)) return;
  for (long i = 0; i < epoch->unknown; ++i) unknown_.add(*t);
  for (SbfMeasurement& measurement : epoch->measurements) take_measurement(measurement, *t);
  rows_.end();
}

void SbfObservationReader::take_measurement(SbfMeasurement& m, geo::GpsTime t) {
  record::Observation& o = m.observation;
  if (m.antenna != 0) return other_antenna_.add(t);
  if (!rows_.is_new(o.satellite, o.signal)) return;
  if (m.channel) recording_.glonass_channels[o.satellite.number] = *m.channel;
  if (o.phase_cycles) {
    SbfLock& lock = locks_[{o.satellite, o.signal}];
    o.lost_lock = lock.interrupted(m, t);
    lock = {t, *m.lock_s, o.half_cycle, true};
  }
  rows_.add(o);
}

void SbfObservationReader::refuse() const {
  const auto number = [&](std::uint32_t id) { return stream_.census().number(Protocol::kSbf, id); };
  if (scrambled_.number > 0)
    throw InputError({stream_.name(), 0, fmt::format("{} MeasEpoch blocks with scrambled measurements", scrambled_.number),
                      "measurements", "The receiver needs the permission \"Measurement Availability\" to output them."});
  if (number(sbf::kMeasEpoch) > 0)
    throw InputError({stream_.name(), 0,
                      fmt::format("{} MeasEpoch blocks, none with a time and a signal", number(sbf::kMeasEpoch)),
                      "observations", "Was the antenna connected?"});
  throw InputError({stream_.name(), 0, "an SBF file without MeasEpoch", "observations",
                    number(sbf::kMeas3Ranges) > 0
                        ? "Meas3Ranges is not read. Convert the file with Septentrio's sbf2rin, or log MeasEpoch."
                        : "Let the receiver log MeasEpoch; positions and navigation messages are read without."});
}

void SbfObservationReader::report() {
  using Grade = record::Event::Severity;
  recording_.events = sbf_file_events(stream_.census(), recording_.source);
  const CountedEvents add(recording_.events, recording_.source);
  add(spoiled_, "sbf_spoiled", "epoch", "epochs", "whose length contradicts the number of signals left out", Grade::kWarning);
  add(no_time_, "sbf_no_time", "epoch", "epochs", "before the receiver knew the time left out", Grade::kInfo);
  add(scrambled_, "sbf_scrambled", "epoch", "epochs", "with scrambled measurements left out", Grade::kWarning);
  add(unknown_, "sbf_unknown_signal", "measurement", "measurements", "of an unknown satellite or signal left out",
      Grade::kInfo);
  add(other_antenna_, "sbf_other_antenna", "measurement", "measurements", "of an auxiliary antenna left out", Grade::kInfo);
  add(clock_resets_, "sbf_clock_reset", "reset", "resets", "of the receiver's clock", Grade::kInfo);
  rows_.report("sbf");
}

}  // namespace

record::ObservationRecording read_sbf_observations(const std::filesystem::path& file) {
  return SbfObservationReader(file).read();
}

}  // namespace coast::io
