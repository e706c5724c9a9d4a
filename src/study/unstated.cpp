// Values left to the data by the configuration: each is tested, and used if the data are significant.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "coast/record/error.hpp"
#include "coast/study/mission.hpp"
#include "coast/study/plausibility.hpp"
#include "velocity_lag.hpp"

namespace coast::study {

namespace {

// The bounds on which the fit of the noise ended, and their meaning; empty if there are none.
std::string bounds_told(const estimate::NoiseFit& fit) {
  std::string none, other;
  for (std::size_t i = 0; i < fit.bounds.size(); ++i) {
    const std::string& name = fit.names[i];
    if (fit.bounds[i] == estimate::Bound::kNone) continue;
    // An amplitude or a factor on GNSS sigmas at zero is a result; a time or the IMU's noise at its bound is not.
    const bool vanishes = name.starts_with("gnss_scale") || name.ends_with("_m");
    std::string& list = fit.bounds[i] == estimate::Bound::kLower && vanishes ? none : other;
    list += (list.empty() ? "" : ", ") + name;
  }
  std::string text;
  if (!none.empty())
    text = fmt::format("The noise fit reduces {} to zero: the other errors of the fixes account for all of it.", none);
  if (!other.empty())
    text += fmt::format("{}The noise fit ends at a bound of {}: the recording has errors that are not of the fitted kinds.",
                        text.empty() ? "" : " ", other);
  return text;
}

}  // namespace

// Turns give a shift of the times to some 0.05 s, and sometimes a false one. It is used if the filter finds the fixes likelier
// with it; the gate is open, so that both use the same fixes.
void PreparedMission::choose_time_offset(const Progress& progress) {
  if (!setup_.unstated.time_offset || setup_.start || setup_.unstated.time_offset_seen_s == 0.0) return;
  constexpr double kCoarse = 0.4;  // s: the state of the offset estimates smaller ones
  const estimate::FilterOptions stated = setup_.filter;
  const auto log_likelihood_at = [&](double offset) {
    setup_.filter = stated;  // assumptions of one candidate do not apply to the next
    setup_.filter.gate_probability = 0.0;
    setup_.time_offset_s = mission_->time_offset_s = offset;
    try {
      align(progress);
      run_back_to_first_epoch();
      refine_start(progress);
      return first_seconds(kFirstMinutes, setup_.filter).log_likelihood;
    } catch (const NumericalError&) {
      return -std::numeric_limits<double>::infinity();
    }
  };
  // Between fixes the course is unknown: a neighbouring maximum is one fix interval away.
  const double seen = setup_.unstated.time_offset_seen_s;
  const double interval = fix_interval_s();
  double best = 0.0, most = log_likelihood_at(0.0);
  for (const double offset : {seen, seen - interval, seen + interval}) {
    if (offset != seen && interval < kCoarse) break;
    const double log_likelihood = log_likelihood_at(offset);
    if (log_likelihood <= most) continue;
    most = log_likelihood;
    best = offset;
  }
  setup_.filter = stated;
  setup_.time_offset_s = mission_->time_offset_s = best;
  start_sensor_errors_.resize(0);
}

void PreparedMission::take_out_velocity_lag() {
  if (!setup_.unstated.time_offset || !setup_.filter.use_gnss_velocity) return;
  velocity_lag_ = velocity_lag(gnss_);
  if (velocity_lag_) advance_velocities(gnss_, *velocity_lag_);
}

// If the sigmas of innovations do not fit, noise is stated wrongly, whatever the data sheet; also if the IMU's errors
// are impossible by the model.
void PreparedMission::test_noise() {
  constexpr double kSmallest = 0.7, kLargest = 1.4;  // of the normalised innovations squared over their expectation
  constexpr double kRefused = 0.05;
  constexpr double kImpossible = 6.0;  // prior sigmas
  constexpr double kShaken = 8.0;      // times the white noise
  constexpr double kFewest = 20.0, kFewestOfCorrelation = 100.0;
  constexpr double kScatter = 4.0;  // sigmas of a mean of few squares
  const estimate::NoiseFitChoice& choice = setup_.unstated.noise;
  if (!(choice.gnss_scale || choice.imu_white_noise)) return;
  const Eigen::VectorXd found = start_sensor_errors_;
  const ins::InitialState start = start_;
  refine_start({});
  const estimate::FilterResult seen = first_seconds(kFirstMinutes, setup_.filter);
  const estimate::StateLayout layout = estimate::ForwardFilter(*mission_, setup_.model, setup_.filter).layout();
  const auto worst = largest_sensor_error(layout, seen.last.x);
  start_ = start;
  start_sensor_errors_ = found;
  const auto innovations = static_cast<double>(seen.innovations.size());
  const auto refused = static_cast<double>(std::ranges::count(seen.innovations, false, &estimate::InnovationRecord::used));
  const double ratio = nis_over_expected(seen.innovations);
  // Innovations that are too small are caused by the fixes' stated noise: no IMU noise does this.
  const double by_chance = kScatter * std::sqrt(2.0 / (3.0 * std::max(innovations, 1.0)));  // chi-square of three each
  const bool fits = (ratio > std::min(kSmallest, 1.0 - by_chance) || !choice.gnss_scale) &&
                    ratio < std::max(kLargest, 1.0 + by_chance) && refused < kRefused * innovations;
  const bool possible = !worst || worst->sigmas < kImpossible;
  if (innovations < kFewest || (fits && possible)) return;
  if (!setup_.noise_fit) setup_.noise_fit = estimate::NoiseFitChoice{false, false, false};
  setup_.noise_fit->gnss_scale |= choice.gnss_scale;
  setup_.noise_fit->correlated_gnss |= choice.correlated_gnss && innovations >= kFewestOfCorrelation;
  setup_.noise_fit->imu_white_noise |= choice.imu_white_noise;
  noise_ratio_ = ratio;
  if (!choice.imu_white_noise || !has_gain_errors(setup_.model)) return;
  if (vibration_over_white_noise(imu_, setup_.model) < kShaken) return;
  setup_.model = without_gain_errors(setup_.model, imu_.rate_hz);
  start_sensor_errors_.resize(0);  // they belonged to the other layout
  gain_errors_left_out_ = true;
}

// EM on the drift of each axis, with the fitted noise.
void PreparedMission::adapt_drift() {
  constexpr double kContradicted = 2.0;  // times the stated sigma
  constexpr double kLargest = 100.0;     // larger values are no drift of a bias but another mistake
  constexpr double kSettled = 1.2;
  constexpr int kRounds = 4;
  if (!setup_.unstated.noise.imu_white_noise) return;
  double least = kContradicted;
  for (int round = 0; round < kRounds; ++round) {
    first_knots_.clear();
    estimate::FilterOutputs outputs;
    outputs.knots = &first_knots_;
    static_cast<void>(first_seconds(kFirstMinutes, setup_.filter, outputs));
    const estimate::StateLayout layout = estimate::ForwardFilter(*mission_, setup_.model, setup_.filter).layout();
    const DriftFactors seen =
        drift_seen(layout, estimate::smooth(first_knots_, layout, {}, estimate::KnotSampling(1.0)), least);
    if (seen.largest() == 1.0) return;
    const DriftFactors before = drift_;
    drift_.gyro = drift_.gyro.cwiseProduct(seen.gyro).cwiseMin(kLargest);
    drift_.accel = drift_.accel.cwiseProduct(seen.accel).cwiseMin(kLargest);
    setup_.model = with_drift_scaled(setup_.model, imu_.rate_hz,
                                     {drift_.gyro.cwiseQuotient(before.gyro), drift_.accel.cwiseQuotient(before.accel)});
    least = kSettled;
  }
}

void PreparedMission::note_adaptations() {
  constexpr double kNoted = 1e-3;     // s, m
  constexpr double kMeasured = 0.15;  // m: errors of a tape measure need no warning
  using Severity = record::Event::Severity;
  const auto note = [this](const char* kind, std::string text, Severity severity = Severity::kInfo) {
    adaptations_.push_back({severity, kind, std::move(text), std::nullopt, 1});
  };
  if (setup_.unstated.time_offset && std::abs(mission_->time_offset_s) > kNoted)
    note(
        "time_offset_found",
        fmt::format("The recording shows a time offset, which the run file does not state: gnss.time_offset_s: {:.4f} is used.",
                    mission_->time_offset_s));
  if (const Eigen::Vector3d moved = mission_->lever_arm_b - setup_.lever_arm_b; tested_.lever_arm && moved.norm() > kNoted) {
    // Zero usually means not measured.
    const bool contradicted = !setup_.lever_arm_b.isZero() && moved.norm() > kMeasured;
    const Eigen::Vector3d &found = mission_->lever_arm_b, &stated = setup_.lever_arm_b;
    note(contradicted ? "lever_arm_contradicted" : "lever_arm_found",
         fmt::format("The recording shows the antenna at ({:.2f}, {:.2f}, {:.2f}) m +- ({:.2f}, {:.2f}, {:.2f}), forward right "
                     "down of the IMU; the file says ({:.2f}, {:.2f}, {:.2f}). imu.lever_arm_m: [{:.3f}, {:.3f}, {:.3f}] is "
                     "used; `imu.lever_arm_sd_m: 0` keeps what is stated.",
                     found.x(), found.y(), found.z(), lever_arm_sd_.x(), lever_arm_sd_.y(), lever_arm_sd_.z(), stated.x(),
                     stated.y(), stated.z(), found.x(), found.y(), found.z()),
         contradicted ? Severity::kWarning : Severity::kInfo);
  }
  if (velocity_lag_)
    note("velocity_lag_removed",
         fmt::format("GNSS velocities lag the positions of the same file by {:.2f} s; the lag was removed.", *velocity_lag_));
  if (gain_errors_left_out_)
    note("gain_errors_left_out",
         "The IMU vibrates far above its stated noise: scale factors and misalignments cannot be separated from the vibration "
         "and "
         "are left out of the error model (imu.noise: {without_gain_errors: true}).");
  if (heading_assumed_)
    note(
        "heading_assumed",
        "Motion does not show the heading; it rests on the assumption that the body's x axis points in the direction of travel "
        "(vehicle: car). Otherwise give the attitude under `start:`.");
  if (drift_.largest() > 1.0)
    note("bias_drift_adapted",
         fmt::format(
             "Biases drift more than the error model allows: gyro x, y, z {:.3g}, {:.3g}, {:.3g} times its sigma, "
             "accelerometer {:.3g}, {:.3g}, {:.3g} times; used in this run (imu.noise.drift_factors). `noise: stated` keeps "
             "what is stated.",
             drift_.gyro.x(), drift_.gyro.y(), drift_.gyro.z(), drift_.accel.x(), drift_.accel.y(), drift_.accel.z()));
  if (!noise_fit_) return;
  if (const std::string text = bounds_told(*noise_fit_); !text.empty()) note("noise_on_bound", text);
  if (!noise_ratio_) return;
  const estimate::NoiseAdjustment& a = noise_fit_->adjustment;
  note("noise_adapted",
       fmt::format(
           "Squared innovations are {:.2g} times what the stated noise predicts. Fitted and used in its place: gyro noise "
           "times {:.3g}, {:.3g}, {:.3g} (x, y, z), accelerometer noise times {:.3g}, {:.3g}, {:.3g}, GNSS sigmas times {:.3g} "
           "horizontally and {:.3g} vertically "
           "with correlated errors of {:.2g} and {:.2g} m, correlation time {:.3g} s. `noise: stated` keeps what is stated.",
           *noise_ratio_, a.gyro_factors.x(), a.gyro_factors.y(), a.gyro_factors.z(), a.accel_factors.x(), a.accel_factors.y(),
           a.accel_factors.z(), a.gnss_scale.horizontal, a.gnss_scale.vertical, a.correlated_gnss.horizontal_m,
           a.correlated_gnss.vertical_m, a.correlated_gnss.time_s));
}

}  // namespace coast::study
