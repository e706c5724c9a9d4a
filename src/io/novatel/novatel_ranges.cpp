// RANGE, RANGECMP and RANGECMP2 (OEM7 Commands and Logs Reference Manual). NovAtel's accumulated Doppler range falls when the
// range grows: RINEX has the other sign.

#include "novatel_ranges.hpp"

#include <cmath>

namespace coast::io {

namespace {

using System = record::SatelliteSystem;

std::uint64_t bits_of(std::uint64_t word, unsigned at, unsigned count) {
  return word >> at & ((std::uint64_t{1} << count) - 1);
}

double signed_bits_of(std::uint64_t word, unsigned at, unsigned count) {
  const std::uint64_t sign = std::uint64_t{1} << (count - 1);
  return static_cast<double>(static_cast<std::int64_t>((bits_of(word, at, count) ^ sign) - sign));
}

/// Satellite and signal of a tracking status.
std::optional<NovAtelRange> range_of(const NovAtelTracking& tracking, std::uint32_t prn) {
  const auto system = tracking.system();
  const auto signal = tracking.signal();
  const auto satellite = system ? novatel_satellite(*system, prn) : std::nullopt;
  if (!satellite || !signal) return std::nullopt;
  NovAtelRange range;
  range.satellite = *satellite;
  range.signal = *signal;
  range.half_cycle_known = tracking.half_cycle_known();
  range.half_cycle_added = tracking.half_cycle_added();
  return range;
}

NovAtelRanges decode_range(NovAtelFields fields) {
  NovAtelRanges all;
  const std::uint32_t number = fields.u32();
  for (std::uint32_t i = 0; i < number && fields.good(); ++i) {
    const std::uint32_t prn = fields.u16();
    const int frequency = fields.i16();
    const double code = fields.f64();
    static_cast<void>(fields.f32());
    const double phase = -fields.f64();
    static_cast<void>(fields.f32());
    const double doppler = fields.f32(), cn0 = fields.f32(), lock = fields.f32();
    const NovAtelTracking tracking{fields.hex32()};
    if (!fields.good()) break;
    auto range = range_of(tracking, prn);
    if (!range) {
      ++all.unknown;
      continue;
    }
    if (tracking.code_locked()) range->code_m = code;
    if (tracking.phase_locked()) {
      range->phase_cycles = phase;
      range->doppler_hz = doppler;
    }
    range->cn0_dbhz = cn0;
    range->lock_s = range->lock_up_to_s = lock;
    if (range->satellite.system == System::kGlonass) range->glonass_channel = frequency - kNovAtelChannelOffset;
    all.ranges.push_back(*range);
  }
  all.whole = fields.good();
  return all;
}

/// The phase of RANGECMP is modulo 2^23 cycles: the nearest to the code.
double unrolled(double phase, double code_cycles) {
  constexpr double kRoll = 8388608.0;
  return phase + kRoll * std::round((code_cycles - phase) / kRoll);
}

/// One record of RANGECMP, 24 bytes.
std::optional<NovAtelRange> rangecmp_record(std::string_view b, const std::map<int, int>& channels) {
  constexpr double kSaturatedLock = 65535.0;  // s
  const NovAtelTracking tracking{number_at<std::uint32_t>(b, 0)};
  auto range = range_of(tracking, number_at<std::uint8_t>(b, 17));
  if (!range) return std::nullopt;
  const auto doppler_code = number_at<std::uint64_t>(b, 4);
  const double code = static_cast<double>(bits_of(doppler_code, 28, 36)) / 128.0;
  const std::uint64_t lock_cn0 = number_at<std::uint32_t>(b, 18);
  int channel = 0;
  if (range->satellite.system == System::kGlonass) {
    // Older firmware leaves the field of the frequency empty.
    const int field = static_cast<int>(bits_of(lock_cn0, 26, 6));
    const auto known = channels.find(range->satellite.number);
    channel = field != 0 ? field - kNovAtelChannelOffset : known != channels.end() ? known->second : 0;
    if (field != 0) range->glonass_channel = channel;
  }
  if (tracking.code_locked()) range->code_m = code;
  const auto frequency = novatel_frequency(range->satellite.system, range->signal.band, channel);
  if (tracking.phase_locked() && tracking.code_locked() && frequency) {
    range->phase_cycles = unrolled(-number_at<std::int32_t>(b, 12) / 256.0, code * *frequency / kNovAtelLightSpeed);
    range->doppler_hz = signed_bits_of(doppler_code, 0, 28) / 256.0;
  }
  range->lock_s = static_cast<double>(bits_of(lock_cn0, 0, 21)) / 32.0;
  range->lock_up_to_s = range->lock_s >= kSaturatedLock ? kEndlessLock : range->lock_s + 1.0 / 32.0;
  range->cn0_dbhz = 20.0 + static_cast<double>(bits_of(lock_cn0, 21, 5));
  return range;
}

NovAtelRanges decode_rangecmp(NovAtelFields fields, const std::map<int, int>& channels) {
  constexpr std::size_t kRecord = 24;
  NovAtelRanges all;
  const std::uint32_t number = fields.u32();
  for (std::uint32_t i = 0; i < number && fields.good(); ++i) {
    const std::string_view record = fields.bytes(kRecord);
    if (!fields.good()) break;
    if (const auto range = rangecmp_record(record, channels))
      all.ranges.push_back(*range);
    else
      ++all.unknown;
  }
  all.whole = fields.good();
  return all;
}

/// What the signals of one satellite of RANGECMP2 are differences from.
struct Satellite2 {
  std::optional<record::Satellite> satellite;
  int glonass_channel = 0;
  double code_m = 0.0, doppler_hz = 0.0;
  std::size_t signals = 0;
};

Satellite2 satellite_of(std::string_view b) {
  constexpr std::uint32_t kSlotOffset = 37;
  const std::uint32_t number = number_at<std::uint8_t>(b, 1);
  const auto word = number_at<std::uint64_t>(b, 2);
  const auto system = compressed_system(static_cast<std::uint32_t>(bits_of(word, 4, 5)));
  Satellite2 s;
  if (system) s.satellite = novatel_satellite(*system, number + (*system == System::kGlonass ? kSlotOffset : 0));
  s.glonass_channel = static_cast<int>(bits_of(word, 0, 4)) - kNovAtelChannelOffset;
  s.code_m = signed_bits_of(word, 10, 29);
  s.doppler_hz = signed_bits_of(word, 39, 21);
  s.signals = bits_of(word, 60, 4);
  return s;
}

/// Doppler frequencies are differences on the first frequency of the system.
double to_first_frequency(System system, double frequency, int glonass_channel) {
  const auto first = novatel_frequency(system,
                                       system == System::kBeidou  ? '2'
                                       : system == System::kNavic ? '5'
                                                                  : '1',
                                       glonass_channel);
  return *first / frequency;
}

std::optional<NovAtelRange> rangecmp2_signal_of(const Satellite2& of, std::string_view b) {
  constexpr double kMillisecond = 1e-3;
  constexpr std::uint64_t kSaturated = 131071;
  const std::uint64_t one = number_at<std::uint32_t>(b, 0), two = number_at<std::uint64_t>(b, 4);
  if (!of.satellite) return std::nullopt;
  const auto signal = rangecmp2_signal(of.satellite->system, static_cast<std::uint32_t>(bits_of(one, 0, 5)));
  const auto frequency = signal ? novatel_frequency(of.satellite->system, signal->band, of.glonass_channel) : std::nullopt;
  if (!frequency) return std::nullopt;
  NovAtelRange range;
  range.satellite = *of.satellite;
  range.signal = *signal;
  if (bits_of(one, 7, 1) != 0) range.code_m = of.code_m + static_cast<double>(bits_of(two, 13, 14)) / 128.0;
  if (bits_of(one, 5, 1) != 0) {
    range.phase_cycles = (of.code_m + static_cast<double>(bits_of(two, 27, 20)) / 2048.0) * *frequency / kNovAtelLightSpeed;
    range.doppler_hz = (of.doppler_hz + signed_bits_of(two, 47, 17) / 256.0) /
                       to_first_frequency(range.satellite.system, *frequency, of.glonass_channel);
  }
  range.half_cycle_known = bits_of(one, 6, 1) != 0;
  range.half_cycle_added = bits_of(one, 30, 1) != 0;
  const std::uint64_t lock = bits_of(one, 8, 17);
  range.lock_s = kMillisecond * static_cast<double>(lock);
  range.lock_up_to_s = lock == kSaturated ? kEndlessLock : range.lock_s + kMillisecond;
  range.cn0_dbhz = 20.0 + static_cast<double>(bits_of(two, 0, 5));
  if (range.satellite.system == System::kGlonass) range.glonass_channel = of.glonass_channel;
  return range;
}

NovAtelRanges decode_rangecmp2(NovAtelFields fields) {
  constexpr std::size_t kSatelliteBlock = 10, kSignalBlock = 12;
  NovAtelRanges all;
  const std::uint32_t size = fields.u32();
  const std::string_view b = fields.good() ? fields.bytes(size) : std::string_view();
  std::size_t at = 0;
  while (at + kSatelliteBlock <= b.size()) {
    const Satellite2 satellite = satellite_of(b.substr(at, kSatelliteBlock));
    at += kSatelliteBlock;
    for (std::size_t i = 0; i < satellite.signals && at + kSignalBlock <= b.size(); ++i, at += kSignalBlock) {
      if (const auto range = rangecmp2_signal_of(satellite, b.substr(at, kSignalBlock)))
        all.ranges.push_back(*range);
      else
        ++all.unknown;
    }
  }
  all.whole = fields.good() && at == b.size();
  return all;
}

}  // namespace

bool is_range_log(std::uint32_t id) {
  return id == novatel::kRange || id == novatel::kRangeCmp || id == novatel::kRangeCmp2 || id == novatel::kRangeCmp4 ||
         id == novatel::kRangeCmp5;
}

NovAtelRanges NovAtelRangeDecoder::decode(const NovAtelLog& log) {
  NovAtelRanges all;
  NovAtelFields fields = log.fields();
  switch (log.id) {
    case novatel::kRange:
      all = decode_range(fields);
      break;
    case novatel::kRangeCmp:
      all = decode_rangecmp(fields, channels_);
      break;
    case novatel::kRangeCmp2:
      all = decode_rangecmp2(fields);
      break;
    default: {
      const std::uint32_t size = fields.u32();
      const std::string_view bytes = fields.good() ? fields.bytes(size) : std::string_view();
      if (fields.good())
        all = decode_rangecmp4(bytes, log.id == novatel::kRangeCmp5, log.seconds - std::floor(log.seconds), references_);
      else
        all.whole = false;
    }
  }
  for (const NovAtelRange& range : all.ranges)
    if (range.glonass_channel) channels_[range.satellite.number] = *range.glonass_channel;
  return all;
}

}  // namespace coast::io
