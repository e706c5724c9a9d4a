#include <algorithm>
#include <cmath>

#include "../broadcast/bit_field.hpp"
#include "../carriers.hpp"
#include "rtcm_measurement.hpp"
#include "rtcm_messages.hpp"
#include "rtcm_signals.hpp"

namespace coast::io {

namespace {

using System = record::SatelliteSystem;

constexpr double kRangeMs = 1e-3 * kSpeedOfLight;  // m

/// A field of all satellites or of all cells: MSM has one field of all after the other.
struct MsmColumn {
  std::size_t at = 0, width = 0;

  [[nodiscard]] std::uint32_t value(const BitField& bits, std::size_t row) const { return bits.bits(at + width * row, width); }
  /// None for the most negative number, which stands for "not measured".
  [[nodiscard]] std::optional<double> number(const BitField& bits, std::size_t row, int exponent) const {
    const std::int32_t n = bits.signed_bits(at + width * row, width);
    if (n == -(std::int32_t{1} << (width - 1))) return std::nullopt;
    return std::ldexp(static_cast<double>(n), exponent);
  }
};

/// Places of the fields in one message (tables 3.5-78 to -88).
struct MsmLayout {
  MsmColumn whole_ms, extended, part_ms, rough_rate;
  MsmColumn code, phase, lock, half_cycle, cn0, fine_rate;
  std::size_t end = 0;  ///< bits of the message

  MsmColumn next(std::size_t width, std::size_t rows) {
    const MsmColumn column{end, width};
    end += width * rows;
    return column;
  }
};

MsmLayout msm_layout(MsmKind kind, std::size_t at, std::size_t satellites, std::size_t cells) {
  const bool rates = kind.has_rates(), fine = kind.is_fine();
  MsmLayout layout;
  layout.end = at;
  layout.whole_ms = layout.next(8, satellites);
  if (rates) layout.extended = layout.next(4, satellites);
  layout.part_ms = layout.next(10, satellites);
  if (rates) layout.rough_rate = layout.next(14, satellites);
  layout.code = layout.next(fine ? 20 : 15, cells);
  layout.phase = layout.next(fine ? 24 : 22, cells);
  layout.lock = layout.next(fine ? 10 : 4, cells);
  layout.half_cycle = layout.next(1, cells);
  layout.cn0 = layout.next(fine ? 10 : 6, cells);
  if (rates) layout.fine_rate = layout.next(15, cells);
  return layout;
}

/// DF402: the least time of lock is 0, 32, 64, .. 524288 ms.
double coarse_lock(std::uint32_t indicator) {
  return indicator == 0 ? 0.0 : 1e-3 * std::exp2(indicator + 4.0);
}

/// DF407: milliseconds to 63, then 32 steps each of 2, 4, .. ms.
double fine_lock(std::uint32_t indicator) {
  constexpr std::uint32_t kLast = 704, kSteps = 32;
  const std::uint32_t n = std::min(indicator, kLast);
  if (n < 2 * kSteps) return 1e-3 * n;
  const std::uint32_t doublings = n / kSteps - 1;
  return 1e-3 * std::exp2(doublings) * (n - kSteps * doublings);
}

/// Places of the mask that are set, from 1.
std::vector<std::size_t> set_places(const BitField& bits, std::size_t at, std::size_t count) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < count; ++i)
    if (bits.bits(at + i, 1) != 0) places.push_back(i + 1);
  return places;
}

/// What one message holds, field by field.
class MsmMessage {
 public:
  MsmMessage(MsmKind kind, std::string_view payload);
  /// The message is as long as its masks say.
  [[nodiscard]] bool is_whole() const { return is_whole_; }
  [[nodiscard]] RtcmMeasurements measurements() const;

 private:
  [[nodiscard]] std::optional<double> rough_ms(std::size_t row) const;
  [[nodiscard]] RtcmMeasurement measurement(std::size_t row, std::size_t cell) const;

  MsmKind kind_;
  BitField bits_;
  std::vector<std::size_t> satellites_, signals_;
  std::vector<bool> cells_;  ///< by satellite, then by signal
  MsmLayout layout_;
  bool is_whole_ = false;
};

MsmMessage::MsmMessage(MsmKind kind, std::string_view payload) : kind_(kind), bits_(bits_of(payload)) {
  constexpr std::size_t kSatellites = 73, kSignals = kSatellites + 64, kCells = kSignals + 32, kMostCells = 64;
  const std::size_t size = 8 * payload.size();
  if (size < kCells) return;
  satellites_ = set_places(bits_, kSatellites, 64);
  signals_ = set_places(bits_, kSignals, 32);
  const std::size_t cells = satellites_.size() * signals_.size();
  if (cells > kMostCells || size < kCells + cells) return;
  std::size_t set = 0;
  for (std::size_t i = 0; i < cells; ++i) {
    cells_.push_back(bits_.bits(kCells + i, 1) != 0);
    set += cells_.back() ? 1 : 0;
  }
  layout_ = msm_layout(kind, kCells + cells, satellites_.size(), set);
  is_whole_ = size >= layout_.end;
}

/// DF397 and DF398: whole milliseconds and 1024ths.
std::optional<double> MsmMessage::rough_ms(std::size_t row) const {
  constexpr std::uint32_t kUnknown = 255;
  const std::uint32_t whole = layout_.whole_ms.value(bits_, row);
  if (whole == kUnknown) return std::nullopt;
  return whole + std::ldexp(static_cast<double>(layout_.part_ms.value(bits_, row)), -10);
}

/// DF400, DF401, DF404 or DF405, DF406: what is missing from the rough range and rate of the satellite.
RtcmMeasurement MsmMessage::measurement(std::size_t row, std::size_t cell) const {
  constexpr double kRateUnit = 1e-4;  // m/s
  RtcmMeasurement m;
  const bool fine = kind_.is_fine();
  const auto rough = rough_ms(row);
  const auto code = layout_.code.number(bits_, cell, fine ? -29 : -24);
  const auto phase = layout_.phase.number(bits_, cell, fine ? -31 : -29);
  if (rough && code) m.code_m = kRangeMs * (*rough + *code);
  if (rough && phase) m.phase_m = kRangeMs * (*rough + *phase);
  if (kind_.has_rates()) {
    const auto rough_rate = layout_.rough_rate.number(bits_, row, 0);
    const auto rate = layout_.fine_rate.number(bits_, cell, 0);
    if (rough_rate && rate) m.rate_mps = *rough_rate + kRateUnit * *rate;
  }
  const std::uint32_t cn0 = layout_.cn0.value(bits_, cell), lock = layout_.lock.value(bits_, cell);
  if (cn0 > 0) m.cn0_dbhz = std::ldexp(static_cast<double>(cn0), fine ? -4 : 0);
  m.lock_s = fine ? fine_lock(lock) : coarse_lock(lock);
  m.half_cycle = layout_.half_cycle.value(bits_, cell) != 0;
  return m;
}

RtcmMeasurements MsmMessage::measurements() const {
  constexpr std::uint32_t kChannels = 14;
  constexpr int kChannelOffset = 7;
  RtcmMeasurements all;
  std::size_t cell = 0;
  for (std::size_t row = 0; row < satellites_.size(); ++row) {
    const auto satellite = msm_satellite(kind_.system, satellites_[row]);
    if (satellite && kind_.system == System::kGlonass && kind_.has_rates()) {
      const std::uint32_t channel = layout_.extended.value(bits_, row);
      if (channel < kChannels) all.glonass_channels.emplace_back(satellite->number, static_cast<int>(channel) - kChannelOffset);
    }
    for (std::size_t column = 0; column < signals_.size(); ++column) {
      if (!cells_[row * signals_.size() + column]) continue;
      const auto signal = msm_signal(kind_.system, signals_[column]);
      RtcmMeasurement m = measurement(row, cell++);
      if (!satellite || !signal) {
        ++all.unknown;
        continue;
      }
      m.satellite = *satellite;
      m.signal = *signal;
      all.signals.push_back(m);
    }
  }
  return all;
}

}  // namespace

std::optional<RtcmMeasurements> read_msm(const MessageFrame& frame) {
  const auto kind = msm_kind(frame.id);
  if (!kind || !kind->is_read()) return std::nullopt;
  const MsmMessage message(*kind, frame.payload);
  if (!message.is_whole()) return std::nullopt;
  return message.measurements();
}

}  // namespace coast::io
