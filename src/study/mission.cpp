#include "coast/study/mission.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "coast/ins/compensation.hpp"
#include "coast/record/error.hpp"
#include "coast/study/plausibility.hpp"
#include "gross_errors.hpp"
#include "gyro_start.hpp"
#include "reversed_state.hpp"
#include "stage.hpp"
#include "velocity_lag.hpp"

namespace coast::study {

namespace {

constexpr double kRefineWindow = 300.0;  // s that the start is refined over
constexpr double kFitWindow = 1200.0;    // s that noise is fitted over
constexpr double kShortestFit = 100.0;   // s: fewer say too little of correlated errors

void check_overlap(const record::ImuRecording& imu, const record::GnssRecording& gnss) {
  const auto span = [](geo::GpsTime from, geo::GpsTime to) { return geo::to_string(from) + " to " + geo::to_string(to); };
  if (imu.samples.size() < 2) throw InputError({imu.source, 0, "fewer than two samples", "an IMU recording", ""});
  if (gnss.fixes.empty()) throw InputError({gnss.source, 0, "no fix", "a GNSS recording", ""});
  const geo::GpsTime from = std::max(imu.samples.front().t, gnss.fixes.front().t);
  const geo::GpsTime to = std::min(imu.samples.back().t, gnss.fixes.back().t);
  if (from < to) return;
  throw InputError({imu.source, 0,
                    fmt::format("IMU and GNSS do not overlap: the IMU spans {}, {} spans {}",
                                span(imu.samples.front().t, imu.samples.back().t), gnss.source,
                                span(gnss.fixes.front().t, gnss.fixes.back().t)),
                    "a common stretch of time", "Check gps_week and the time scale (GPS or UTC) of both files."});
}

double largest(const noise::ImuErrorModel& model, noise::Sensor sensor) {
  double value = 0.0;
  for (int axis = 0; axis < 3; ++axis) value = std::max(value, model.bias_sd(sensor, axis));
  return value;
}

// Of the used GNSS innovations; 1 where the noise is as stated.
double nis_over_expected(const std::vector<estimate::InnovationRecord>& innovations) {
  double nis = 0.0, dof = 0.0;
  for (const estimate::InnovationRecord& r : innovations) {
    if (!r.used || !(estimate::is_position(r.kind) || r.kind == estimate::UpdateKind::kGnssVelocity)) continue;
    nis += r.nis;
    dof += r.dof;
  }
  return dof > 0.0 ? nis / dof : 1.0;
}

// Where a gap of the IMU stands between the first epoch and the motion that shows the heading, the alignment begins behind it.
ins::InitialState align_around_gaps(const ins::AlignmentInput& input, bool vehicle_forward) {
  constexpr double kGap = 1.0;  // s
  const auto long_gap = [](const record::ImuSample& sample) { return sample.dt > kGap; };
  const std::vector<record::ImuSample>& samples = input.imu.samples;
  auto gap = std::ranges::find_if(samples, long_gap);
  if (gap == samples.end()) return ins::align(input, vehicle_forward);
  try {
    return ins::align(input, vehicle_forward);
  } catch (const NumericalError&) {
  }
  for (; gap != samples.end(); gap = std::find_if(gap + 1, samples.end(), long_gap)) {
    record::ImuRecording behind = input.imu;
    behind.samples.assign(gap + 1, samples.end());
    if (behind.samples.empty()) break;
    try {
      return ins::align(
          {behind, input.gnss, input.lever_arm_b, input.gyro_noise_density, input.gyro_bias_sd, input.accel_bias_sd},
          vehicle_forward);
    } catch (const NumericalError&) {
    }
  }
  return ins::align(input, vehicle_forward);  // says why
}

}  // namespace

PreparedMission::PreparedMission(record::ImuRecording imu, record::GnssRecording gnss, Setup setup, const Progress& progress)
    : imu_(std::move(imu)), gnss_(std::move(gnss)), setup_(std::move(setup)) {
  check_overlap(imu_, gnss_);
  if (setup_.unstated.time_offset || setup_.unstated.noise.gnss_scale) leave_out_gross_errors(gnss_, adaptations_);
  take_out_velocity_lag();
  find_standstill();
  choose_time_offset(progress);
  align(progress);
  if (setup_.high_order_compensation) {
    ins::compensate_chebyshev(imu_);
    mission_->increments = ins::IncrementKind::kCompensated;
  }
  if (!setup_.start) run_back_to_first_epoch();
  const double coarse_offset = mission_->time_offset_s;
  const double stated_offset_sd = setup_.filter.auxiliary.time_offset_sd_s;
  test_time_offset();
  if (setup_.unstated.time_offset && setup_.filter.auxiliary.time_offset_sd_s > 0.0) {
    refine_start(progress);
    refine_antenna(progress);
  }
  test_noise();
  if (noise_ratio_ && setup_.unstated.time_offset) {  // found beside the wrong noise, it is to be found again
    mission_->time_offset_s = coarse_offset;
    setup_.filter.auxiliary.time_offset_sd_s = stated_offset_sd;
  }
  if (setup_.noise_fit) {
    fit_and_adopt(progress);
  } else {
    refine_start(progress);
    refine_antenna(progress);
  }
  note_adaptations();
  mission_->carrier = setup_.carrier.get();
}

// The filter over the first minutes, as far as the start may look.
estimate::FilterResult PreparedMission::first_minutes(estimate::FilterOptions options) const {
  geo::GpsTime end = start_.nav.t + kRefineWindow;
  if (setup_.refine_before) {
    end = std::min(end, *setup_.refine_before);
    options.withheld.push_back({*setup_.refine_before, *setup_.refine_before + kRefineWindow});
  }
  const estimate::ForwardFilter filter(*mission_, setup_.model, options);
  return filter.run_until(start_state(filter), end, {});
}

// Turns tell a shift of the times to some 0.05 s, and now and then a false one. It is taken where the filter finds the fixes
// likelier by it; the gate is open, so that both see the same fixes.
void PreparedMission::choose_time_offset(const Progress& progress) {
  if (!setup_.unstated.time_offset || setup_.start || setup_.unstated.time_offset_seen_s == 0.0) return;
  constexpr double kCoarse = 0.4;  // s: the state of the offset finds what is nearer
  const estimate::FilterOptions stated = setup_.filter;
  setup_.filter.gate_probability = 0.0;
  const auto log_likelihood_at = [&](double offset) {
    setup_.time_offset_s = mission_->time_offset_s = offset;
    try {
      align(progress);
      run_back_to_first_epoch();
      refine_start(progress);
      return first_minutes(setup_.filter).log_likelihood;
    } catch (const NumericalError&) {
      return -std::numeric_limits<double>::infinity();
    }
  };
  // Between fixes the course is not seen: a neighbouring maximum lies an interval of theirs away.
  const double seen = setup_.unstated.time_offset_seen_s;
  const double interval = (gnss_.fixes.back().t - gnss_.fixes.front().t) / static_cast<double>(gnss_.fixes.size());
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

// The filter with the offset as a state. Where noise is stated too small, its sigma and its gain are as much too good as the
// innovations are too large.
void PreparedMission::test_time_offset() {
  constexpr double kPriorSd = 0.5;  // s
  constexpr double kLeast = 3e-3;   // s: less moves a car by centimetres
  constexpr double kSigmas = 6.0;
  constexpr double kLeastGain = 15.0;  // of the log-likelihood
  double& sd = setup_.filter.auxiliary.time_offset_sd_s;
  if (!setup_.unstated.time_offset || setup_.start || sd > 0.0) return;
  estimate::FilterOptions options = setup_.filter;
  options.gate_probability = 0.0;
  const estimate::FilterResult without = first_minutes(options);
  options.auxiliary.time_offset_sd_s = kPriorSd;
  const estimate::FilterResult with = first_minutes(options);
  const Eigen::Index at = *estimate::ForwardFilter(*mission_, setup_.model, options).layout().time_offset();
  const double excess = std::max(1.0, nis_over_expected(with.innovations));
  const double offset = with.last.x(at);
  const double offset_sd = std::sqrt(excess * with.last.P(at, at));
  const bool shown = std::abs(offset) > std::max(kLeast, kSigmas * offset_sd) &&
                     with.log_likelihood - without.log_likelihood > kLeastGain * excess;
  if (shown || setup_.time_offset_s != 0.0) sd = std::max(0.1, 2.0 * std::abs(offset));
}

void PreparedMission::take_out_velocity_lag() {
  if (!setup_.unstated.time_offset || !setup_.filter.use_gnss_velocity) return;
  velocity_lag_ = velocity_lag(gnss_);
  if (velocity_lag_) advance_velocities(gnss_, *velocity_lag_);
}

// Sigmas of innovations that do not fit say that noise is stated wrongly, whatever the data sheet; so does an IMU whose errors
// the model holds for impossible.
void PreparedMission::test_noise() {
  constexpr double kSmallest = 0.7, kLargest = 1.4;  // of the normalised innovations squared over their expectation
  constexpr double kRefused = 0.05;
  constexpr double kImpossible = 6.0;  // prior sigmas
  constexpr double kShaken = 8.0;      // times the white noise
  constexpr std::size_t kFewest = 100;
  const estimate::NoiseFitChoice& choice = setup_.unstated.noise;
  if (!(choice.gnss_scale || choice.imu_white_noise)) return;
  const Eigen::VectorXd found = start_sensor_errors_;
  const ins::InitialState start = start_;
  refine_start({});
  const estimate::FilterResult seen = first_minutes(setup_.filter);
  const estimate::StateLayout layout = estimate::ForwardFilter(*mission_, setup_.model, setup_.filter).layout();
  const auto worst = largest_sensor_error(layout, seen.last.x);
  start_ = start;
  start_sensor_errors_ = found;
  const auto innovations = static_cast<double>(seen.innovations.size());
  const auto refused = static_cast<double>(std::ranges::count(seen.innovations, false, &estimate::InnovationRecord::used));
  const double ratio = nis_over_expected(seen.innovations);
  // Innovations that are too small are the fixes' stated noise: no IMU noise makes them so.
  const bool fits = (ratio > kSmallest || !choice.gnss_scale) && ratio < kLargest && refused < kRefused * innovations;
  const bool possible = !worst || worst->sigmas < kImpossible;
  if (seen.innovations.size() < kFewest || (fits && possible)) return;
  if (!setup_.noise_fit) setup_.noise_fit = estimate::NoiseFitChoice{false, false, false};
  setup_.noise_fit->gnss_scale |= choice.gnss_scale;
  setup_.noise_fit->correlated_gnss |= choice.correlated_gnss;
  setup_.noise_fit->imu_white_noise |= choice.imu_white_noise;
  noise_ratio_ = ratio;
  if (!choice.imu_white_noise || !has_gain_errors(setup_.model)) return;
  if (vibration_over_white_noise(imu_, setup_.model) < kShaken) return;
  setup_.model = without_gain_errors(setup_.model, imu_.rate_hz);
  start_sensor_errors_.resize(0);  // they were of the other layout
  gain_errors_left_out_ = true;
}

void PreparedMission::note_adaptations() {
  constexpr double kNoted = 1e-3;  // s
  const auto note = [this](const char* kind, std::string text) {
    adaptations_.push_back({record::Event::Severity::kInfo, kind, std::move(text), std::nullopt, 1});
  };
  if (setup_.unstated.time_offset && std::abs(mission_->time_offset_s) > kNoted)
    note(
        "time_offset_found",
        fmt::format("The recording shows a time offset, which the run file does not state: gnss.time_offset_s: {:.4f} is used.",
                    mission_->time_offset_s));
  if (velocity_lag_)
    note("velocity_lag_removed",
         fmt::format("GNSS velocities come {:.2f} s after the positions of the same file; they were moved to them.",
                     *velocity_lag_));
  if (gain_errors_left_out_)
    note("gain_errors_left_out",
         "The IMU shakes far beyond its stated noise: scale factors and misalignments cannot be told from the shaking and are "
         "left "
         "out of the error model (imu.noise: {without_gain_errors: true}).");
  if (!noise_ratio_ || !noise_fit_) return;
  const estimate::NoiseAdjustment& a = noise_fit_->adjustment;
  note("noise_adapted",
       fmt::format(
           "Squared innovations are {:.2g} times what the stated noise predicts. Fitted and used in its place: gyro noise "
           "times {:.3g}, accelerometer noise times {:.3g}, GNSS sigmas times {:.3g} horizontally and {:.3g} vertically "
           "with errors of {:.2g} and {:.2g} m that last {:.2g} s. `noise: stated` keeps what is stated.",
           *noise_ratio_, a.gyro_factor, a.accel_factor, a.gnss_scale.horizontal, a.gnss_scale.vertical,
           a.correlated_gnss.horizontal_m, a.correlated_gnss.vertical_m, a.correlated_gnss.time_s));
}

// Noise comes first: with noise stated far too small neither the gate nor an offset means anything. The second fit starts
// from a start that the first has made good.
void PreparedMission::fit_and_adopt(const Progress& progress) {
  const noise::ImuErrorModel stated_model = setup_.model;
  estimate::FilterOptions stated = setup_.filter;
  setup_.filter.gate_probability = 0.0;
  refine_start(progress);
  const estimate::NoiseAdjustment first = estimate::starting_point(stated, *setup_.noise_fit);
  estimate::NoiseAdjustment from = first;
  const double before_outages = setup_.fit_before ? *setup_.fit_before - start_.nav.t : kFitWindow;
  const double longest = before_outages < kShortestFit ? kFitWindow : std::min(kFitWindow, before_outages);
  for (const bool last : {false, true}) {
    setup_.model = stated_model;
    setup_.filter = stated;
    estimate::NoiseFitChoice choice = *setup_.noise_fit;
    choice.to_the_optimum = last;
    noise_fit_ = fit(choice, from, last ? longest : std::min(kRefineWindow, longest), progress);
    adopt(*noise_fit_);
    // A correlated error that was found to be nothing begins small again: at nothing its gradient vanishes.
    from = noise_fit_->adjustment;
    from.correlated_gnss.horizontal_m = std::max(from.correlated_gnss.horizontal_m, first.correlated_gnss.horizontal_m);
    from.correlated_gnss.vertical_m = std::max(from.correlated_gnss.vertical_m, first.correlated_gnss.vertical_m);
    refine_start(progress);
    if (!last) {
      test_time_offset();  // beside noise that is stated wrongly an offset means nothing
      stated.auxiliary.time_offset_sd_s = setup_.filter.auxiliary.time_offset_sd_s;
    }
    refine_antenna(progress);
  }
}

// The offset enters as velocity times time, which holds for milliseconds, and whatever else compares with fixes wants them
// where they belong: time offset and lever arm take what was found until nothing is.
void PreparedMission::refine_antenna(const Progress& progress) {
  constexpr int kRounds = 5;
  constexpr double kSettledTime = 5e-4;  // s
  constexpr double kSettledArm = 1e-3;   // m
  for (int round = 0; round < kRounds; ++round) {
    if (progress) progress("finding antenna and time offset", static_cast<double>(round) / kRounds);
    const estimate::ForwardFilter filter(*mission_, setup_.model, setup_.filter);
    const estimate::StateLayout& layout = filter.layout();
    if (!layout.time_offset() && !layout.lever_arm()) return;
    estimate::FilterState start = start_state(filter);  // the prior stays where the configuration put it
    if (layout.time_offset()) start.x(*layout.time_offset()) = setup_.time_offset_s - mission_->time_offset_s;
    if (layout.lever_arm()) start.x.segment<3>(*layout.lever_arm()) = setup_.lever_arm_b - mission_->lever_arm_b;
    const Eigen::VectorXd x = filter.run(start, {}).last.x;
    const double time = layout.time_offset() ? x(*layout.time_offset()) : 0.0;
    const Eigen::Vector3d arm = layout.lever_arm() ? x.segment<3>(*layout.lever_arm()).eval() : Eigen::Vector3d::Zero();
    if (std::abs(time) < kSettledTime && arm.norm() < kSettledArm) return;
    mission_->time_offset_s += time;
    mission_->lever_arm_b += arm;
    refine_start(progress);
  }
}

void PreparedMission::find_standstill() {
  mission_ = std::make_unique<estimate::Mission>(estimate::Mission{imu_, gnss_});
  mission_->C_s_b = setup_.C_s_b;
  mission_->lever_arm_b = setup_.lever_arm_b;
  mission_->time_offset_s = setup_.time_offset_s;
  mission_->first_epoch = imu_.samples.front().t - imu_.samples.front().dt;
  for (const ins::StaticPeriod& period : ins::find_static_periods(imu_, &gnss_)) {
    const record::ImuSample& first = imu_.samples[period.first];
    mission_->standstill.push_back({first.t - first.dt, imu_.samples[period.last].t});
  }
}

void PreparedMission::align(const Progress& progress) {
  if (setup_.start) {
    start_ = *setup_.start;
    start_sensor_errors_ = setup_.start_sensor_errors;
    return;
  }
  if (progress) progress("aligning", 0.0);
  double density = 0.0;
  for (int axis = 0; axis < 3; ++axis)
    density = std::max(density, std::sqrt(setup_.model.white_density(noise::Sensor::kGyro, axis).value));
  record::GnssRecording in_imu_time = gnss_;
  for (record::GnssFix& fix : in_imu_time.fixes) fix.t = fix.t - setup_.time_offset_s;
  start_ = align_around_gaps({imu_, in_imu_time, setup_.lever_arm_b, density, largest(setup_.model, noise::Sensor::kGyro),
                              largest(setup_.model, noise::Sensor::kAccel)},
                             setup_.vehicle_forward);
}

estimate::FilterState PreparedMission::start_state(const estimate::ForwardFilter& filter) const {
  estimate::FilterState state =
      filter.initial_state(start_.nav, start_.sd_position_n, start_.sd_velocity_n, start_.sd_attitude_n);
  if (!setup_.start) estimate::tie_position_to_fixes(filter.layout(), state.P);
  // Sensor states come first in every layout of one model; auxiliary states start at zero.
  const Eigen::Index sensors = filter.layout().sensor_end();
  if (start_sensor_errors_.size() == sensors)
    state.x.head(sensors) = start_sensor_errors_;
  else
    set_gyro_bias(filter.layout(), start_.gyro_bias, state);
  if (start_.gyro_bias_sd) know_gyro_bias(filter.layout(), *start_.gyro_bias_sd, state.P);
  return state;
}

// The alignment may have needed motion: from there the filter runs back to where both recordings begin.
void PreparedMission::run_back_to_first_epoch() {
  const geo::GpsTime first = std::max(imu_.samples.front().t, gnss_.fixes.front().t - 5.0);
  if (start_.nav.t - first < 0.5) return;
  record::ImuRecording imu = imu_;
  record::GnssRecording gnss = gnss_;
  std::erase_if(imu.samples, [&](const record::ImuSample& s) { return s.t > start_.nav.t + 1e-6 || s.t < first; });
  std::erase_if(gnss.fixes, [&](const record::GnssFix& f) { return f.t > start_.nav.t; });
  imu.temperature.clear();
  const ReversedRun reversed(*mission_, imu, gnss, start_.nav.t);
  const estimate::ForwardFilter filter(reversed.mission(), setup_.model, setup_.filter);
  const estimate::FilterState at_first =
      reversed.mirrored(filter.run(reversed.mirrored(start_state(filter), filter.layout()), {}).last, filter.layout());
  start_.nav = at_first.nav;
  start_sensor_errors_ = at_first.x.head(filter.layout().sensor_end());
}

// Gauss-Newton on the start: the filter is linearised about a start that the data themselves have corrected. The uncertainty
// stays that of the alignment, so no fix counts twice for more than its linearisation.
void PreparedMission::refine_start(const Progress& progress) {
  if (setup_.start) return;  // what the user gave stays
  constexpr int kRounds = 4;
  geo::GpsTime end = start_.nav.t + kRefineWindow;
  estimate::FilterOptions options = setup_.filter;
  if (setup_.refine_before) {
    end = std::min(end, *setup_.refine_before);
    options.withheld.push_back({*setup_.refine_before, *setup_.refine_before + kRefineWindow});  // the fix at the end too
  }
  const estimate::ForwardFilter filter(*mission_, setup_.model, options);
  for (int round = 0; round < kRounds; ++round) {
    if (progress) progress("refining the start", static_cast<double>(round) / kRounds);
    estimate::KnotStore first;
    estimate::FilterOutputs outputs;
    outputs.knots = &first;
    static_cast<void>(filter.run_until(start_state(filter), end, outputs));
    const estimate::SmoothedKnot knot = estimate::smooth(first, filter.layout()).front();
    const auto change = estimate::error_between(knot.nav, start_.nav);
    start_.nav = knot.nav;
    start_sensor_errors_ = knot.x.head(filter.layout().sensor_end());
    constexpr double kSettled = 1e-8;  // rad; convergence is quadratic
    if (change.segment<3>(estimate::kPsi).norm() < kSettled) break;
  }
}

void PreparedMission::adopt(const estimate::NoiseFit& fit) {
  setup_.model = estimate::adjusted(setup_.model, fit.adjustment);
  setup_.filter = estimate::adjusted(setup_.filter, fit.adjustment);
}

estimate::NoiseFit PreparedMission::fit(const estimate::NoiseFitChoice& choice, const estimate::NoiseAdjustment& from,
                                        double longest_s, const Progress& progress) const {
  record::ImuRecording imu;
  imu.source = imu_.source;
  imu.rate_hz = imu_.rate_hz;
  imu.noise = imu_.noise;
  imu.members = imu_.members;
  const geo::GpsTime end = start_.nav.t + longest_s;
  for (const record::ImuSample& s : imu_.samples)
    if (s.t <= end) imu.samples.push_back(s);
  const estimate::Mission window{imu,
                                 gnss_,
                                 mission_->increments,
                                 mission_->C_s_b,
                                 mission_->lever_arm_b,
                                 mission_->time_offset_s,
                                 mission_->standstill,
                                 mission_->earth_rate,
                                 mission_->first_epoch};
  return estimate::fit_noise(
      window, setup_.model, setup_.filter, choice, from,
      [this](const estimate::ForwardFilter& filter) { return start_state(filter); }, stage(progress, "fitting the noise"));
}

estimate::FilterState PreparedMission::far_end(const estimate::FilterState& last) const {
  const estimate::ForwardFilter filter(*mission_, setup_.model, setup_.filter);
  estimate::FilterState state =
      filter.initial_state(last.nav, start_.sd_position_n, start_.sd_velocity_n, start_.sd_attitude_n);
  if (!setup_.start) estimate::tie_position_to_fixes(filter.layout(), state.P);
  state.x = last.x;
  return state;
}

estimate::FilterState PreparedMission::ignorant_end(const estimate::FilterState& last) const {
  constexpr double kTimes = 10.0;
  const estimate::ForwardFilter filter(*mission_, setup_.model, setup_.filter);
  const estimate::StateLayout& layout = filter.layout();
  estimate::FilterState state = far_end(last);
  state.P.topLeftCorner<estimate::kNav, estimate::kNav>() +=
      kTimes * kTimes * last.P.topLeftCorner<estimate::kNav, estimate::kNav>();
  const auto others = layout.size() - estimate::kNav;
  estimate::BlockTransitions(layout).over(last.nav.t - start_.nav.t).propagate(state.P.bottomRightCorner(others, others));
  state.x.segment(layout.sensor_end(), layout.carrier_slots() - layout.sensor_end()).setZero();
  return state;
}

estimate::FilterState PreparedMission::run_backward(const estimate::FilterOptions& options, const estimate::FilterState& from,
                                                    const std::function<void(const estimate::FilterState&)>& at_knots,
                                                    const Progress& progress) {
  const geo::GpsTime mirror = imu_.samples.back().t;
  ins::reverse(imu_, mirror, mission_->increments);
  ins::reverse(gnss_, mirror);
  const auto filter_back = [&] {
    const ReversedRun reversed(*mission_, imu_, gnss_, mirror, ReversedRun::AlreadyReversed{});
    const estimate::ForwardFilter filter(reversed.mission(), setup_.model, reversed.mirrored(options));
    estimate::FilterOutputs outputs;
    if (at_knots)
      outputs.at_knots = [&](const estimate::FilterState& state) { at_knots(reversed.mirrored(state, filter.layout())); };
    outputs.progress = stage(progress, "filtering backward");
    const geo::GpsTime end = ins::mirrored(start_.nav.t, mirror);
    return reversed.mirrored(filter.run_until(reversed.mirrored(from, filter.layout()), end, outputs).last, filter.layout());
  };
  estimate::FilterState at_start = filter_back();
  ins::reverse(imu_, mirror, mission_->increments);
  ins::reverse(gnss_, mirror);
  return at_start;
}

}  // namespace coast::study
