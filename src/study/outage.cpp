#include "coast/study/outage.hpp"

#include <algorithm>
#include <cmath>

#include "coast/geo/earth.hpp"
#include "coast/study/interpolation.hpp"

namespace coast::study {

namespace {

constexpr double kSeriesInterval = 0.1;  // s, of the stored errors

}  // namespace

OutageRecorder::OutageRecorder(const Outage& outage, const record::Trajectory& reference, const Eigen::Vector3d& lever_arm_b,
                               const estimate::Mission& mission)
    : outage_(outage), next_used_fix_(outage.span().to), reference_(reference), lever_arm_b_(lever_arm_b), mission_(mission) {
  const auto& fixes = mission.gnss.fixes;
  const auto first_at = [&](geo::GpsTime t) {
    return std::lower_bound(fixes.begin(), fixes.end(), t,
                            [](const record::GnssFix& f, geo::GpsTime time) { return f.t < time; });
  };
  next_fix_ = static_cast<std::size_t>(first_at(outage.start) - fixes.begin());
  const auto after = first_at(outage.span().to);
  if (after != fixes.end()) next_used_fix_ = after->t - mission.time_offset_s;
}

void OutageRecorder::add(const record::TrajectoryEpoch& epoch) {
  const geo::GpsTime t = epoch.nav.t;
  if (t < outage_.start - kMargin || t > outage_.span().to + kMargin) return;
  compare_with_fixes(epoch);
  const bool inside = outage_.start <= t && t < next_used_fix_;
  const bool due = series_.empty() || t - series_.back().t >= kSeriesInterval - 1e-6;
  if (inside || due) {
    if (const auto truth = state_at(reference_, t)) {
      record::TrajectoryEpoch moved = epoch;
      const Eigen::Vector3d rate = previous_ ? mean_rate(previous_->nav, epoch.nav) : Eigen::Vector3d::Zero();
      moved.nav = at_point(epoch.nav, lever_arm_b_, rate);
      const ErrorSample error = error_of(moved, *truth);
      if (inside) end_ = error;
      if (due) series_.push_back(error);
    }
  }
  previous_ = epoch;
}

void OutageRecorder::compare_with_fixes(const record::TrajectoryEpoch& epoch) {
  if (!previous_) return;
  const auto& fixes = mission_.gnss.fixes;
  for (; next_fix_ < fixes.size() && outage_.span().contains(fixes[next_fix_].t); ++next_fix_) {
    const geo::GpsTime t = fixes[next_fix_].t - mission_.time_offset_s;
    if (t > epoch.nav.t) return;
    if (t < previous_->nav.t) continue;
    const record::NavState nav = interpolate(previous_->nav, epoch.nav, t);
    const Eigen::Matrix3d C_e_n = geo::C_n_e(geo::geodetic_from_ecef(nav.r_eb_e)).transpose();
    const Eigen::Vector3d error_n = C_e_n * (nav.r_eb_e + nav.q_b_e * mission_.lever_arm_b - fixes[next_fix_].r_ea_e);
    gnss_horizontal_max_m_ = std::max(gnss_horizontal_max_m_.value_or(0.0), error_n.head<2>().norm());
  }
}

OutageErrors OutageRecorder::errors() const {
  OutageErrors e;
  e.series = series_;
  e.gnss_horizontal_max_m = gnss_horizontal_max_m_;
  if (end_) {
    e.end_m = end_->position_n;
    e.sigma_end_m = end_->sd_position;
  }
  double count = 0.0;
  for (const ErrorSample& s : series_) {
    if (s.t < outage_.start || s.t >= next_used_fix_) continue;
    count += 1.0;
    e.rms_m += s.position_n.cwiseAbs2();
    e.max_m = e.max_m.cwiseMax(s.position_n.cwiseAbs());
    e.sigma_max_m = e.sigma_max_m.cwiseMax(s.sd_position);
    e.horizontal_max_m = std::max(e.horizontal_max_m, s.position_n.head<2>().norm());
    e.attitude_max = e.attitude_max.cwiseMax(s.attitude.cwiseAbs());
    e.tested += 3;
    e.inside_95 += static_cast<std::size_t>((s.position_n.array().abs() <= 1.96 * s.sd_position.array()).count());
  }
  if (end_) {
    e.max_m = e.max_m.cwiseMax(end_->position_n.cwiseAbs());
    e.horizontal_max_m = std::max(e.horizontal_max_m, end_->position_n.head<2>().norm());
    e.sigma_max_m = e.sigma_max_m.cwiseMax(end_->sd_position);
  }
  if (count > 0.0) e.rms_m = (e.rms_m / count).cwiseSqrt();
  return e;
}

void GapFreeReference::add(const record::TrajectoryEpoch& epoch) {
  auto& states = trajectory_.states;
  if (states.empty() || epoch.nav.t - states.back().t >= kSeriesInterval - 1e-6) states.push_back(epoch.nav);
}

std::vector<Outage> outages_of(const OutageSweep& sweep, geo::GpsTime from, geo::GpsTime to) {
  std::vector<Outage> outages;
  for (const double duration : sweep.durations_s) {
    if (duration > 0.25 * (to - from)) continue;
    for (double start = sweep.first_s; start + duration < to - from; start += sweep.every_s)
      outages.push_back({from + start, duration, sweep.satellites_left});
  }
  return outages;
}

}  // namespace coast::study
