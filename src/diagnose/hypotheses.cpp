#include "coast/diagnose/hypotheses.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/study/interpolation.hpp"

namespace coast::diagnose {

namespace {

constexpr double kMeanOver = 0.1;       // s
constexpr double kVibrationOver = 1.0;  // s

Eigen::Vector3d force(const record::ImuSample& sample) {
  return sample.dv / sample.dt;
}

/// Variance about a mean over `half` samples on either side, taken twice, itself averaged over `long_half` on either side. Of
/// vibration at 15 Hz a mean over a tenth of a second has up to a fifth left, of either sign, and the mean of means a
/// twentieth.
std::vector<Eigen::Vector3f> vibration_of(const record::ImuRecording& imu, std::size_t half, std::size_t long_half,
                                          const Eigen::Matrix3d& C_b_s) {
  const std::size_t n = imu.samples.size();
  const auto mean = [n](const std::vector<Eigen::Vector3d>& sums, std::size_t i, std::size_t reach) -> Eigen::Vector3d {
    const std::size_t from = i > reach ? i - reach : 0;
    const std::size_t to = std::min(n, i + reach + 1);
    return (sums[to] - sums[from]) / static_cast<double>(to - from);
  };
  std::vector<Eigen::Vector3d> sums(n + 1, Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < n; ++i) sums[i + 1] = sums[i] + C_b_s * force(imu.samples[i]);
  std::vector<Eigen::Vector3d> sums_of_means(n + 1, Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < n; ++i) sums_of_means[i + 1] = sums_of_means[i] + mean(sums, i, half);
  std::vector<Eigen::Vector3d> squares(n + 1, Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < n; ++i)
    squares[i + 1] = squares[i] + (C_b_s * force(imu.samples[i]) - mean(sums_of_means, i, half)).cwiseAbs2();
  std::vector<Eigen::Vector3f> vibration(n);
  for (std::size_t i = 0; i < n; ++i) vibration[i] = mean(squares, i, long_half).cast<float>();
  return vibration;
}

/// Slope of the line through the temperatures of a minute about each sample.
std::vector<float> temperature_rates(const record::ImuRecording& imu) {
  constexpr double kHalf = 30.0;  // s
  std::vector<float> rates(imu.temperature.size());
  std::size_t from = 0;
  std::size_t to = 0;
  for (std::size_t i = 0; i < rates.size(); ++i) {
    while (imu.samples[i].t - imu.samples[from].t > kHalf) ++from;
    while (to + 1 < rates.size() && imu.samples[to].t - imu.samples[i].t < kHalf) ++to;
    const double span = imu.samples[to].t - imu.samples[from].t;
    rates[i] = span > 0.0 ? static_cast<float>((imu.temperature[to] - imu.temperature[from]) / span) : 0.0F;
  }
  return rates;
}

}  // namespace

SignalTable::SignalTable(const record::ImuRecording& imu, const Eigen::Matrix3d& C_s_b)
    : imu_(imu),
      C_b_s_(C_s_b.transpose()),
      half_(std::max<std::size_t>(1, static_cast<std::size_t>(0.5 * kMeanOver * imu.rate_hz))),
      vibration_(vibration_of(imu, half_, static_cast<std::size_t>(0.5 * kVibrationOver * imu.rate_hz), C_b_s_)),
      temperature_rate_(temperature_rates(imu)) {
  if (has_temperature())
    mean_temperature_ =
        std::accumulate(imu.temperature.begin(), imu.temperature.end(), 0.0) / static_cast<double>(imu.temperature.size());
}

Signals SignalTable::at(std::size_t sample, const Eigen::Vector3d& omega_b, const Eigen::Vector3d& f_b,
                        const record::NavState& nav) const {
  const std::vector<record::ImuSample>& samples = imu_.samples;
  Signals s;
  s.omega = C_b_s_ * omega_b;
  s.f = C_b_s_ * f_b;
  const record::ImuSample& before = samples[sample > half_ ? sample - half_ : 0];
  const record::ImuSample& behind = samples[std::min(samples.size() - 1, sample + half_)];
  const double span = behind.t - before.t;
  s.omega_dot = Eigen::Vector3d::Zero();
  if (span > 0.0) s.omega_dot = C_b_s_ * (behind.dtheta / behind.dt - before.dtheta / before.dt) / span;
  s.vibration = vibration_[sample].cast<double>();
  s.coning = Eigen::Vector3d::Zero();
  if (sample > 0) s.coning = C_b_s_ * samples[sample - 1].dtheta.cross(samples[sample].dtheta) / (12.0 * samples[sample].dt);
  if (has_temperature()) {
    s.temperature = imu_.temperature[sample] - mean_temperature_;
    s.temperature_rate = temperature_rate_[sample];
  }
  s.elapsed = nav.t - samples.front().t;
  s.speed = nav.v_eb_e.norm();
  s.C_e_s = C_b_s_ * nav.q_b_e.toRotationMatrix().transpose();
  s.C_n_e = geo::C_n_e(geo::geodetic_from_ecef(nav.r_eb_e));
  return s;
}

SignalTable::Means SignalTable::means_about(std::size_t sample) const {
  const std::size_t from = sample > half_ ? sample - half_ : 0;
  const std::size_t to = std::min(imu_.samples.size(), sample + half_);
  Eigen::Vector3d turned = Eigen::Vector3d::Zero();
  Eigen::Vector3d gained = Eigen::Vector3d::Zero();
  double time = 0.0;
  for (std::size_t i = from; i < to; ++i) {
    turned += imu_.samples[i].dtheta;
    gained += imu_.samples[i].dv;
    time += imu_.samples[i].dt;
  }
  if (!(time > 0.0)) return {};
  return {turned / time, gained / time};
}

Hypotheses::Hypotheses(const estimate::Mission& mission, const estimate::FilterOptions& filter, Grade grade,
                       const std::vector<record::NavState>& path, const std::vector<EffectPtr>& suggested)
    : mission_(mission), filter_(filter), path_(path), signals_(mission.imu, mission.C_s_b) {
  const auto add = [&](const Effect& effect) {
    if (why_not_seen(effect) != nullptr) return;
    const auto axes = static_cast<Eigen::Index>(effect.axes.size());
    parts_.push_back({&effect, size(), axes});
    for (Eigen::Index axis = 0; axis < axes; ++axis)
      all_.push_back({&effect, axis, effect.plausible[static_cast<std::size_t>(grade)]});
  };
  for (const Effect& effect : catalogue()) add(effect);
  for (const EffectPtr& effect : suggested) add(*effect);
}

Eigen::Index Hypotheses::bias_step(Site site, Eigen::Index axis) const {
  const auto at = std::ranges::find_if(
      all_, [&](const Hypothesis& h) { return h.effect->name == "bias_step" && h.effect->site == site && h.axis == axis; });
  return at - all_.begin();
}

const char* Hypotheses::why_not_seen(const Effect& effect) const {
  if (effect.needs_reference) return "no innovation changes: only a reference could show it";
  if (effect.needs_temperature && !signals_.has_temperature()) return "no temperature was recorded";
  if (effect.slip && !filter_.vehicle.non_holonomic) return "the run is not told that the vehicle neither slides nor lifts";
  if (effect.slip && filter_.auxiliary.mounting_sd > 0.0) return "the run estimates it itself";
  return nullptr;
}

Signals Hypotheses::signals(const estimate::SampleView& sample) const {
  return signals_.at(std::min(sample.index, mission_.imu.samples.size() - 1), sample.omega_b, sample.f_b, sample.nav);
}

void Hypotheses::add_sensor_errors(const estimate::SampleView& sample, Eigen::Matrix3Xd& gyro_b,
                                   Eigen::Matrix3Xd& accel_b) const {
  const Signals at = signals(sample);
  for (const Part& part : parts_) {
    if (part.effect->sensors) {
      SensorErrors errors{gyro_b.middleCols(part.first, part.count), accel_b.middleCols(part.first, part.count)};
      part.effect->sensors(at, errors);
    }
  }
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
  // z - v - C (omega x l): what the rate has too much the antenna seems to have too little.
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
  add_sensor_errors({m.sample, m.context.omega_eb_b + earth_b, signals_.means_about(m.sample).f_b, m.nav}, gyro_b, accel_b);
  return gyro_b;
}

void Hypotheses::add_fix_errors(const estimate::MeasurementView& m, Eigen::MatrixXd& D) const {
  const record::NavState nav = smoothed(m.nav);
  FixSignals s;
  s.C_b_e = nav.q_b_e.toRotationMatrix();
  s.C_n_e = m.context.C_n_e;
  s.omega_b = m.context.omega_eb_b;
  const SignalTable::Means means = signals_.means_about(m.sample);
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
