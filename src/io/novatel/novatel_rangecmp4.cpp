// RANGECMP4 and RANGECMP5 (OEM7 Commands and Logs Reference Manual).

#include <array>
#include <cmath>

#include "novatel_ranges.hpp"

namespace coast::io {

namespace {

using record::SatelliteSystem;

/// Bits from the lowest of each byte on.
class LowBits {
 public:
  explicit LowBits(std::string_view bytes) : bytes_(bytes) {}
  /// Up to 64 bits; zero beyond the end.
  std::uint64_t take(unsigned count) {
    std::uint64_t value = 0;
    for (unsigned i = 0; i < count; ++i, ++at_)
      if (at_ / 8 < bytes_.size())
        value |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes_[at_ / 8]) >> (at_ % 8) & 1U) << i;
    return value;
  }
  std::int64_t take_signed(unsigned count) {
    const std::uint64_t sign = std::uint64_t{1} << (count - 1);
    return static_cast<std::int64_t>((take(count) ^ sign) - sign);
  }
  [[nodiscard]] bool beyond() const { return at_ > 8 * bytes_.size(); }
  /// Less than a byte is left.
  [[nodiscard]] bool at_end() const { return at_ + 8 > 8 * bytes_.size(); }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

/// RANGECMP4 and RANGECMP5: masks of systems, satellites and signals; then for each satellite its signals, the first absolute,
/// the others as differences from it; or (RANGECMP4) all as differences from what the same signals had at the last whole
/// second, moved on with their rates.
class RangeCmp4Message {
 public:
  RangeCmp4Message(std::string_view bytes, bool five, double since_s, RangeReferences& references)
      : bits_(bytes), five_(five), since_s_(since_s), references_(references) {}

  NovAtelRanges decode() {
    constexpr unsigned kSystems = 16;
    std::uint64_t systems = bits_.take(kSystems);
    for (unsigned number = 0; number < kSystems && !bits_.beyond(); ++number)
      if ((systems >> number & 1U) != 0) decode_system(number);
    all_.whole = !bits_.beyond();
    return std::move(all_);
  }

 private:
  struct Measured {
    RangeReference values;
    bool code = false, phase = false, rate = false;
    bool half_cycle_known = false, half_cycle_added = false;
    double cn0 = 0.0;
    unsigned lock = 0;
  };

  void decode_system(unsigned number);
  void decode_satellite(std::optional<SatelliteSystem> system, unsigned index, const std::vector<unsigned>& signals);
  Measured head();
  Measured absolute(const Measured* first);
  std::optional<Measured> difference(bool first, const RangeReference* from);
  void add(const record::Satellite& satellite, const record::Signal& signal, const Measured& m);

  static constexpr double kCodeUnit = 5e-4, kPhaseUnit = 1e-4, kRateUnit = 1e-4;  // m, m/s
  LowBits bits_;
  bool five_;
  double since_s_;
  RangeReferences& references_;
  NovAtelRanges all_;
};

void RangeCmp4Message::decode_system(unsigned number) {
  constexpr unsigned kSatellites = 64, kSignals = 16;
  const std::uint64_t satellites = bits_.take(kSatellites), signals = bits_.take(kSignals);
  std::vector<unsigned> numbers;
  for (unsigned i = 0; i < kSignals; ++i)
    if ((signals >> i & 1U) != 0) numbers.push_back(i);
  std::vector<std::pair<unsigned, std::vector<unsigned>>> included;
  for (unsigned i = 0; i < kSatellites; ++i) {
    if ((satellites >> i & 1U) == 0) continue;
    const std::uint64_t mask = bits_.take(static_cast<unsigned>(numbers.size()));
    auto& of = included.emplace_back(i, std::vector<unsigned>()).second;
    for (std::size_t k = 0; k < numbers.size(); ++k)
      if ((mask >> k & 1U) != 0) of.push_back(numbers[k]);
  }
  const auto system = compressed_system(number);
  for (const auto& [index, of] : included) {
    if (bits_.beyond()) return;
    decode_satellite(system, index, of);
  }
}

/// PRN of a bit of the mask of satellites (RANGECMP4, "measurement block").
std::uint32_t prn_of_bit(SatelliteSystem system, std::uint32_t index) {
  constexpr std::uint32_t kGlonass = 38, kSbas = 120, kSbasTo = 39, kSbasFrom = 53, kSbasFurther = 130, kQzss = 193,
                          kSlots = 42;
  switch (system) {
    case SatelliteSystem::kGlonass:
      return index < kSlots ? index + kGlonass : 0;  // the others are of satellites whose slot is not known
    case SatelliteSystem::kSbas:
      return index < kSbasTo ? index + kSbas : index >= kSbasFrom ? index + kSbasFurther : 0;
    case SatelliteSystem::kQzss:
      return index + kQzss;
    default:
      return index + 1;
  }
}

void RangeCmp4Message::decode_satellite(std::optional<SatelliteSystem> system, unsigned index,
                                        const std::vector<unsigned>& signals) {
  constexpr unsigned kIdBits = 3, kChannelBits = 5;
  const bool differences = bits_.take(1) != 0 && !five_;
  const auto id = static_cast<unsigned>(bits_.take(kIdBits));
  int channel = 0;
  if (system == SatelliteSystem::kGlonass && !differences)
    channel = static_cast<int>(bits_.take(kChannelBits)) - kNovAtelChannelOffset;
  const auto satellite = system ? novatel_satellite(*system, prn_of_bit(*system, index)) : std::nullopt;
  std::optional<Measured> first;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    const auto signal = system ? rangecmp4_signal(*system, signals[i]) : std::nullopt;
    std::optional<Measured> measured;
    if (differences) {
      const auto found = satellite && signal ? references_.find({*satellite, *signal}) : references_.end();
      const bool known = found != references_.end() && found->second.id == id;
      measured = difference(i == 0, known ? &found->second : nullptr);
    } else {
      measured = absolute(first ? &*first : nullptr);
      measured->values.id = id;
      measured->values.glonass_channel = channel;
      if (!first) first = measured;
      if (satellite && signal && !five_) references_[{*satellite, *signal}] = measured->values;
    }
    if (!satellite || !signal)
      ++all_.unknown;
    else if (!measured)
      ++all_.reference;
    else
      add(*satellite, *signal, *measured);
  }
}

RangeCmp4Message::Measured RangeCmp4Message::head() {
  constexpr double kCn0Unit = 0.05;
  constexpr unsigned kCn0 = 11, kLock = 4;
  Measured m;
  m.half_cycle_known = bits_.take(1) != 0;
  m.half_cycle_added = bits_.take(1) != 0;
  m.cn0 = kCn0Unit * static_cast<double>(bits_.take(kCn0));
  m.lock = static_cast<unsigned>(bits_.take(kLock));
  static_cast<void>(bits_.take(five_ ? 10 : 8));  // standard deviations
  return m;
}

RangeCmp4Message::Measured RangeCmp4Message::absolute(const Measured* first) {
  constexpr std::int64_t kNoFirstCode = 137438953471, kNoCode = -524288, kNoPhase = -4194304;
  constexpr unsigned kFirstCode = 37, kCode = 20, kPhase = 23;
  Measured m = head();
  const std::int64_t code = first == nullptr ? static_cast<std::int64_t>(bits_.take(kFirstCode)) : bits_.take_signed(kCode);
  const std::int64_t phase = bits_.take_signed(kPhase);
  const unsigned rate_bits = first == nullptr ? (five_ ? 28 : 26) : (five_ ? 16 : 14);
  const std::int64_t rate = bits_.take_signed(rate_bits);
  m.code = code != (first == nullptr ? kNoFirstCode : kNoCode);
  m.phase = m.code && phase != kNoPhase;
  m.rate = rate != -(std::int64_t{1} << (rate_bits - 1));
  m.values.code_m = kCodeUnit * static_cast<double>(code) + (first != nullptr ? first->values.code_m : 0.0);
  m.values.phase_m = kPhaseUnit * static_cast<double>(phase) + m.values.code_m;
  m.values.rate_mps = kRateUnit * static_cast<double>(rate) + (first != nullptr ? first->values.rate_mps : 0.0);
  return m;
}

std::optional<RangeCmp4Message::Measured> RangeCmp4Message::difference(bool first, const RangeReference* from) {
  constexpr unsigned kCode = 19, kPhase = 16;
  constexpr std::int64_t kNoCode = -262144, kNoPhase = -32768;
  Measured m = head();
  const std::int64_t code = bits_.take_signed(kCode), phase = bits_.take_signed(kPhase);
  const unsigned rate_bits = first ? 18 : 14;
  const std::int64_t rate = bits_.take_signed(rate_bits);
  if (from == nullptr) return std::nullopt;
  const double moved = from->rate_mps * since_s_;
  m.code = code != kNoCode;
  m.phase = phase != kNoPhase;
  m.rate = rate != -(std::int64_t{1} << (rate_bits - 1));
  m.values = *from;
  m.values.code_m += kCodeUnit * static_cast<double>(code) + moved;
  m.values.phase_m += kPhaseUnit * static_cast<double>(phase) + moved;
  m.values.rate_mps += kRateUnit * static_cast<double>(rate);
  return m;
}

void RangeCmp4Message::add(const record::Satellite& satellite, const record::Signal& signal, const Measured& m) {
  constexpr unsigned kLongestLock = 15;
  constexpr double kShortestLock = 0.016;  // s, of class 1; each further class has twice as much
  const int channel = m.values.glonass_channel;
  const auto frequency = novatel_frequency(satellite.system, signal.band, channel);
  if (!frequency) return;
  const double per_metre = *frequency / kNovAtelLightSpeed;
  NovAtelRange range;
  range.satellite = satellite;
  range.signal = signal;
  if (m.code) range.code_m = m.values.code_m;
  if (m.phase) range.phase_cycles = per_metre * m.values.phase_m;
  if (m.rate) range.doppler_hz = -per_metre * m.values.rate_mps;
  range.cn0_dbhz = m.cn0;
  range.lock_s = m.lock == 0 ? 0.0 : std::ldexp(kShortestLock, static_cast<int>(m.lock) - 1);
  range.lock_up_to_s = m.lock == kLongestLock ? kEndlessLock : std::ldexp(kShortestLock, static_cast<int>(m.lock));
  range.half_cycle_known = m.half_cycle_known;
  range.half_cycle_added = m.half_cycle_added;
  if (satellite.system == SatelliteSystem::kGlonass) range.glonass_channel = channel;
  all_.ranges.push_back(range);
}

}  // namespace

NovAtelRanges decode_rangecmp4(std::string_view bytes, bool five, double since_s, RangeReferences& references) {
  return RangeCmp4Message(bytes, five, since_s, references).decode();
}

}  // namespace coast::io
