#include "coast/study/mission.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "coast/ins/compensation.hpp"
#include "coast/record/error.hpp"
#include "gross_errors.hpp"
#include "gyro_start.hpp"
#include "restart.hpp"
#include "reversed_state.hpp"
#include "stage.hpp"

namespace coast::study {

namespace {

constexpr double kFitWindow = 1200.0;   // s of data for the fit of noise
constexpr double kShortestFit = 100.0;  // s: less has too little information on correlated errors

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

// For `vehicle: car`: the assumption used for the heading holds for the whole mission.
void drive_like_a_car(estimate::FilterOptions& filter) {
  filter.vehicle.non_holonomic = estimate::NonHolonomic{};
  filter.vehicle.zero_velocity_sd_mps = kCarZeroVelocitySd;
  filter.auxiliary.mounting_sd = 5.0 * geo::kDegree;
}

// If there is an IMU gap between the first epoch and the motion that determines the heading, the alignment begins after it.
ins::InitialState align_around_gaps(const ins::AlignmentInput& input, bool vehicle_forward) {
  const auto long_gap = [](const record::ImuSample& sample) { return sample.dt > kLongGap; };
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
  return ins::align(input, vehicle_forward);  // reports the cause
}

}  // namespace

PreparedMission::PreparedMission(record::ImuRecording imu, record::GnssRecording gnss, Setup setup, const Progress& progress)
    : imu_(std::move(imu)),
      gnss_(std::move(gnss)),
      setup_(std::move(setup)),
      heading_hold_sd_(std::exchange(setup_.filter.vehicle.heading_hold_sd, std::nullopt)) {
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
  restart_behind_gaps();
  tested_ = antenna_to_test();
  test_antenna();
  if (antenna_is_estimated()) {
    refine_start(progress);
    refine_antenna(progress);
  }
  test_noise();
  if (setup_.noise_fit) {
    fit_and_adopt(progress);
  } else if (!setup_.start) {  // with a better start the antenna's steps may converge that did not before
    refine_start(progress);
    refine_antenna(progress);
  }
  restart_behind_gaps();
  note_adaptations();
  first_knots_ = estimate::KnotStore();
  mission_->carrier = setup_.carrier.get();
  take_aids();
}

// Only a few constants are found from the fixes, among them those that a studied outage withholds later.
void PreparedMission::take_aids() {
  setup_.filter.vehicle.heading_hold_sd = heading_hold_sd_;
  if (setup_.aids.empty()) return;
  record::GnssRecording valid = gnss_;
  for (record::GnssFix& fix : valid.fixes) fix.t = fix.t - mission_->time_offset_s;
  for (const AidSource& source : setup_.aids) {
    std::vector<record::AidSample> samples = source.aid->samples(source.rows, valid, adaptations_);
    std::erase_if(samples, [this](const record::AidSample& sample) {
      return sample.t <= start_.nav.t || imu_.samples.back().t < sample.t;
    });
    if (samples.empty())
      throw InputError({source.rows.source, 0,
                        fmt::format("no sample of the {} that can be used between {} and {}", source.name,
                                    geo::to_string(start_.nav.t), geo::to_string(imu_.samples.back().t)),
                        "samples within the mission", "Check gps_week and the time scale (GPS or UTC) of the file."});
    mission_->aids.push_back(
        {source.name, source.aid, std::make_shared<const std::vector<record::AidSample>>(std::move(samples))});
  }
}

// Noise comes first: with noise stated far too small neither the gate nor an offset is meaningful. The second fit uses
// a start improved with the first one.
void PreparedMission::fit_and_adopt(const Progress& progress) {
  const noise::ImuErrorModel stated_model = setup_.model;
  free_antenna();  // its errors must not be attributed to noise
  estimate::FilterOptions stated = setup_.filter;
  setup_.filter.gate_probability = 0.0;
  refine_start(progress);
  const estimate::NoiseAdjustment first = estimate::starting_point(stated, *setup_.noise_fit);
  estimate::NoiseAdjustment from = first;
  const double before_outages = setup_.fit_before ? *setup_.fit_before - start_.nav.t : kFitWindow;
  const double longest = before_outages < kShortestFit ? kFitWindow : std::min(kFitWindow, before_outages);
  for (const bool last : {false, true}) {
    setup_.model = with_drift_scaled(stated_model, imu_.rate_hz, drift_);
    setup_.filter = stated;
    estimate::NoiseFitChoice choice = *setup_.noise_fit;
    choice.precision = last ? estimate::FitPrecision::kOptimum : estimate::FitPrecision::kPreliminary;
    noise_fit_ = fit(choice, from, last ? longest : std::min(kFirstMinutes, longest), progress);
    adopt(*noise_fit_);
    // A correlated error estimated as zero starts with a small value again: at zero its gradient vanishes.
    from = noise_fit_->adjustment;
    from.correlated_gnss.horizontal_m = std::max(from.correlated_gnss.horizontal_m, first.correlated_gnss.horizontal_m);
    from.correlated_gnss.vertical_m = std::max(from.correlated_gnss.vertical_m, first.correlated_gnss.vertical_m);
    refine_start(progress);
    adapt_drift();
    refine_antenna(progress);
    if (last) break;
    test_antenna();  // with wrongly stated noise an offset is meaningless
    stated.auxiliary.time_offset_sd_s = setup_.filter.auxiliary.time_offset_sd_s;
    stated.auxiliary.lever_arm_sd_m = setup_.filter.auxiliary.lever_arm_sd_m;
  }
}

void PreparedMission::find_standstill() {
  mission_ = std::make_unique<estimate::Mission>(estimate::Mission{imu_, gnss_});
  mission_->C_s_b = setup_.C_s_b;
  const AntennaPlace antenna = setup_.antenna_found.value_or(AntennaPlace{setup_.time_offset_s, setup_.lever_arm_b});
  mission_->lever_arm_b = antenna.lever_arm_b;
  mission_->time_offset_s = antenna.time_offset_s;
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
  const ins::AlignmentInput input{imu_,
                                  in_imu_time,
                                  setup_.lever_arm_b,
                                  density,
                                  largest(setup_.model, noise::Sensor::kGyro),
                                  largest(setup_.model, noise::Sensor::kAccel)};
  heading_assumed_ = false;
  try {
    start_ = align_around_gaps(input, setup_.vehicle_forward);
  } catch (const NumericalError&) {
    if (setup_.vehicle_forward || !setup_.unstated.time_offset) throw;
    const std::exception_ptr without_assumption = std::current_exception();
    try {
      start_ = align_around_gaps(input, true);
      heading_assumed_ = true;
      drive_like_a_car(setup_.filter);
      heading_hold_sd_ = kCarHeadingHoldSd;
    } catch (const NumericalError&) {
      std::rethrow_exception(without_assumption);
    }
  }
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

// The alignment may have needed motion: from there the filter runs back to the beginning of both recordings.
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

double PreparedMission::fix_interval_s() const {
  return (gnss_.fixes.back().t - gnss_.fixes.front().t) / static_cast<double>(gnss_.fixes.size());
}

estimate::FilterResult PreparedMission::first_seconds(double seconds, const estimate::FilterOptions& options,
                                                      const estimate::FilterOutputs& outputs) const {
  const estimate::ForwardFilter filter(*mission_, setup_.model, options);
  return filter.run_until(antenna_as_stated(start_state(filter), filter.layout()), start_.nav.t + seconds, outputs);
}

// Gauss-Newton on the start: the filter is linearised about a start corrected by the data. The uncertainty
// remains that of the alignment, so no fix is used twice except for its linearisation.
void PreparedMission::refine_start(const Progress& progress) {
  if (setup_.start) return;  // a start given by the user is kept
  const estimate::ForwardFilter filter(*mission_, setup_.model, setup_.filter);
  estimate::FilterOptions options = setup_.filter;
  double seconds = kFirstMinutes;
  if (const auto& before = setup_.refine_before) {
    options.withheld.push_back({*before, *before + kFirstMinutes});  // a fix at the end too
    seconds = std::min(seconds, *before - start_.nav.t);
  }
  for (int round = 0; round < setup_.start_rounds; ++round) {
    if (progress) progress("refining the start", static_cast<double>(round) / setup_.start_rounds);
    first_knots_.clear();
    estimate::FilterOutputs outputs;
    outputs.knots = &first_knots_;
    static_cast<void>(first_seconds(seconds, options, outputs));
    const estimate::SmoothedKnot knot = estimate::smooth_first(first_knots_, filter.layout());
    const auto change = estimate::error_between(knot.nav, start_.nav);
    start_.nav = knot.nav;
    start_sensor_errors_ = knot.x.head(filter.layout().sensor_end());
    constexpr double kSettled = 1e-8;  // rad; convergence is quadratic
    if (change.segment<3>(estimate::kPsi).norm() < kSettled) break;
  }
}

void PreparedMission::restart_behind_gaps() {
  if (setup_.restarts) {
    mission_->restarts = *setup_.restarts;
    return;
  }
  Setup found = setup_;
  found.time_offset_s = mission_->time_offset_s;
  found.lever_arm_b = mission_->lever_arm_b;
  mission_->restarts = restarts_behind_gaps(imu_, gnss_, found);
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
                                 mission_->first_epoch,
                                 nullptr,
                                 mission_->restarts};
  estimate::FilterOptions options = setup_.filter;
  options.vehicle.heading_hold_sd.reset();  // its dependence on the gyros' noise is not in the gradient of the fit
  return estimate::fit_noise(
      window, setup_.model, options, choice, from,
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
