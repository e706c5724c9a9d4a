#include "sbf_meas_epoch.hpp"

#include "sbf_blocks.hpp"
#include "sbf_signals.hpp"

namespace coast::io {

namespace {

constexpr double kSpeedOfLight = 299'792'458.0;  // m/s
constexpr std::size_t kSbfMaster = 20, kSbfSlave = 12;

/// What lies at other places in the two kinds of sub-block.
struct SbfTracking {
  std::uint8_t type, cn0, info;
  int lock, no_lock;

  [[nodiscard]] unsigned signal() const {
    constexpr unsigned kElsewhere = 31, kOffset = 32;
    const unsigned low = type & 0x1fU;
    return low == kElsewhere ? (info >> 3U) + kOffset : low;
  }
  [[nodiscard]] int antenna() const { return type >> 5; }
};

/// Measurements that a satellite's others are relative to.
struct SbfReference {
  std::optional<record::Satellite> satellite;
  const SbfSignal* signal = nullptr;
  std::optional<int> channel;
  std::optional<double> frequency, code, doppler;
};

const SbfSignal* signal_of(const SbfTracking& tracking, std::optional<record::Satellite> satellite) {
  const SbfSignal* signal = satellite ? sbf_signal(tracking.signal()) : nullptr;
  return signal != nullptr && signal->system == satellite->system ? signal : nullptr;
}

/// Code in metres, phase minus code in thousandths of a cycle.
void add_phase(SbfMeasurement& m, std::optional<double> frequency, int high, int low) {
  constexpr int kNoPhase = -128;
  if (!m.lock_s || !m.observation.code_m || !frequency || (high == kNoPhase && low == 0)) return;
  m.observation.phase_cycles = *m.observation.code_m * *frequency / kSpeedOfLight + 1e-3 * (high * 65536.0 + low);
}

SbfMeasurement begun(const SbfTracking& t, record::Satellite satellite, const SbfSignal& signal, bool e6_data) {
  constexpr unsigned kHalfCycle = 4;
  constexpr std::uint8_t kNoCn0 = 255;
  constexpr unsigned kP1 = 1, kP2 = 2, kE6 = 19;
  SbfMeasurement m;
  m.observation.satellite = satellite;
  m.observation.signal = signal.signal;
  if (signal.number == kE6 && e6_data) m.observation.signal.tracking = 'B';
  m.antenna = t.antenna();
  if (t.cn0 != kNoCn0) m.observation.cn0_dbhz = 0.25 * t.cn0 + (signal.number == kP1 || signal.number == kP2 ? 0.0 : 10.0);
  if (t.lock != t.no_lock) m.lock_s = t.lock;
  m.longest_lock_s = t.no_lock - 1;
  m.observation.half_cycle = (t.info & kHalfCycle) != 0;
  return m;
}

/// Reads the sub-blocks of one MeasEpoch.
class SbfMeasReader {
 public:
  SbfMeasReader(SbfMeasEpoch& epoch, bool e6_data) : epoch_(epoch), e6_data_(e6_data) {}

  /// MeasEpochChannelType1.
  [[nodiscard]] SbfReference take_master(std::string_view b);
  /// MeasEpochChannelType2.
  void take_slave(std::string_view b, const SbfReference& master);

 private:
  void keep(SbfMeasurement& m);

  SbfMeasEpoch& epoch_;
  bool e6_data_;
};

SbfReference SbfMeasReader::take_master(std::string_view b) {
  constexpr double kHigh = 4'294'967'296.0;
  constexpr unsigned kFirstFdma = 8, kLastFdma = 11;
  constexpr std::int32_t kNoDoppler = INT32_MIN;
  const auto byte = [&](std::size_t at) { return number_at<std::uint8_t>(b, at); };
  const SbfTracking t{byte(1), byte(15), byte(18), number_at<std::uint16_t>(b, 16), 65535};
  SbfReference r;
  r.satellite = sbf_satellite(byte(2));
  r.signal = signal_of(t, r.satellite);
  if (r.signal == nullptr) {
    ++epoch_.unknown;
    return r;
  }
  if (t.signal() >= kFirstFdma && t.signal() <= kLastFdma) r.channel = sbf_channel(t.info >> 3U);
  r.frequency = r.signal->frequency(r.channel);
  const double code = 1e-3 * ((byte(3) & 15U) * kHigh + number_at<std::uint32_t>(b, 4));
  if (code > 0.0) r.code = code;
  if (const auto doppler = number_at<std::int32_t>(b, 8); doppler != kNoDoppler) r.doppler = 1e-4 * doppler;
  SbfMeasurement m = begun(t, *r.satellite, *r.signal, e6_data_);
  m.channel = r.channel;
  m.observation.code_m = r.code;
  m.observation.doppler_hz = r.doppler;
  add_phase(m, r.frequency, number_at<std::int8_t>(b, 14), number_at<std::uint16_t>(b, 12));
  keep(m);
  return r;
}

void SbfMeasReader::take_slave(std::string_view b, const SbfReference& master) {
  constexpr int kNoCode = -4, kNoDoppler = -16;
  const auto byte = [&](std::size_t at) { return number_at<std::uint8_t>(b, at); };
  const SbfTracking t{byte(0), byte(2), byte(5), byte(1), 255};
  const SbfSignal* signal = signal_of(t, master.satellite);
  if (signal == nullptr || master.signal == nullptr) {
    ++epoch_.unknown;
    return;
  }
  SbfMeasurement m = begun(t, *master.satellite, *signal, e6_data_);
  m.channel = master.channel;
  const std::optional<double> frequency = signal->frequency(master.channel);
  // Three and five bits in two's complement.
  const int code_high = static_cast<int>(byte(3) & 7U) - ((byte(3) & 4U) != 0 ? 8 : 0);
  const int doppler_high = static_cast<int>(byte(3) >> 3U) - ((byte(3) & 0x80U) != 0 ? 32 : 0);
  const int code_low = number_at<std::uint16_t>(b, 6), doppler_low = number_at<std::uint16_t>(b, 10);
  if (master.code && (code_high != kNoCode || code_low != 0))
    m.observation.code_m = *master.code + 1e-3 * (code_high * 65536.0 + code_low);
  if (master.doppler && master.frequency && frequency && (doppler_high != kNoDoppler || doppler_low != 0))
    m.observation.doppler_hz = *master.doppler * *frequency / *master.frequency + 1e-4 * (doppler_high * 65536.0 + doppler_low);
  add_phase(m, frequency, number_at<std::int8_t>(b, 4), number_at<std::uint16_t>(b, 8));
  keep(m);
}

void SbfMeasReader::keep(SbfMeasurement& m) {
  m.observation.half_cycle = m.observation.half_cycle && m.observation.phase_cycles;
  epoch_.measurements.push_back(m);
}

}  // namespace

std::optional<SbfMeasEpoch> sbf_meas_epoch(std::string_view payload) {
  constexpr std::size_t kFirst = 12, kNumberOfSlaves = 19;
  constexpr unsigned kE6Data = 0x40, kScrambled = 0x80;
  if (payload.size() < kFirst) return std::nullopt;
  const auto byte = [&](std::size_t at) { return number_at<std::uint8_t>(payload, at); };
  const std::size_t masters = byte(6), master_size = byte(7), slave_size = byte(8);
  const unsigned flags = byte(9);
  SbfMeasEpoch epoch;
  epoch.clock_jumps_ms = byte(10);
  epoch.scrambled = (flags & kScrambled) != 0;
  SbfMeasReader reader(epoch, (flags & kE6Data) != 0);
  std::size_t at = kFirst;
  for (std::size_t i = 0; i < masters; ++i) {
    if (master_size < kSbfMaster || at + master_size > payload.size()) return std::nullopt;
    const std::string_view master = payload.substr(at, master_size);
    const std::size_t slaves = number_at<std::uint8_t>(master, kNumberOfSlaves);
    at += master_size;
    if (slaves > 0 && (slave_size < kSbfSlave || at + slaves * slave_size > payload.size())) return std::nullopt;
    const SbfReference reference = reader.take_master(master);
    for (std::size_t k = 0; k < slaves; ++k, at += slave_size) reader.take_slave(payload.substr(at, slave_size), reference);
  }
  return epoch;
}

}  // namespace coast::io
