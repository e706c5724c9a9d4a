#include "parity_outages.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "parity_blocks.hpp"

namespace coast::array {

namespace {

constexpr double kCoarse = 0.2;
constexpr std::size_t kLeastRun = 4;  // rounded values may have two equal pairs in a row; a run of four is tested
constexpr double kPiece = 10.0;       // s

struct ValueRun {
  std::size_t from, to;
};

class RepeatedValues {
 public:
  RepeatedValues(const Signals& signals, const std::vector<std::vector<std::uint8_t>>& present, std::size_t sensor, int channel)
      : signals_(signals), present_(present), sensor_(sensor), channel_(channel) {
    split();
    count();
  }
  [[nodiscard]] std::vector<Defect> beyond(double per_hour) const;

 private:
  [[nodiscard]] double value(std::size_t n) const {
    return signals_.sensors[sensor_].values(channel_, static_cast<Eigen::Index>(n));
  }
  [[nodiscard]] bool there(std::size_t n) const { return ((present_[sensor_][n] >> channel_) & 1) != 0; }
  void split();
  void count();
  [[nodiscard]] double chance_of_repeat(const ValueRun& run) const;
  [[nodiscard]] bool others_move(const ValueRun& run) const;

  const Signals& signals_;
  const std::vector<std::vector<std::uint8_t>>& present_;
  std::size_t sensor_;
  int channel_;
  std::vector<ValueRun> runs_;
  std::size_t piece_ = 1;
  std::vector<double> in_piece_;  ///< probability from the runs that start there
  double overall_ = 0.0;          ///< probability from all runs
  double share_ = 0.0;            ///< of samples that repeat, in the middle piece
  double step_ = 0.0;             ///< smallest change; infinite: there is none
};

void RepeatedValues::split() {
  const std::size_t samples = signals_.samples();
  step_ = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < samples;) {
    if (!there(n)) {
      ++n;
      continue;
    }
    std::size_t end = n + 1;
    // Interpolation onto the common grid leaves rounding errors in a constant.
    const double tolerance = 1e-12 * std::abs(value(n));
    while (end < samples && there(end) && std::abs(value(end) - value(n)) <= tolerance) ++end;
    runs_.push_back({n, end});
    if (end < samples && there(end)) step_ = std::min(step_, std::abs(value(end) - value(n)));
    n = end;
  }
}

/// By runs; a stuck value is one run of any length.
void RepeatedValues::count() {
  piece_ = static_cast<std::size_t>(std::max(1.0, std::round(kPiece / signals_.dt)));
  const std::size_t pieces = signals_.samples() / piece_ + 1;
  std::vector<double> started(pieces, 0.0), repeated(pieces, 0.0), share(pieces, 1.0);
  for (const ValueRun& run : runs_) {
    started[run.from / piece_] += 1.0;
    if (run.to - run.from > 1) repeated[run.from / piece_] += 1.0;
  }
  double all = 1.0, twice = 1.0;
  for (std::size_t i = 0; i < pieces; ++i) {
    all += started[i];
    twice += repeated[i];
    in_piece_.push_back(started[i] >= 20.0 ? repeated[i] / started[i] : 0.0);
    share[i] = std::max(0.0, 1.0 - started[i] / static_cast<double>(piece_));
  }
  share.pop_back();  // not a complete piece
  overall_ = twice / (all + 1.0);
  share_ = share.size() < 3 ? 0.0 : median_of(share);
}

double RepeatedValues::chance_of_repeat(const ValueRun& run) const {
  double chance = overall_;
  const std::size_t at = run.from / piece_;
  const std::size_t last = std::min((run.to - 1) / piece_ + 1, in_piece_.size() - 1);
  for (std::size_t i = at > 0 ? at - 1 : 0; i <= last; ++i) chance = std::max(chance, in_piece_[i]);
  return std::min(chance, 0.9999);
}

/// The mean of the others spreads by more than three steps, and not as white noise does. For a sensor that never changes it is
/// sufficient that they move.
bool RepeatedValues::others_move(const ValueRun& run) const {
  double sum = 0.0, squares = 0.0, changes = 0.0, before = 0.0;
  std::size_t count = 0;
  for (std::size_t n = run.from; n < run.to; ++n) {
    double mean = 0.0;
    int others = 0;
    for (std::size_t k = 0; k < signals_.sensors.size(); ++k) {
      if (k == sensor_ || ((present_[k][n] >> channel_) & 1) == 0) continue;
      mean += signals_.sensors[k].values(channel_, static_cast<Eigen::Index>(n));
      ++others;
    }
    if (others == 0) continue;
    mean /= others;
    if (count > 0) changes += (mean - before) * (mean - before);
    before = mean;
    sum += mean;
    squares += mean * mean;
    ++count;
  }
  if (count < 2) return false;
  if (!std::isfinite(step_)) return changes > 0.0;
  const auto samples = static_cast<double>(count);
  const double variance = std::max(0.0, squares / samples - sum * sum / (samples * samples));
  return variance > 9.0 * step_ * step_ && variance > 9.0 * changes / (2.0 * samples);
}

std::vector<Defect> RepeatedValues::beyond(double per_hour) const {
  std::vector<Defect> found;
  const double per_sample = std::min(0.5, per_hour * signals_.dt / 3600.0);
  for (const ValueRun& run : runs_) {
    if (run.to - run.from < kLeastRun) continue;
    const double chance = chance_of_repeat(run);
    // chance^(length - 1) <= per_sample
    const auto longest = 1 + static_cast<std::size_t>(std::ceil(std::log(per_sample) / std::log(chance)));
    const std::size_t limit = std::max(kLeastRun, longest);
    if (run.to - run.from < limit) continue;
    if (std::max(chance, share_) >= kCoarse && !others_move(run)) continue;
    Defect defect;
    defect.sensor = sensor_;
    defect.channels = static_cast<std::uint8_t>(1U << channel_);
    defect.kind = value(run.from) == 0.0 ? DefectKind::kDropout : DefectKind::kStuck;
    defect.from = defect.kind == DefectKind::kDropout ? run.from : run.from + 1;  // the first of equal values is measured
    defect.to = run.to;
    defect.found = run.from + limit - 1;
    defect.statistic = static_cast<double>(run.to - run.from);
    found.push_back(defect);
  }
  return found;
}

std::vector<Defect> missing_values(const std::vector<std::uint8_t>& present, std::size_t sensor, int channel) {
  std::vector<Defect> found;
  for (std::size_t n = 0; n < present.size();) {
    std::size_t end = n;
    while (end < present.size() && ((present[end] >> channel) & 1) == 0) ++end;
    if (end > n) {
      Defect defect;
      defect.sensor = sensor;
      defect.channels = static_cast<std::uint8_t>(1U << channel);
      defect.kind = DefectKind::kDropout;
      defect.from = defect.found = n;
      defect.to = end;
      defect.statistic = static_cast<double>(end - n);
      found.push_back(defect);
    }
    n = end + 1;
  }
  return found;
}

}  // namespace

Outages find_outages(const Signals& signals, double per_hour) {
  Outages outages;
  for (const SensorSignals& sensor : signals.sensors) {
    auto& present = outages.present.emplace_back(sensor.usable);
    for (std::size_t n = 0; n < sensor.limited.size(); ++n)
      present[n] |= sensor.limited[n];  // the end of a range is no dropout
    for (std::size_t n = 0; n < present.size(); ++n)
      for (int c = 0; c < kChannels; ++c)
        if (!std::isfinite(sensor.values(c, static_cast<Eigen::Index>(n))))
          present[n] = static_cast<std::uint8_t>(present[n] & ~(1U << c));
  }
  for (std::size_t k = 0; k < signals.sensors.size(); ++k) {
    for (int c = 0; c < kChannels; ++c) {
      const std::vector<Defect> missing = missing_values(outages.present[k], k, c);
      outages.defects.insert(outages.defects.end(), missing.begin(), missing.end());
      const std::vector<Defect> repeated = RepeatedValues(signals, outages.present, k, c).beyond(per_hour);
      outages.defects.insert(outages.defects.end(), repeated.begin(), repeated.end());
      for (const Defect& defect : repeated)
        for (std::size_t n = defect.from; n < defect.to; ++n)
          outages.present[k][n] = static_cast<std::uint8_t>(outages.present[k][n] & ~(1U << c));
    }
  }
  for (std::size_t k = 0; k < signals.sensors.size(); ++k) {
    const std::vector<std::uint8_t>& limited = signals.sensors[k].limited;
    for (std::size_t n = 0; n < limited.size(); ++n)
      outages.present[k][n] = static_cast<std::uint8_t>(outages.present[k][n] & ~limited[n]);
  }
  return outages;
}

}  // namespace coast::array
