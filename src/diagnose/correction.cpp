#include "coast/diagnose/correction.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "coast/geo/earth.hpp"
#include "coast/record/error.hpp"
#include "evidence/mission_run.hpp"
#include "evidence/noise_scan.hpp"
#include "evidence/selected_effects.hpp"

namespace coast::diagnose {

namespace {

constexpr double kLevelStep = 0.5;  // s, interval of a mean noise level

std::vector<geo::GpsTime> instants(const std::vector<record::NavState>& path, double step) {
  std::vector<geo::GpsTime> t;
  for (const record::NavState& nav : path)
    if (t.empty() || nav.t - t.back() >= step) t.push_back(nav.t);
  return t;
}

const record::NavState& nearest(const std::vector<record::NavState>& path, geo::GpsTime t) {
  auto behind = std::ranges::lower_bound(path, t, {}, &record::NavState::t);
  if (behind == path.end()) --behind;
  if (behind != path.begin() && t - std::prev(behind)->t < behind->t - t) --behind;
  return *behind;
}

void correct_samples(const SelectedAlone& selected, const std::vector<record::NavState>& path, record::ImuRecording& imu) {
  const WithSelected& effects = selected.effects();
  const Eigen::VectorXd c = selected.coefficients();
  Eigen::Matrix3Xd gyro(3, effects.size());
  Eigen::Matrix3Xd accel(3, effects.size());
  for (std::size_t i = 0; i < imu.samples.size(); ++i) {
    record::ImuSample& sample = imu.samples[i];
    if (!effects.any_holds(sample.t)) continue;
    gyro.setZero();
    accel.setZero();
    effects.add_sensor_errors({i, sample.dtheta / sample.dt, sample.dv / sample.dt, nearest(path, sample.t)}, gyro, accel);
    sample.dtheta -= sample.dt * (gyro * c);
    sample.dv -= sample.dt * (accel * c);
  }
}

void correct_fixes(const SelectedAlone& selected, const std::vector<record::NavState>& path, const estimate::Mission& mission,
                   const estimate::StateLayout& layout, record::GnssRecording& gnss) {
  const WithSelected& effects = selected.effects();
  const Eigen::VectorXd c = selected.coefficients();
  const std::vector<record::ImuSample>& samples = mission.imu.samples;
  const Eigen::Vector3d earth_e(0.0, 0.0, mission.earth_rate);
  Eigen::MatrixXd D(3, effects.size());
  for (record::GnssFix& fix : gnss.fixes) {
    const geo::GpsTime t = fix.t - mission.time_offset_s;
    if (t < path.front().t || t > path.back().t || !effects.any_holds(t)) continue;
    const auto sample = std::min(std::ranges::upper_bound(samples, t, {}, &record::ImuSample::t), samples.end() - 1);
    const record::NavState& nav = nearest(path, t);
    const Eigen::Matrix3d C_n_e = geo::C_n_e(geo::geodetic_from_ecef(nav.r_eb_e));
    const estimate::UpdateContext context{
        layout, mission.lever_arm_b, sample->dtheta / sample->dt - nav.q_b_e.toRotationMatrix().transpose() * earth_e, C_n_e};
    estimate::MeasurementView view{estimate::UpdateKind::kGnssPosition, static_cast<std::size_t>(sample - samples.begin()), nav,
                                   context};
    D.setZero();
    effects.add_fix_errors(view, D);
    fix.r_ea_e -= D * c;
    if (!fix.velocity) continue;
    view.kind = estimate::UpdateKind::kGnssVelocity;
    D.setZero();
    effects.add_fix_errors(view, D);
    fix.velocity->v_ea_n -= C_n_e.transpose() * (D * c);
  }
}

/// Moves the base back along north, east or down: fixes and a start known in its frame are moved too.
void move_base(MissionInput& input, Eigen::Index axis, double offset) {
  const auto move = [&](Eigen::Vector3d& r_e) { r_e -= offset * geo::C_n_e(geo::geodetic_from_ecef(r_e)).col(axis); };
  for (record::GnssFix& fix : input.gnss.fixes) move(fix.r_ea_e);
  if (input.setup.start) move(input.setup.start->nav.r_eb_e);
}

}  // namespace

MissionInput without(const std::vector<SelectedEffect>& effects, const MissionInput& input, const Hypotheses& hypotheses,
                     const std::vector<record::NavState>& path, const estimate::Mission& mission,
                     const estimate::StateLayout& layout) {
  MissionInput result = input;
  std::vector<SelectedEffect> in_recordings;
  for (const SelectedEffect& one : effects) {
    const Hypothesis& h = hypotheses[one.hypothesis];
    if (!h.effect->configure || one.from || one.to) {
      in_recordings.push_back(one);
      continue;
    }
    Eigen::VectorXd value = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(h.effect->axes.size()));
    value(h.axis) = one.value;
    h.effect->configure(result.setup, value);
  }
  if (in_recordings.empty() || path.empty()) return result;
  const SelectedAlone selected(hypotheses, in_recordings);
  correct_samples(selected, path, result.imu);
  correct_fixes(selected, path, mission, layout, result.gnss);
  return result;
}

MissionInput without(const std::vector<NamedEffect>& effects, const MissionInput& recorded, const study::Progress& progress) {
  MissionInput input = recorded;
  for (const NamedEffect& one : effects)
    if (one.sample != nullptr) one.sample->model(input, one.sample->site, static_cast<int>(one.axis), one.value);
  for (const NamedEffect& one : effects)
    if (one.effect != nullptr && one.effect->needs_reference) move_base(input, one.axis, one.value);
  std::vector<EffectPtr> suggested;
  for (const NamedEffect& one : effects)
    if (one.suggested) suggested.push_back(one.suggested);
  const MissionRun run(input, grade_of(input.setup.model), suggested, progress);
  const int week = input.imu.samples.front().t.week();
  const std::vector<Hypothesis>& all = run.hypotheses().all();
  std::vector<SelectedEffect> selected;
  for (const NamedEffect& one : effects) {
    if (one.effect == nullptr || one.effect->needs_reference) continue;
    const auto h = std::ranges::find_if(all, [&](const Hypothesis& x) { return x.effect == one.effect && x.axis == one.axis; });
    if (h == all.end())
      throw InputError(
          {input.imu.source, 0,
           fmt::format("nothing that {} could act on: {}", one.effect->name, run.hypotheses().why_not_seen(*one.effect)),
           "no such effect, or a run that shows it", ""});
    SelectedEffect t{h - all.begin(), {}, {}, one.value};
    if (one.from_s) t.from = geo::GpsTime::from_week(week, *one.from_s);
    if (one.to_s) t.to = geo::GpsTime::from_week(week, *one.to_s);
    selected.push_back(t);
  }
  MissionInput result = without(selected, input, run.hypotheses(), run.path(), run.mission(), run.layout());
  const std::vector<geo::GpsTime> t = instants(run.path(), kLevelStep);
  for (const NamedEffect& one : effects)
    if (one.noise != nullptr)
      one.noise->add(result, static_cast<int>(one.axis), one.value, 0.0, t, level_of(*one.noise, t, run));
  return result;
}

}  // namespace coast::diagnose
