#include "evidence/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "coast/geo/earth.hpp"
#include "noise_effects/noise_effects.hpp"

namespace coast::diagnose {

namespace {

/// A quantity over time that divides a mission into halves with larger and smaller values.
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

constexpr double kRegimeStep = 0.1;  // s, interval of innovations

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

/// For the body's forward axis.
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

/// For positions and velocities, by tenths of the mission.
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

/// 0 if the regime never changes, or is unknown.
double nis_with_more_less_with_less(const MissionRun& run, const Regime& regime) {
  if (regime.value.empty()) return 0.0;
  std::vector<double> sorted = regime.value;
  std::ranges::sort(sorted);
  // The largest of counts may be that of more than half.
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

/// Power of the disturbances of each axis as from a Gauss-Markov process, relative to chance: their Allan curve,
/// at two averaging times.
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

}  // namespace coast::diagnose
