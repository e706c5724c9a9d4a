#include "coast/study/mission.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "coast/ins/compensation.hpp"
#include "coast/record/error.hpp"
#include "reversed_state.hpp"

namespace coast::study {

namespace {

constexpr double kRefineWindow = 300.0;  // s that the start is refined over
constexpr double kFitWindow = 1200.0;    // s that noise is fitted over
constexpr double kShortestFit = 100.0;   // s: fewer say too little of correlated errors

std::function<void(double)> stage(const Progress& progress, const char* what) {
  if (!progress) return {};
  return [&progress, what](double fraction) { progress(what, fraction); };
}

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

// A bias known in body axes becomes the state of the additive process with the largest prior on each axis, less what other
// states are known to be. Of a synthetic IMU every member has such a state, and each takes what its prior and its weight say.
void set_gyro_bias(const estimate::StateLayout& layout, Eigen::Vector3d bias_b, estimate::FilterState& state) {
  using Block = estimate::StateLayout::SensorBlock;
  const std::size_t members = std::max<std::size_t>(1, layout.members().size());
  std::vector<std::vector<const Block*>> widest(3, std::vector<const Block*>(members, nullptr));
  const auto prior = [&](const Block* block) { return state.P(block->offset, block->offset); };
  for (const Block& block : layout.sensors()) {
    if (block.sensor != noise::Sensor::kGyro || block.signal_b) continue;
    bias_b -= block.output.dot(state.x.segment(block.offset, block.size)) * block.response_b;
    if (block.size != 1) continue;
    Eigen::Index axis = 0;
    block.response_b.cwiseAbs().maxCoeff(&axis);
    const Block*& slot = widest[static_cast<std::size_t>(axis)][block.member.value_or(0)];
    if (slot == nullptr || prior(&block) > prior(slot)) slot = &block;
  }
  for (const std::vector<const Block*>& axis : widest) {
    double variance = 0.0;  // of the sum of the states' outputs
    for (const Block* block : axis)
      if (block != nullptr) variance += block->output(0) * block->output(0) * prior(block);
    if (!(variance > 0.0)) continue;
    for (const Block* block : axis)
      if (block != nullptr) state.x(block->offset) = prior(block) * block->output(0) / variance * block->response_b.dot(bias_b);
  }
}

// A bias seen standing still is known far better than a turn-on bias. At its prior, the heading of a consumer IMU (1 deg/s)
// would be unknown before it first moves, and no filter linear in the attitude finds it again.
void know_gyro_bias(const estimate::StateLayout& layout, double sd, Eigen::MatrixXd& P) {
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(3, layout.size());
  for (const estimate::StateLayout::SensorBlock& block : layout.sensors())
    if (block.sensor == noise::Sensor::kGyro && !block.signal_b)
      H.middleCols(block.offset, block.size) += block.response_b * block.output;
  const Eigen::MatrixXd PHt = P * H.transpose();
  const Eigen::Matrix3d S = H * PHt + sd * sd * Eigen::Matrix3d::Identity();
  P -= PHt * S.llt().solve(PHt.transpose());
  P = 0.5 * (P + P.transpose()).eval();
}

}  // namespace

PreparedMission::PreparedMission(record::ImuRecording imu, record::GnssRecording gnss, Setup setup, const Progress& progress)
    : imu_(std::move(imu)), gnss_(std::move(gnss)), setup_(std::move(setup)) {
  check_overlap(imu_, gnss_);
  find_standstill();
  align(progress);
  if (setup_.high_order_compensation) {
    ins::compensate_chebyshev(imu_);
    mission_->increments = ins::IncrementKind::kCompensated;
  }
  if (!setup_.start) run_back_to_first_epoch();
  if (setup_.noise_fit) {
    fit_and_adopt(progress);
  } else {
    refine_start(progress);
    refine_antenna(progress);
  }
  mission_->carrier = setup_.carrier.get();
}

// Noise comes first: with noise stated far too small neither the gate nor an offset means anything. The second fit starts
// from a start that the first has made good.
void PreparedMission::fit_and_adopt(const Progress& progress) {
  const noise::ImuErrorModel stated_model = setup_.model;
  const estimate::FilterOptions stated = setup_.filter;
  setup_.filter.gate_probability = 0.0;
  refine_start(progress);
  const estimate::NoiseAdjustment first = estimate::starting_point(stated, *setup_.noise_fit);
  estimate::NoiseAdjustment from = first;
  const double before_outages = setup_.refine_before ? *setup_.refine_before - start_.nav.t : kFitWindow;
  const double longest = before_outages < kShortestFit ? kFitWindow : std::min(kFitWindow, before_outages);
  for (const double window : {std::min(kRefineWindow, longest), longest}) {
    setup_.model = stated_model;
    setup_.filter = stated;
    noise_fit_ = fit(*setup_.noise_fit, from, window, progress);
    adopt(*noise_fit_);
    // A correlated error that was found to be nothing begins small again: at nothing its gradient vanishes.
    from = noise_fit_->adjustment;
    from.correlated_gnss.horizontal_m = std::max(from.correlated_gnss.horizontal_m, first.correlated_gnss.horizontal_m);
    from.correlated_gnss.vertical_m = std::max(from.correlated_gnss.vertical_m, first.correlated_gnss.vertical_m);
    refine_start(progress);
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
    return;
  }
  if (progress) progress("aligning", 0.0);
  double density = 0.0;
  for (int axis = 0; axis < 3; ++axis)
    density = std::max(density, std::sqrt(setup_.model.white_density(noise::Sensor::kGyro, axis).value));
  start_ = ins::align({imu_, gnss_, setup_.lever_arm_b, density, largest(setup_.model, noise::Sensor::kGyro),
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

namespace {

/// What the batch solution has to say beside its states.
void note_batch(const estimate::BatchSolution& batch, const std::vector<estimate::KnotMeasurement>& measurements,
                record::Events& events) {
  constexpr double kDoubted = 0.5;
  const auto end = batch.smoothed.back().nav.t;
  std::size_t doubted = 0;
  for (std::size_t i = 0; i < batch.weights.size(); ++i)
    if (measurements[i].what.kind == estimate::UpdateKind::kGnssPosition && batch.weights[i] < kDoubted) ++doubted;
  events.push_back(
      {record::Event::Severity::kInfo, "batch",
       fmt::format("batch solution after {} iterations; {} GNSS positions left out or at less than half their weight",
                   batch.report.cost.size(), doubted),
       end, 1});
  constexpr double kTolerable = 0.01;
  if (batch.report.rounding() > kTolerable)
    events.push_back(
        {record::Event::Severity::kWarning, "batch_ill_conditioned",
         fmt::format("the normal equations of the batch have the condition number {:.0e}: its states are off by some {:.2g} of "
                     "their sigmas and these by as much of themselves; take `smoother: rts`, which does not need them",
                     batch.report.condition, batch.report.rounding()),
         end, 1});
  if (!batch.report.converged)
    events.push_back({record::Event::Severity::kWarning, "batch_not_converged",
                      "the batch solution has not come to rest: do not trust it where it differs from `smoother: rts`", end,
                      1});
}

// The solution is about the lever arm and the time offset that the preparation found; people ask what is wrong with theirs.
void tell_against_configuration(const PreparedMission& mission, std::vector<estimate::MissionUnknown>& unknowns) {
  const Eigen::Vector3d moved = mission.mission().lever_arm_b - mission.setup().lever_arm_b;
  const std::array<const char*, 3> components{"lever_arm forward", "lever_arm right", "lever_arm down"};
  for (estimate::MissionUnknown& unknown : unknowns) {
    for (std::size_t i = 0; i < 3; ++i)
      if (unknown.name == components[i]) unknown.estimate += moved(static_cast<Eigen::Index>(i));
    if (unknown.name == "gnss_time_offset") unknown.estimate += mission.mission().time_offset_s - mission.setup().time_offset_s;
  }
}

std::vector<estimate::SmoothedKnot> smoothed(const PreparedMission& mission, const estimate::FilterOptions& options,
                                             const estimate::FilterState& start,
                                             const std::vector<estimate::KnotMeasurement>& measurements,
                                             const SolutionOutputs& outputs, const Progress& progress,
                                             const estimate::BackwardKnots* backward, Solution& solution) {
  const estimate::StateLayout& layout = solution.filter->layout();
  if (backward != nullptr) {
    estimate::Combination both =
        estimate::combine(solution.knots, *backward, layout, stage(progress, "combining forward and backward"));
    std::ranges::move(both.events, std::back_inserter(solution.forward.events));
    return std::move(both.knots);
  }
  if (!mission.setup().batch)
    return estimate::smooth(solution.knots, layout, stage(progress, "smoothing backward"), outputs.states);
  estimate::BatchSolution batch =
      estimate::smooth_batch(mission.mission(), layout, options, start, solution.knots, measurements, *mission.setup().batch,
                             stage(progress, "solving the batch"), outputs.states);
  note_batch(batch, measurements, solution.forward.events);
  solution.batch = std::move(batch.report);
  tell_against_configuration(mission, solution.batch->unknowns);
  return std::move(batch.smoothed);
}

}  // namespace

Solution solve(const PreparedMission& mission, const estimate::FilterOptions& options, bool smooth,
               const SolutionOutputs& outputs, const Progress& progress, const std::optional<estimate::FilterState>& carried,
               const estimate::BackwardKnots* backward) {
  if (carried && backward != nullptr) throw std::invalid_argument("solve: a combined solution of more than one pass");
  Solution solution;
  solution.filter = std::make_unique<estimate::ForwardFilter>(mission.mission(), mission.model(), options);
  const estimate::FilterState start = mission.start_state(*solution.filter);
  std::vector<estimate::KnotMeasurement> measurements;
  estimate::FilterOutputs for_smoother;
  for_smoother.knots = &solution.knots;
  if (mission.setup().batch)
    for_smoother.measurements = [&](const estimate::Measurement& what, bool used) {
      measurements.push_back({solution.knots.size(), what, used});
    };
  estimate::FilterOutputs filter_outputs;
  if (smooth && !carried) filter_outputs = for_smoother;
  filter_outputs.epochs = outputs.forward;
  filter_outputs.at_knots = outputs.at_knots;
  filter_outputs.progress = stage(progress, "filtering forward");
  solution.forward = solution.filter->run(carried.value_or(start), filter_outputs);
  if (!smooth) return solution;
  const estimate::FilterState smoothed_start = carried ? estimate::FilterState{carried->nav, carried->x, start.P} : start;
  if (carried) {
    for_smoother.progress = stage(progress, "filtering forward for the smoother");
    static_cast<void>(solution.filter->run(smoothed_start, for_smoother));
  }
  solution.smoothed = smoothed(mission, options, smoothed_start, measurements, outputs, progress, backward, solution);
  if (outputs.smoothed)
    estimate::emit_smoothed(mission.mission(), solution.filter->layout(), solution.knots, solution.smoothed, outputs.smoothed,
                            stage(progress, "writing the smoothed trajectory"));
  return solution;
}

estimate::BackwardKnots backward_knots(PreparedMission& mission, const estimate::FilterOptions& options,
                                       const estimate::KnotSampling& states, const Progress& progress) {
  const estimate::ForwardFilter filter(mission.mission(), mission.model(), options);
  estimate::FilterOptions same_knots = options;
  estimate::FilterOutputs outputs;
  outputs.at_knots = [&](const estimate::FilterState& state) { same_knots.knots_at.push_back(state.nav.t); };
  outputs.progress = stage(progress, "filtering forward");
  const estimate::FilterState begin = mission.ignorant_end(filter.run(mission.start_state(filter), outputs).last);
  estimate::BackwardKnots knots(filter.layout(), same_knots.knots_at, begin, states);
  static_cast<void>(mission.run_backward(
      same_knots, begin, [&](const estimate::FilterState& state) { knots.add(state); }, progress));
  return knots;
}

estimate::FilterState carried_start(PreparedMission& mission, const estimate::FilterOptions& options, int passes,
                                    const Progress& progress) {
  const estimate::ForwardFilter filter(mission.mission(), mission.model(), options);
  estimate::FilterState state = mission.start_state(filter);
  estimate::FilterOutputs outputs;
  outputs.progress = stage(progress, "filtering forward");
  for (int done = 1; done < passes; done += 2)
    state = mission.run_backward(options, filter.run(state, outputs).last, {}, progress);
  return state;
}

LeverArmCheck check_lever_arm(const PreparedMission& mission, double prior_sd_m, const Progress& progress) {
  estimate::FilterOptions options = mission.options();
  options.auxiliary.lever_arm_sd_m = prior_sd_m;
  estimate::ForwardFilter filter(mission.mission(), mission.model(), options);
  estimate::FilterOutputs outputs;
  outputs.progress = stage(progress, "checking the lever arm");
  const estimate::FilterState last = filter.run(mission.start_state(filter), outputs).last;
  const Eigen::Index at = *filter.layout().lever_arm();
  const Eigen::Vector3d moved = mission.mission().lever_arm_b - mission.setup().lever_arm_b;  // by the estimate so far
  return {moved + last.x.segment<3>(at), last.P.diagonal().segment<3>(at).cwiseSqrt()};
}

}  // namespace coast::study
