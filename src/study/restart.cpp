#include "restart.hpp"

#include <algorithm>

#include "coast/ins/gap.hpp"
#include "coast/record/error.hpp"

namespace coast::study {
namespace {

constexpr double kMinutes = 150.0;    // s that are used
constexpr double kVelocitySd = 30.0;  // m/s, of a vehicle without other information

bool ends_a_gap(const record::ImuRecording& imu, std::size_t i) {
  return imu.samples[i].t - imu.samples[i - 1].t > kLongGap + 1.0 / imu.rate_hz;
}

// Samples after the gap that ends with sample `at`, up to the next gap.
record::ImuRecording stretch_behind(const record::ImuRecording& imu, std::size_t at) {
  record::ImuRecording stretch;
  stretch.source = imu.source;
  stretch.rate_hz = imu.rate_hz;
  stretch.noise = imu.noise;
  const geo::GpsTime end = imu.samples[at].t + kMinutes;
  for (std::size_t i = at + 1; i < imu.samples.size() && imu.samples[i].t < end && !ends_a_gap(imu, i); ++i)
    stretch.samples.push_back(imu.samples[i]);
  return stretch;
}

record::GnssRecording fixes_between(const record::GnssRecording& gnss, geo::GpsTime from, geo::GpsTime to) {
  record::GnssRecording between = gnss;
  std::erase_if(between.fixes, [&](const record::GnssFix& fix) { return fix.t < from || fix.t > to; });
  return between;
}

// The setup of a separate mission in which only the start is to be determined.
Setup plain(const Setup& setup) {
  Setup own = setup;
  own.unstated = {};
  own.start.reset();
  own.start_sensor_errors.resize(0);
  own.restarts.reset();
  own.noise_fit.reset();
  own.batch.reset();
  own.carrier.reset();
  own.refine_before.reset();
  own.high_order_compensation = false;  // the recording is already compensated
  own.filter.auxiliary.time_offset_sd_s = own.filter.auxiliary.lever_arm_sd_m = 0.0;
  own.filter.knots_at.clear();
  return own;
}

std::optional<record::GnssFix> first_fix_behind(const record::GnssRecording& gnss, geo::GpsTime t) {
  const auto found = std::ranges::lower_bound(gnss.fixes, t, {}, &record::GnssFix::t);
  return found == gnss.fixes.end() ? std::nullopt : std::optional(*found);
}

// @param at  the sample that ends the gap
std::optional<estimate::Restart> at_fix(const record::ImuRecording& imu, const record::GnssRecording& gnss,
                                        double time_offset_s, const Eigen::Vector3d& lever_arm_b, std::size_t at) {
  const auto fix = first_fix_behind(gnss, imu.samples[at].t + time_offset_s);
  if (!fix) return std::nullopt;
  estimate::Restart restart;
  restart.nav.t = fix->t - time_offset_s;
  restart.nav.r_eb_e = fix->r_ea_e;
  restart.sd_position_n = fix->position_cov_n.diagonal().cwiseSqrt() + Eigen::Vector3d::Constant(lever_arm_b.norm());
  restart.sd_velocity_n.setConstant(kVelocitySd);
  return restart;
}

// The start of a separate mission, if its heading is better than the one propagated over the gap.
std::optional<estimate::Restart> found_anew(const record::ImuRecording& imu, const record::GnssRecording& gnss,
                                            const Setup& setup, std::size_t at) {
  record::ImuRecording stretch = stretch_behind(imu, at);
  if (stretch.samples.size() < 2) return std::nullopt;
  geo::GpsTime to = stretch.samples.back().t + setup.time_offset_s;
  if (setup.refine_before) to = std::min(to, *setup.refine_before);
  record::GnssRecording fixes = fixes_between(gnss, imu.samples[at].t + setup.time_offset_s, to);
  try {
    const PreparedMission behind(std::move(stretch), std::move(fixes), plain(setup), {});
    const ins::InitialState& start = behind.start();
    const double gap = imu.samples[at].t - imu.samples[at - 1].t;
    if (start.sd_attitude_n.z() < ins::kGapRateSd * gap)
      return estimate::Restart{start.nav, start.sd_position_n, start.sd_velocity_n, start.sd_attitude_n};
  } catch (const NumericalError&) {  // too little motion
  } catch (const InputError&) {      // too few samples or fixes
  }
  return std::nullopt;
}

}  // namespace

std::vector<estimate::Restart> restarts_at_fixes(const record::ImuRecording& imu, const record::GnssRecording& gnss,
                                                 double time_offset_s, const Eigen::Vector3d& lever_arm_b) {
  std::vector<estimate::Restart> restarts;
  for (std::size_t i = 1; i < imu.samples.size(); ++i)
    if (ends_a_gap(imu, i))
      if (const auto restart = at_fix(imu, gnss, time_offset_s, lever_arm_b, i)) restarts.push_back(*restart);
  return restarts;
}

std::vector<estimate::Restart> restarts_behind_gaps(const record::ImuRecording& imu, const record::GnssRecording& gnss,
                                                    const Setup& setup) {
  std::vector<estimate::Restart> restarts;
  for (std::size_t i = 1; i < imu.samples.size(); ++i) {
    if (!ends_a_gap(imu, i)) continue;
    // Position first: the start may be after the first fixes, which the filter would not survive with a lost position.
    const auto fix = at_fix(imu, gnss, setup.time_offset_s, setup.lever_arm_b, i);
    const auto anew = found_anew(imu, gnss, setup, i);
    if (fix && (!anew || fix->nav.t < anew->nav.t)) restarts.push_back(*fix);
    if (anew) restarts.push_back(*anew);
  }
  return restarts;
}

}  // namespace coast::study
