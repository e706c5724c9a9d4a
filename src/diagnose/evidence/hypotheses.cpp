#include "coast/diagnose/hypotheses.hpp"

#include <algorithm>
#include <array>
#include <iterator>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/study/interpolation.hpp"

namespace coast::diagnose {

Hypotheses::Hypotheses(const estimate::Mission& mission, const estimate::FilterOptions& filter, Grade grade,
                       const std::vector<record::NavState>& path, const std::vector<EffectPtr>& suggested)
    : mission_(mission),
      filter_(filter),
      path_(path),
      signals_(std::make_shared<const SignalTable>(mission.imu, mission.C_s_b)) {
  for (const Effect& effect : catalogue())
    if (why_not_seen(effect) == nullptr) add(effect, effect.plausible[static_cast<std::size_t>(grade)]);
  for (const EffectPtr& effect : suggested)
    if (why_not_seen(*effect) == nullptr) add(*effect, effect->plausible[static_cast<std::size_t>(grade)]);
  find_own_slopes();
}

Hypotheses::Hypotheses(const Hypotheses& all, const std::vector<Eigen::Index>& kept)
    : mission_(all.mission_), filter_(all.filter_), path_(all.path_), signals_(all.signals_) {
  for (const Part& part : all.parts_) {
    const auto is_of_it = [&](Eigen::Index i) { return i >= part.first && i < part.first + part.count; };
    if (std::ranges::any_of(kept, is_of_it)) add(*part.effect, all[part.first].plausible);
  }
  find_own_slopes();
}

void Hypotheses::add(const Effect& effect, double plausible) {
  const auto axes = static_cast<Eigen::Index>(effect.axes.size());
  parts_.push_back({&effect, size(), axes});
  for (Eigen::Index axis = 0; axis < axes; ++axis) all_.push_back({&effect, axis, plausible});
}

Eigen::Index Hypotheses::bias_step(Site site, Eigen::Index axis) const {
  const auto at = std::ranges::find_if(
      all_, [&](const Hypothesis& h) { return h.effect->name == "bias_step" && h.effect->site == site && h.axis == axis; });
  return at - all_.begin();
}

const char* Hypotheses::why_not_seen(const Effect& effect) const {
  if (effect.needs_reference) return "no innovation changes: only a reference could show it";
  if (effect.needs_temperature && !signals_->has_temperature()) return "no temperature was recorded";
  if (effect.slip && !filter_.vehicle.non_holonomic) return "the run is not told that the vehicle neither slides nor lifts";
  if (effect.slip && filter_.auxiliary.mounting_sd > 0.0) return "the run estimates it itself";
  return nullptr;
}

Signals Hypotheses::signals(const estimate::SampleView& sample) const {
  return signals_->at(std::min(sample.index, mission_.imu.samples.size() - 1), sample.omega_b, sample.f_b, sample.nav);
}

void Hypotheses::add_errors(const Signals& at, Eigen::Matrix3Xd& gyro, Eigen::Matrix3Xd& accel) const {
  for (const Part& part : parts_) {
    if (part.effect->sensors) {
      SensorErrors errors{gyro.middleCols(part.first, part.count), accel.middleCols(part.first, part.count)};
      part.effect->sensors(at, errors);
    }
  }
}

void Hypotheses::add_own_slopes(const estimate::SampleView& sample, estimate::OwnSlopes& slopes) const {
  slopes += own_slopes(signals(sample));
}

// At signals none of which is zero or equal to another.
void Hypotheses::find_own_slopes() {
  Signals some;
  some.omega = {0.11, -0.23, 0.37};
  some.f = {1.3, -0.7, -9.1};
  some.omega_dot = {0.5, 0.3, -0.9};
  some.vibration = {0.2, 0.5, 0.9};
  some.coning = {1e-5, 2e-5, -3e-5};
  some.temperature = 3.0;
  some.temperature_rate = 0.01;
  some.elapsed = 100.0;
  some.speed = 10.0;
  some.C_n_e = geo::C_n_e({0.7, 0.2, 100.0});
  some.C_e_s = (some.C_n_e * geo::rotation_matrix({0.1, -0.2, 0.9})).transpose();
  const estimate::OwnSlopes slopes = own_slopes(some);
  for (const auto& column : slopes.colwise()) grows_.push_back(!column.isZero(1e-12));
}

estimate::OwnSlopes Hypotheses::own_slopes(const Signals& at) const {
  constexpr double kRate = 1e-3, kForce = 1e-2;  // rad/s, m/s^2: equations are of second order at most
  estimate::OwnSlopes slopes(6, size());
  const auto errors_at = [&](const Signals& signals) {
    std::array<Eigen::Matrix3Xd, 2> errors{Eigen::Matrix3Xd::Zero(3, size()), Eigen::Matrix3Xd::Zero(3, size())};
    add_errors(signals, errors[0], errors[1]);
    return errors;
  };
  for (Eigen::Index axis = 0; axis < 6; ++axis) {
    Signals above = at, below = at;
    const bool gyro = axis < 3;
    const double step = gyro ? kRate : kForce;
    (gyro ? above.omega : above.f)(axis % 3) += step;
    (gyro ? below.omega : below.f)(axis % 3) -= step;
    const auto sensor = gyro ? std::size_t{0} : std::size_t{1};
    slopes.row(axis) = (errors_at(above)[sensor].row(axis % 3) - errors_at(below)[sensor].row(axis % 3)) / (2.0 * step);
  }
  return slopes;
}

void Hypotheses::add_sensor_errors(const estimate::SampleView& sample, Eigen::Matrix3Xd& gyro_b,
                                   Eigen::Matrix3Xd& accel_b) const {
  add_errors(signals(sample), gyro_b, accel_b);
  gyro_b = mission_.C_s_b * gyro_b;
  accel_b = mission_.C_s_b * accel_b;
}

record::NavState Hypotheses::smoothed(const record::NavState& filtered) const {
  const auto behind = std::ranges::lower_bound(path_, filtered.t, {}, &record::NavState::t);
  if (behind == path_.end() || behind == path_.begin()) return filtered;
  return study::interpolate(*std::prev(behind), *behind, filtered.t);
}

void Hypotheses::add_measurement_errors(const estimate::MeasurementView& m, Eigen::MatrixXd& D) const {
  if (m.kind == estimate::UpdateKind::kGnssPosition || m.kind == estimate::UpdateKind::kGnssVelocity) add_fix_errors(m, D);
  // z - v - C (omega x l): an excess of the rate appears as a deficit of the antenna velocity.
  if (m.kind == estimate::UpdateKind::kGnssVelocity)
    D += m.nav.q_b_e.toRotationMatrix() * geo::skew(m.context.lever_arm_b) * rate_errors(m, D.cols());
  if (m.kind == estimate::UpdateKind::kNonHolonomic) add_slip(m, D);
}

void Hypotheses::add_slip(const estimate::MeasurementView& m, Eigen::MatrixXd& D) const {
  const estimate::NonHolonomic& constraint = *filter_.vehicle.non_holonomic;
  const record::NavState nav = smoothed(m.nav);
  const WheelSignals s{nav.q_b_e.conjugate() * nav.v_eb_e + m.context.omega_eb_b.cross(constraint.point_b), constraint};
  Eigen::Matrix2Xd columns = Eigen::Matrix2Xd::Zero(2, D.cols());
  for (const Part& part : parts_)
    if (part.effect->slip) part.effect->slip(s, columns.middleCols(part.first, part.count));
  const Eigen::Matrix3Xd slip_b = geo::skew(constraint.point_b) * rate_errors(m, D.cols());
  D = columns + (estimate::C_b_v_of(constraint.pitch, constraint.yaw) * slip_b).bottomRows<2>();
}

Eigen::Matrix3Xd Hypotheses::rate_errors(const estimate::MeasurementView& m, Eigen::Index columns) const {
  Eigen::Matrix3Xd gyro_b = Eigen::Matrix3Xd::Zero(3, columns);
  Eigen::Matrix3Xd accel_b = gyro_b;
  const Eigen::Vector3d earth_b = m.nav.q_b_e.conjugate() * Eigen::Vector3d(0.0, 0.0, mission_.earth_rate);
  add_sensor_errors({m.sample, m.context.omega_eb_b + earth_b, signals_->means_about(m.sample).f_b, m.nav}, gyro_b, accel_b);
  return gyro_b;
}

void Hypotheses::add_fix_errors(const estimate::MeasurementView& m, Eigen::MatrixXd& D) const {
  const record::NavState nav = smoothed(m.nav);
  FixSignals s;
  s.C_b_e = nav.q_b_e.toRotationMatrix();
  s.C_n_e = m.context.C_n_e;
  s.omega_b = m.context.omega_eb_b;
  const SignalTable::Means means = signals_->means_about(m.sample);
  const Eigen::Vector3d earth(0.0, 0.0, mission_.earth_rate);
  s.v_ea_e = nav.v_eb_e + (s.C_b_e * means.omega_b - earth).cross(s.C_b_e * m.context.lever_arm_b);
  s.a_ea_e = s.C_b_e * means.f_b + geo::gravity_e(nav.r_eb_e) - 2.0 * earth.cross(nav.v_eb_e);
  s.elapsed = nav.t - mission_.imu.samples.front().t;
  const bool position = m.kind == estimate::UpdateKind::kGnssPosition;
  Eigen::Matrix3Xd columns(3, D.cols());
  columns.setZero();
  for (const Part& part : parts_) {
    const auto& add = position ? part.effect->position : part.effect->velocity;
    if (add) add(s, columns.middleCols(part.first, part.count));
  }
  D = columns;
}

}  // namespace coast::diagnose
