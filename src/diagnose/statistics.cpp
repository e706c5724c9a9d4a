#include "statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "coast/geo/earth.hpp"
#include "noise_effects/noise_effects.hpp"
#include "search.hpp"

namespace coast::diagnose {

namespace {

/// A quantity over time that splits a mission into a half with more and a half with less of it.
struct Regime {
  std::string name;
  std::vector<geo::GpsTime> t = {};
  std::vector<double> value = {};
  void add(geo::GpsTime at, double of) {
    t.push_back(at);
    value.push_back(of);
  }
  [[nodiscard]] bool has_more(geo::GpsTime at, double middle) const {
    const auto behind = std::min(std::ranges::lower_bound(t, at), t.end() - 1);
    return value[static_cast<std::size_t>(behind - t.begin())] > middle;
  }
};

constexpr double kRegimeStep = 0.1;  // s, as innovations come

void add_motion(const MissionRun& run, std::vector<Regime>& regimes) {
  const std::size_t first = regimes.size();
  for (const char* name : {"speed", "turn rate", "acceleration", "vibration", "temperature", "time"}) regimes.push_back({name});
  std::optional<geo::GpsTime> last;
  run.for_each_sample([&](std::size_t, geo::GpsTime t, const Signals& s) {
    if (last && t - *last < kRegimeStep) return;
    last = t;
    const std::array values{s.speed,           s.omega.norm(), std::abs(s.f.norm() - geo::kStandardGravity),
                            s.vibration.sum(), s.temperature,  s.elapsed};
    for (std::size_t i = 0; i < values.size(); ++i) regimes[first + i].add(t, values[i]);
  });
}

/// Of the body's forward axis.
void add_heading(const MissionRun& run, std::vector<Regime>& regimes) {
  Regime north{"heading to the north"};
  Regime east{"heading to the east"};
  for (const record::NavState& nav : run.path()) {
    if (!north.t.empty() && nav.t - north.t.back() < kRegimeStep) continue;
    const Eigen::Vector3d forward_e = nav.q_b_e.toRotationMatrix().col(0);
    const Eigen::Matrix3d C_n_e = geo::C_n_e(geo::geodetic_from_ecef(nav.r_eb_e));
    north.add(nav.t, C_n_e.col(0).dot(forward_e));
    east.add(nav.t, C_n_e.col(1).dot(forward_e));
  }
  regimes.push_back(std::move(north));
  regimes.push_back(std::move(east));
}

void add_satellites(const MissionRun& run, std::vector<Regime>& regimes) {
  Regime satellites{"satellites"};
  for (const record::GnssFix& fix : run.mission().gnss.fixes)
    if (fix.satellites) satellites.add(fix.t - run.mission().time_offset_s, *fix.satellites);
  regimes.push_back(std::move(satellites));
}

struct Mean {
  double sum = 0.0;
  double count = 0.0;
  [[nodiscard]] double value() const { return count > 0.0 ? sum / count : 0.0; }
};

void add_innovations(const MissionRun& run, std::vector<Statistic>& figures) {
  std::array<Mean, 2> nis;
  std::array<double, 3> products{}, squares{}, before{};
  for (const estimate::InnovationRecord& r : run.solution().forward.innovations) {
    const bool position = estimate::is_position(r.kind);
    if (!r.used || (!position && r.kind != estimate::UpdateKind::kGnssVelocity)) continue;
    Mean& mean = nis[position ? 0 : 1];
    mean.sum += r.nis;
    mean.count += r.dof;
    if (!position) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const double u = r.nu(static_cast<Eigen::Index>(i)) / r.sd(static_cast<Eigen::Index>(i));
      products[i] += u * before[i];
      squares[i] += u * u;
      before[i] = u;
    }
  }
  figures.push_back({"NIS of positions", nis[0].value()});
  figures.push_back({"NIS of velocities", nis[1].value()});
  for (std::size_t i = 0; i < 3; ++i)
    figures.push_back({fmt::format("correlation of successive innovations, {}", "NED"[i]),
                       squares[i] > 0.0 ? products[i] / squares[i] : 0.0});
}

/// Of positions and velocities, tenth by tenth of the mission.
void add_tenths(const MissionRun& run, std::vector<Statistic>& figures) {
  constexpr std::size_t kParts = 10;
  const std::vector<record::ImuSample>& samples = run.mission().imu.samples;
  const geo::GpsTime start = samples.front().t;
  const double length = (samples.back().t - start) / static_cast<double>(kParts);
  std::array<Mean, kParts> nis;
  for (const estimate::InnovationRecord& r : run.solution().forward.innovations) {
    if (!r.used) continue;
    Mean& mean = nis[static_cast<std::size_t>(std::clamp((r.t - start) / length, 0.0, static_cast<double>(kParts - 1)))];
    mean.sum += r.nis;
    mean.count += r.dof;
  }
  for (std::size_t k = 0; k < kParts; ++k) {
    const Stretch stretch{length * static_cast<double>(k), length * static_cast<double>(k + 1)};
    figures.push_back({fmt::format("NIS from {:.0f} to {:.0f} s", stretch.from_s, stretch.to_s), nis[k].value(), stretch});
  }
}

/// 0 where the regime never changes, or is not known.
double nis_with_more_less_with_less(const MissionRun& run, const Regime& regime) {
  if (regime.value.empty()) return 0.0;
  std::vector<double> sorted = regime.value;
  std::ranges::sort(sorted);
  // Of counts the largest may be that of more than half.
  const auto largest = std::ranges::lower_bound(sorted, sorted.back());
  if (largest == sorted.begin()) return 0.0;
  const auto middle = std::min(sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), largest - 1);
  std::array<Mean, 2> nis;
  for (const estimate::InnovationRecord& r : run.solution().forward.innovations) {
    if (!r.used) continue;
    Mean& mean = nis[regime.has_more(r.t, *middle) ? 1 : 0];
    mean.sum += r.nis;
    mean.count += r.dof;
  }
  return nis[0].count > 0.0 && nis[1].count > 0.0 ? nis[1].value() - nis[0].value() : 0.0;
}

void add_regimes(const MissionRun& run, std::vector<Statistic>& figures) {
  std::vector<Regime> regimes;
  add_motion(run, regimes);
  add_heading(run, regimes);
  add_satellites(run, regimes);
  for (const Regime& regime : regimes)
    figures.push_back(
        {fmt::format("NIS with more {} less that with less", regime.name), nis_with_more_less_with_less(run, regime)});
}

/// Power of the disturbances of each axis as a Gauss-Markov process would bring about, over what chance has: their Allan curve,
/// read at two averaging times.
void add_disturbances(const Disturbances& d, std::vector<Statistic>& figures) {
  constexpr std::array<double, 2> kTimes{5.0, 100.0};
  for (std::size_t axis = 0; axis < kAxes; ++axis)
    for (const double time : kTimes) {
      const Eigen::ArrayXf power = gauss_markov_power(d, d.score[axis], time);
      const float by_chance = power.tail(power.size() - 1).mean();
      figures.push_back({fmt::format("wandering of {} {} over {:g} s", axis < 3 ? "gyro" : "accel",
                                     axis_letter(static_cast<int>(axis % 3)), time),
                         by_chance > 0.0F ? std::log(static_cast<double>(power(0)) / static_cast<double>(by_chance)) : 0.0});
    }
}

double quantile(std::vector<double> sorted, double p) {
  const double at = p * static_cast<double>(sorted.size() - 1);
  const auto low = static_cast<std::size_t>(at);
  const std::size_t high = std::min(low + 1, sorted.size() - 1);
  return sorted[low] + (at - static_cast<double>(low)) * (sorted[high] - sorted[low]);
}

struct Spread {
  double mean = 0.0;
  double sd = 0.0;
  [[nodiscard]] double away(double value) const { return sd > 0.0 ? std::abs(value - mean) / sd : 0.0; }
};
/// @param without  a twin that is left out; beyond their number: none
Spread spread_of(const std::vector<std::vector<Statistic>>& twins, std::size_t figure, std::size_t without) {
  double sum = 0.0, squares = 0.0, count = 0.0;
  for (std::size_t i = 0; i < twins.size(); ++i) {
    if (i == without) continue;
    sum += twins[i][figure].value;
    squares += twins[i][figure].value * twins[i][figure].value;
    count += 1.0;
  }
  if (count < 2.0) return {};  // one tells nothing of a spread
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(0.0, (squares - count * mean * mean) / (count - 1.0)))};
}

}  // namespace

std::vector<Statistic> statistics_of(const MissionRun& run, const Examination& examination) {
  std::vector<Statistic> figures;
  add_innovations(run, figures);
  add_tenths(run, figures);
  add_regimes(run, figures);
  add_disturbances(examination.disturbances, figures);
  double largest = 0.0;
  for (const Suspicion& s : suspicions(examination, run.hypotheses(), {}).all) largest = std::max(largest, s.likelihood_ratio);
  figures.push_back({"largest sigma of all effects", std::sqrt(largest)});
  figures.push_back({"outages of 20 s, m", run.fit().outage_rms_m});
  return figures;
}

std::vector<TwinStatistic> against(const std::vector<Statistic>& real, const std::vector<std::vector<Statistic>>& twins) {
  std::vector<TwinStatistic> result;
  if (twins.empty()) return result;
  std::vector<double> farthest(twins.size(), 0.0);
  for (std::size_t j = 0; j < real.size(); ++j)
    for (std::size_t i = 0; i < twins.size(); ++i)
      farthest[i] = std::max(farthest[i], spread_of(twins, j, i).away(twins[i][j].value));
  for (std::size_t j = 0; j < real.size(); ++j) {
    std::vector<double> values;
    for (const std::vector<Statistic>& one : twins) values.push_back(one[j].value);
    std::ranges::sort(values);
    const double away = spread_of(twins, j, twins.size()).away(real[j].value);
    const auto as_far = static_cast<double>(std::ranges::count_if(farthest, [&](double f) { return f >= away; }));
    result.push_back({real[j].name, real[j].stretch, real[j].value, quantile(values, 0.05), quantile(values, 0.5),
                      quantile(values, 0.95), (1.0 + as_far) / (1.0 + static_cast<double>(twins.size()))});
  }
  return result;
}

std::vector<Statistic> statistics_of(const MissionInput& input, std::uint64_t seed) {
  DiagnosisOptions options;
  options.seed = seed;
  const Search search(input, options, Order::kNoiseFirst, {});
  return statistics_of(search.run(), search.examined());
}

}  // namespace coast::diagnose
