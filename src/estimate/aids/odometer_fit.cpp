#include "odometer_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace coast::estimate {

namespace {

/// Between two fixes, in motion.
struct Stretch {
  geo::GpsTime from;
  geo::GpsTime to;
  double chord = 0.0;
  double sd = 0.0;  ///< of the chord
};

constexpr std::size_t kFewest = 30;                // stretches in motion
constexpr std::size_t kMost = 4000;                // more determine no more
constexpr double kInMotion = 2.0;                  // m/s
constexpr double kShortest = 0.8, kLongest = 2.5;  // s: noise of fixes against the curvature of the path

std::vector<Stretch> stretches_in_motion(const record::GnssRecording& gnss) {
  std::vector<Stretch> found;
  const std::vector<record::GnssFix>& fixes = gnss.fixes;
  for (std::size_t from = 0, to = 0; from < fixes.size(); from = to) {
    for (to = from + 1; to < fixes.size() && fixes[to].t - fixes[from].t < kShortest; ++to) {
    }
    if (to == fixes.size()) break;
    const double span = fixes[to].t - fixes[from].t;
    const double chord = (fixes[to].r_ea_e - fixes[from].r_ea_e).norm();
    if (span > kLongest || chord <= kInMotion * span) continue;
    const double sd = std::sqrt((fixes[from].position_cov_n.trace() + fixes[to].position_cov_n.trace()) / 3.0);
    found.push_back({fixes[from].t, fixes[to].t, chord, sd});
  }
  if (found.size() <= kMost) return found;
  std::vector<Stretch> some;
  for (std::size_t i = 0; i < kMost; ++i) some.push_back(found[i * found.size() / kMost]);
  return some;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Agreement {
  double scale = 1.0;
  double cost = std::numeric_limits<double>::infinity();  ///< mean squared difference, each limited, m^2
  double misfit = 0.0;                                    ///< as in OdometerFit
  double spread = 0.0;                                    ///< likewise
  std::size_t stretches = 0;                              ///< within the rows
};

Agreement agreement_at(const TravelledDistance& distance, const std::vector<Stretch>& stretches, double delay,
                       std::optional<double> scale) {
  std::vector<double> chords, driven, ratios, sds;
  for (const Stretch& stretch : stretches) {
    const std::optional<double> d = distance.between(stretch.from + delay, stretch.to + delay);
    if (!d) continue;
    chords.push_back(stretch.chord);
    sds.push_back(stretch.sd);
    driven.push_back(*d);
    if (*d > 0.0) ratios.push_back(stretch.chord / *d);
  }
  Agreement result;
  result.stretches = chords.size();
  if (chords.size() < kFewest) return result;
  if (scale)
    result.scale = *scale;
  else if (!ratios.empty())
    result.scale = median(ratios);
  std::vector<double> differences;
  for (std::size_t i = 0; i < chords.size(); ++i) differences.push_back(std::abs(chords[i] - result.scale * driven[i]));
  const double usual = median(differences);
  constexpr double kLimit = 4.0;  // times the median: gross errors and slip, whose number is all that may count
  double sum = 0.0;
  for (const double difference : differences) sum += std::pow(std::min(difference, kLimit * usual), 2);
  result.cost = sum / static_cast<double>(chords.size());
  const double chord = median(chords);
  result.misfit = std::max(0.0, usual - 2.0 * median(sds)) / chord;
  for (double& c : chords) c = std::abs(c - chord);
  result.spread = median(chords) / chord;
  return result;
}

// Minimum of the parabola through values at -n, .., n steps, by least squares; within n/2 steps.
double vertex(const std::vector<double>& y) {
  const std::size_t half = y.size() / 2;
  const auto n = static_cast<double>(half);
  double s_y = 0.0, s_sy = 0.0, s_ssy = 0.0, s_ss = 0.0, s_ssss = 0.0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double s = static_cast<double>(i) - n;
    s_y += y[i];
    s_sy += s * y[i];
    s_ssy += s * s * y[i];
    s_ss += s * s;
    s_ssss += s * s * s * s;
  }
  const auto count = static_cast<double>(y.size());
  const double curvature = (count * s_ssy - s_ss * s_y) / (count * s_ssss - s_ss * s_ss);
  return curvature > 0.0 ? std::clamp(-0.5 * s_sy / s_ss / curvature, -0.5 * n, 0.5 * n) : 0.0;
}

// The best step within a second, or one farther away if it halves the cost: rows in UTC are 18 s from GPS time. About it
// parabolas, which are as wide as they are because the rounding of pulses is other noise at each delay.
double delay_of(const TravelledDistance& distance, const std::vector<Stretch>& stretches, std::optional<double> scale) {
  const auto costs = [&](double centre, double step, int steps) {
    std::vector<double> cost;
    for (int i = -steps; i <= steps; ++i) cost.push_back(agreement_at(distance, stretches, centre + i * step, scale).cost);
    return cost;
  };
  struct Best {
    double delay;
    double cost;
  };
  const auto best_within = [&](double centre, double step, int steps) -> Best {
    const std::vector<double> cost = costs(centre, step, steps);
    const auto least = std::ranges::min_element(cost);
    return {centre + step * static_cast<double>(least - cost.begin() - steps), *least};
  };
  constexpr double kStep = 0.05, kWideStep = 0.2, kFineStep = 0.01;  // s
  constexpr int kSteps = 20, kWideSteps = 150, kFineSteps = 10;
  Best best = best_within(0.0, kStep, kSteps);
  const Best far = best_within(0.0, kWideStep, kWideSteps);
  if (far.cost < 0.5 * best.cost) best = best_within(far.delay, kStep, kSteps);
  for (int round = 0; round < 2; ++round) {
    const std::vector<double> fine = costs(best.delay, kFineStep, kFineSteps);
    if (std::isfinite(*std::ranges::max_element(fine))) best.delay += kFineStep * vertex(fine);
  }
  return best.delay;
}

TravelledDistance accumulated(const record::AidRecording& rows,
                              double (*over)(const record::AidSample&, const record::AidSample&)) {
  TravelledDistance result;
  double distance = 0.0;
  std::size_t gaps = 0;
  for (std::size_t i = 0; i < rows.samples.size(); ++i) {
    if (i > 0) {
      const double step = over(rows.samples[i - 1], rows.samples[i]);
      if (step < 0.0 || rows.samples[i].t - rows.samples[i - 1].t > kLongestOdometerGap)
        ++gaps;
      else
        distance += step;
    }
    result.t.push_back(rows.samples[i].t);
    result.distance.push_back(distance);
    result.bridged.push_back(gaps);
  }
  return result;
}

}  // namespace

std::optional<double> TravelledDistance::between(geo::GpsTime from, geo::GpsTime to) const {
  if (t.size() < 2 || from < t.front() || t.back() < to) return std::nullopt;
  const auto before = [this](geo::GpsTime at) {
    const auto after = std::upper_bound(t.begin() + 1, t.end() - 1, at);
    return static_cast<std::size_t>(after - t.begin()) - 1;
  };
  const std::size_t a = before(from), b = before(to);
  if (bridged[a] != bridged[b + 1]) return std::nullopt;
  const auto value = [this](std::size_t i, geo::GpsTime at) {
    return distance[i] + (distance[i + 1] - distance[i]) * ((at - t[i]) / (t[i + 1] - t[i]));
  };
  return value(b, to) - value(a, from);
}

TravelledDistance distance_by_speed(const record::AidRecording& rows) {
  return accumulated(rows, [](const record::AidSample& a, const record::AidSample& b) {
    return 0.5 * (std::abs(a.value.x()) + std::abs(b.value.x())) * (b.t - a.t);
  });
}

TravelledDistance distance_by_count(const record::AidRecording& rows) {
  return accumulated(rows, [](const record::AidSample& a, const record::AidSample& b) { return b.value.x() - a.value.x(); });
}

OdometerFit fit_odometer(const TravelledDistance& distance, const record::GnssRecording& gnss, std::optional<double> scale,
                         std::optional<double> delay_s) {
  OdometerFit fit{false, scale.value_or(1.0), delay_s.value_or(0.0), 0, 0.0, 0.0};
  if (scale && delay_s) return fit;
  const std::vector<Stretch> stretches = stretches_in_motion(gnss);
  const double delay = delay_s ? *delay_s : delay_of(distance, stretches, scale);
  const Agreement found = agreement_at(distance, stretches, delay, scale);
  if (found.stretches < kFewest) return fit;
  return {true, found.scale, delay, found.stretches, found.misfit, found.spread};
}

}  // namespace coast::estimate
