// Antenna position and time: lever arm and time offset, tested if the configuration leaves them to the data, and
// refined.

#include <algorithm>
#include <cmath>
#include <limits>

#include "coast/study/mission.hpp"
#include "coast/study/plausibility.hpp"

namespace coast::study {

namespace {

constexpr double kWideTime = 0.5;  // s: turns leave an uncertainty of a fifth of a second
constexpr double kWideArm = 1.0;   // m: a car's arm with wrong signs is wrong by two of these
constexpr double kFixes = 300.0;   // at least: with fewer turns between fixes far apart neither is observable

}  // namespace

AntennaChoice PreparedMission::antenna_to_test() const {
  if (setup_.start) return {};
  const estimate::AuxiliaryStates& stated = setup_.filter.auxiliary;
  return {.time_offset = setup_.unstated.time_offset && stated.time_offset_sd_s == 0.0,
          .lever_arm = setup_.unstated.lever_arm && stated.lever_arm_sd_m == 0.0};
}

bool PreparedMission::antenna_is_estimated() const {
  const estimate::AuxiliaryStates& now = setup_.filter.auxiliary;
  return now.time_offset_sd_s > 0.0 || now.lever_arm_sd_m > 0.0;
}

void PreparedMission::free_antenna() {
  if (tested_.time_offset) setup_.filter.auxiliary.time_offset_sd_s = kWideTime;
  if (tested_.lever_arm) setup_.filter.auxiliary.lever_arm_sd_m = kWideArm;
}

// The prior remains that of the configuration, wherever the filter is linearised.
estimate::FilterState PreparedMission::antenna_as_stated(estimate::FilterState state,
                                                         const estimate::StateLayout& layout) const {
  if (layout.time_offset()) state.x(*layout.time_offset()) = setup_.time_offset_s - mission_->time_offset_s;
  if (layout.lever_arm()) state.x.segment<3>(*layout.lever_arm()) = setup_.lever_arm_b - mission_->lever_arm_b;
  return state;
}

// The gate is open, so that every candidate uses the same fixes.
AntennaFit PreparedMission::fit_antenna(AntennaChoice estimated) {
  const double time = mission_->time_offset_s;
  const Eigen::Vector3d arm = mission_->lever_arm_b;
  estimate::FilterOptions options = setup_.filter;
  options.gate_probability = 0.0;
  if (tested_.time_offset) {
    options.auxiliary.time_offset_sd_s = estimated.time_offset ? kWideTime : 0.0;
    if (!estimated.time_offset) mission_->time_offset_s = setup_.time_offset_s;
  }
  if (tested_.lever_arm) {
    options.auxiliary.lever_arm_sd_m = estimated.lever_arm ? kWideArm : 0.0;
    if (!estimated.lever_arm) mission_->lever_arm_b = setup_.lever_arm_b;
  }
  const double seconds = std::max(kFirstMinutes, kFixes * fix_interval_s());
  const estimate::FilterResult run = first_seconds(seconds, options);
  const estimate::StateLayout layout = estimate::ForwardFilter(*mission_, setup_.model, options).layout();
  AntennaFit fit{.log_likelihood = run.log_likelihood, .excess = std::max(1.0, nis_over_expected(run.innovations))};
  if (estimated.time_offset) {
    const Eigen::Index at = *layout.time_offset();
    fit.time_offset_s = mission_->time_offset_s - setup_.time_offset_s + run.last.x(at);
    fit.time_offset_sd_s = std::sqrt(fit.excess * run.last.P(at, at));
  }
  if (estimated.lever_arm) {
    const Eigen::Index at = *layout.lever_arm();
    fit.lever_arm_m = mission_->lever_arm_b - setup_.lever_arm_b + run.last.x.segment<3>(at);
    fit.lever_arm_sd_m = (fit.excess * run.last.P.diagonal().segment<3>(at)).cwiseSqrt();
  }
  mission_->time_offset_s = time;
  mission_->lever_arm_b = arm;
  return fit;
}

// Each is estimated, together with the other, if it is many sigmas from the stated value and makes the fixes much likelier. At
// constant speed the two cannot be separated, and neither is significant with the other: then each is tested alone. If noise is
// stated too small, sigma and gain are too good by the same factor as the innovations are too large.
void PreparedMission::test_antenna() {
  constexpr double kSigmas = 6.0;
  constexpr double kLeastGain = 15.0;  // of the log-likelihood
  constexpr double kLeastTime = 3e-3;  // s: less moves a car by centimetres
  constexpr double kLeastArm = 0.03;   // m
  // Of a difference: above it there is another error, which neither must hide.
  constexpr double kLargestTime = 1.5;  // s: larger offsets are found by turns
  constexpr double kLargestArm = 3.0;   // m: a car's arm with wrong signs is wrong by two
  if (!tested_.time_offset && !tested_.lever_arm) return;
  const auto late = [&](const AntennaFit& fit) {
    return std::abs(fit.time_offset_s) > std::max(kLeastTime, kSigmas * fit.time_offset_sd_s);
  };
  const auto elsewhere = [&](const AntennaFit& fit) {
    return (fit.lever_arm_m.array().abs() > (kSigmas * fit.lever_arm_sd_m.array()).max(kLeastArm)).any();
  };
  const auto likelier = [&](const AntennaFit& with, const AntennaFit& without) {
    return with.log_likelihood - without.log_likelihood > kLeastGain * with.excess;
  };
  AntennaFit found = fit_antenna(tested_);
  const bool no_arm = found.lever_arm_m.lpNorm<Eigen::Infinity>() > kLargestArm;
  const bool no_time = std::abs(found.time_offset_s) > kLargestTime;
  if (no_arm || no_time) {
    keep_as_stated({.time_offset = no_time, .lever_arm = no_arm});
    found = fit_antenna(tested_);
  }
  const AntennaFit time_alone = tested_.lever_arm ? fit_antenna({tested_.time_offset, false}) : found;
  const AntennaFit arm_alone = tested_.time_offset ? fit_antenna({false, tested_.lever_arm}) : found;
  const AntennaFit neither = fit_antenna({false, false});
  AntennaChoice shown{
      .time_offset = tested_.time_offset && late(found) && likelier(found, tested_.lever_arm ? arm_alone : neither),
      .lever_arm = tested_.lever_arm && elsewhere(found) && likelier(found, tested_.time_offset ? time_alone : neither)};
  if (!shown.time_offset && !shown.lever_arm && tested_.time_offset && tested_.lever_arm) {
    const bool time_first = time_alone.log_likelihood >= arm_alone.log_likelihood;
    shown.time_offset = time_first && late(time_alone) && likelier(time_alone, neither);
    shown.lever_arm = !time_first && elsewhere(arm_alone) && likelier(arm_alone, neither);
    found = time_first ? time_alone : arm_alone;
  }
  take_antenna(shown, found);
}

void PreparedMission::keep_as_stated(AntennaChoice which) {
  if (which.time_offset) {
    tested_.time_offset = false;
    mission_->time_offset_s = setup_.time_offset_s;
    setup_.filter.auxiliary.time_offset_sd_s = 0.0;
  }
  if (which.lever_arm) {
    tested_.lever_arm = false;
    mission_->lever_arm_b = setup_.lever_arm_b;
    setup_.filter.auxiliary.lever_arm_sd_m = 0.0;
  }
}

void PreparedMission::take_antenna(AntennaChoice shown, const AntennaFit& found) {
  constexpr double kSdTime = 0.1,
                   kSdArm = 0.1;  // s, m: at least; twice the estimate, so that the prior does not restrict it
  estimate::AuxiliaryStates& auxiliary = setup_.filter.auxiliary;
  if (tested_.time_offset) {
    const bool taken = shown.time_offset || setup_.time_offset_s != 0.0;
    auxiliary.time_offset_sd_s = taken ? std::max(kSdTime, 2.0 * std::abs(found.time_offset_s)) : 0.0;
    if (!taken) mission_->time_offset_s = setup_.time_offset_s;
  }
  if (tested_.lever_arm) {
    auxiliary.lever_arm_sd_m = shown.lever_arm ? std::max(kSdArm, 2.0 * found.lever_arm_m.lpNorm<Eigen::Infinity>()) : 0.0;
    lever_arm_sd_ = found.lever_arm_sd_m;
    if (!shown.lever_arm) mission_->lever_arm_b = setup_.lever_arm_b;
  }
}

// The effect of the offset is velocity times time, valid for milliseconds, and other comparisons with fixes need correct
// values: time offset and lever arm are corrected by the estimates until these vanish. If the steps grow there is no
// convergence: the values to be estimated then remain as stated.
void PreparedMission::refine_antenna(const Progress& progress) {
  constexpr int kRounds = 5;
  constexpr double kSettledTime = 5e-4;  // s
  constexpr double kSettledArm = 1e-3;   // m
  constexpr double kSmall = 0.1;         // of a wide prior: below it noise makes steps grow
  const double first_time = mission_->time_offset_s;
  const Eigen::Vector3d first_arm = mission_->lever_arm_b;
  double before = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kRounds; ++round) {
    if (!antenna_is_estimated()) return;
    if (progress) progress("finding antenna and time offset", static_cast<double>(round) / kRounds);
    const estimate::ForwardFilter filter(*mission_, setup_.model, setup_.filter);
    const estimate::StateLayout& layout = filter.layout();
    const Eigen::VectorXd x = filter.run(antenna_as_stated(start_state(filter), layout), {}).last.x;
    const double time = layout.time_offset() ? x(*layout.time_offset()) : 0.0;
    const Eigen::Vector3d arm = layout.lever_arm() ? x.segment<3>(*layout.lever_arm()).eval() : Eigen::Vector3d::Zero();
    if (std::abs(time) < kSettledTime && arm.norm() < kSettledArm) return;
    const double size = std::max(std::abs(time) / kWideTime, arm.norm() / kWideArm);
    if (size > kSmall && size > before) {
      mission_->time_offset_s = first_time;
      mission_->lever_arm_b = first_arm;
      keep_as_stated(tested_);
      refine_start(progress);
      return;
    }
    before = size;
    mission_->time_offset_s += time;
    mission_->lever_arm_b += arm;
    refine_start(progress);
  }
}

}  // namespace coast::study
