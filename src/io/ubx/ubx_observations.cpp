// Observations of UBX-RXM-RAWX (u-blox F9 HPG interface description; the layout is that of protocol 18 on).

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "../binary.hpp"
#include "../counted.hpp"
#include "../observation_rows.hpp"
#include "ubx_messages.hpp"
#include "ubx_readers.hpp"
#include "ubx_signals.hpp"

namespace coast::io {

namespace {

using record::Observation;

constexpr std::size_t kRawxHead = 16, kRawxBlock = 32;

/// One block of RXM-RAWX: the measurements of one signal.
struct RawxBlock {
  explicit RawxBlock(std::string_view b)
      : code(number_at<double>(b, 0)),
        phase(number_at<double>(b, 8)),
        doppler(number_at<float>(b, 16)),
        gnss(number_at<std::uint8_t>(b, 20)),
        sv(number_at<std::uint8_t>(b, 21)),
        signal(number_at<std::uint8_t>(b, 22)),
        frequency(number_at<std::uint8_t>(b, 23)),
        lock_ms(number_at<std::uint16_t>(b, 24)),
        cn0(number_at<std::uint8_t>(b, 26)),
        phase_sd(number_at<std::uint8_t>(b, 28)),
        tracking(number_at<std::uint8_t>(b, 30)) {}

  // trkStat
  [[nodiscard]] bool code_valid() const { return (tracking & 1U) != 0; }
  [[nodiscard]] bool phase_valid() const { return (tracking & 2U) != 0 && (phase_sd & 15U) != 15; }  // 15: no phase
  [[nodiscard]] bool half_cycle_known() const { return (tracking & 4U) != 0; }
  [[nodiscard]] bool half_cycle_subtracted() const { return (tracking & 8U) != 0; }

  double code;     ///< m
  double phase;    ///< cycles, grows with range
  double doppler;  ///< Hz, positive when the satellite approaches
  std::uint8_t gnss, sv, signal;
  std::uint8_t frequency;  ///< GLONASS: channel + 7
  std::uint16_t lock_ms;   ///< phase locked without interruption for this long, at most 64.5 s
  std::uint8_t cn0;        ///< dBHz
  std::uint8_t phase_sd, tracking;
};

/// What the lock of a signal was when it was last seen.
struct SignalLock {
  geo::GpsTime t;
  std::uint16_t lock_ms = 0;
  bool half_cycle_subtracted = false;
  bool slip_waits = true;  ///< a loss of lock that no phase has carried yet; a signal begins with one
};

class RawxReader {
 public:
  explicit RawxReader(const std::filesystem::path& file) : stream_(file, kUbxLog) {}

  record::ObservationRecording read() {
    recording_.source = stream_.name();
    MessageFrame frame;
    while (stream_.next(frame)) {
      if (frame.protocol != Protocol::kUbx) continue;
      if (frame.id == ubx::kMonVer) take_version(frame.payload);
      if (frame.id == ubx::kRxmRawx) take_epoch(frame.payload);
    }
    if (recording_.epochs.empty()) refuse();
    report();
    return std::move(recording_);
  }

 private:
  void take_version(std::string_view payload);
  void take_epoch(std::string_view payload);
  void take_block(const RawxBlock& block, geo::GpsTime t);
  [[nodiscard]] bool lost_lock(const RawxBlock& block, const Observation& observation, geo::GpsTime t);
  [[noreturn]] void refuse() const;
  void report();

  FrameStream stream_;
  record::ObservationRecording recording_;
  ObservationRows rows_{recording_};
  std::map<std::pair<record::Satellite, record::Signal>, SignalLock> locks_;
  Counted spoiled_, no_time_, unknown_, impossible_, clock_resets_;
};

/// MON-VER: software and hardware version, then extensions of 30 bytes, of which one names the module.
void RawxReader::take_version(std::string_view payload) {
  constexpr std::size_t kFirst = 40, kExtension = 30;
  constexpr std::string_view kModule = "MOD=";
  for (std::size_t at = kFirst; at + kExtension <= payload.size(); at += kExtension) {
    const std::string_view extension = payload.substr(at, kExtension);
    if (!extension.starts_with(kModule)) continue;
    const std::string_view name = extension.substr(kModule.size());
    recording_.receiver = "u-blox " + std::string(name.substr(0, name.find('\0')));
  }
}

void RawxReader::take_epoch(std::string_view payload) {
  constexpr unsigned kClockReset = 2;
  if (payload.size() < kRawxHead) return spoiled_.add();
  const std::size_t blocks = number_at<std::uint8_t>(payload, 11);
  if (payload.size() != kRawxHead + blocks * kRawxBlock) return spoiled_.add();
  const auto t = rawx_time(payload);
  if (!t) return no_time_.add();
  if ((number_at<std::uint8_t>(payload, 12) & kClockReset) != 0) clock_resets_.add(*t);
  if (!rows_.begin(*t)) return;
  for (std::size_t i = 0; i < blocks; ++i) take_block(RawxBlock(payload.substr(kRawxHead + i * kRawxBlock, kRawxBlock)), *t);
  rows_.end();
}

void RawxReader::take_block(const RawxBlock& block, geo::GpsTime t) {
  constexpr int kChannelOffset = 7, kChannels = 14;
  constexpr double kFarthest = 1e9, kMostCycles = 1e11, kMostHertz = 1e6;
  const auto satellite = ubx_satellite(block.gnss, block.sv);
  const auto signal = satellite ? ubx_signal(satellite->system, block.signal) : std::nullopt;
  if (!signal) return unknown_.add(t);
  if (!rows_.is_new(*satellite, *signal)) return;
  Observation o;
  o.satellite = *satellite;
  o.signal = *signal;
  // Comparisons that NaN does not pass.
  const bool possible = (!block.code_valid() || (block.code > 0.0 && block.code < kFarthest)) &&
                        (!block.phase_valid() || std::abs(block.phase) < kMostCycles) && std::abs(block.doppler) < kMostHertz;
  if (!possible) return impossible_.add(t);
  if (block.code_valid()) o.code_m = block.code;
  if (block.phase_valid()) o.phase_cycles = block.phase;
  o.doppler_hz = block.doppler;
  if (block.cn0 > 0) o.cn0_dbhz = block.cn0;
  o.half_cycle = o.phase_cycles && !block.half_cycle_known();
  o.lost_lock = lost_lock(block, o, t);
  if (satellite->system == record::SatelliteSystem::kGlonass && block.frequency < kChannels)
    recording_.glonass_channels[satellite->number] = block.frequency - kChannelOffset;
  rows_.add(o);
}

/// The phase is continuous since the signal was last seen if it has been locked for at least as long. The time of lock is cut
/// to milliseconds; of a pause beyond its largest value nothing is known.
bool RawxReader::lost_lock(const RawxBlock& block, const Observation& o, geo::GpsTime t) {
  SignalLock& lock = locks_[{o.satellite, o.signal}];
  const double now = 1e-3 * block.lock_ms, since = t - lock.t;
  const bool interrupted = block.lock_ms < lock.lock_ms || now + 1e-3 < since;
  lock.slip_waits = lock.slip_waits || interrupted || block.half_cycle_subtracted() != lock.half_cycle_subtracted;
  lock.t = t;
  lock.lock_ms = block.lock_ms;
  lock.half_cycle_subtracted = block.half_cycle_subtracted();
  if (!o.phase_cycles) return false;
  return std::exchange(lock.slip_waits, false);
}

void RawxReader::refuse() const {
  const long epochs = stream_.census().number(Protocol::kUbx, ubx::kRxmRawx);
  throw InputError({stream_.name(), 0,
                    epochs == 0 ? std::string("a UBX file without UBX-RXM-RAWX")
                                : fmt::format("{} UBX-RXM-RAWX messages, none with a time and a signal", epochs),
                    "observations",
                    epochs == 0 ? "Switch this message on in the receiver; positions and navigation messages are read without."
                                : "Was the antenna connected?"});
}

void RawxReader::report() {
  using Grade = record::Event::Severity;
  recording_.events = ubx_file_events(stream_.census(), recording_.source);
  const CountedEvents add(recording_.events, recording_.source);
  add(spoiled_, "rawx_spoiled", "epoch", "epochs", "whose length contradicts the number of signals left out", Grade::kWarning);
  add(no_time_, "rawx_no_time", "epoch", "epochs", "before the receiver knew the week left out", Grade::kInfo);
  add(unknown_, "rawx_unknown_signal", "measurement", "measurements", "of an unknown satellite or signal left out",
      Grade::kInfo);
  add(impossible_, "rawx_impossible", "measurement", "measurements", "that no receiver measures left out", Grade::kWarning);
  add(clock_resets_, "rawx_clock_reset", "reset", "resets", "of the receiver's clock", Grade::kInfo);
  rows_.report("rawx");
}

}  // namespace

record::ObservationRecording read_ubx_observations(const std::filesystem::path& file) {
  return RawxReader(file).read();
}

}  // namespace coast::io
