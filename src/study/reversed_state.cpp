#include "reversed_state.hpp"

#include <algorithm>

#include "restart.hpp"

namespace coast::study {

ReversedRun::ReversedRun(const estimate::Mission& forward, const record::ImuRecording& imu, const record::GnssRecording& gnss,
                         geo::GpsTime mirror, AlreadyReversed)
    : mirror_(mirror),
      mission_{imu,
               gnss,
               forward.increments,
               forward.C_s_b,
               forward.lever_arm_b,
               -forward.time_offset_s,
               {},
               -forward.earth_rate,
               forward.first_epoch} {
  for (const estimate::TimeSpan& span : forward.standstill)
    mission_.standstill.push_back({ins::mirrored(span.to, mirror), ins::mirrored(span.from, mirror)});
  std::ranges::reverse(mission_.standstill);
  mission_.restarts = restarts_at_fixes(imu, gnss, mission_.time_offset_s, mission_.lever_arm_b);
  mission_.aids = estimate::reversed(forward.aids, mirror);
  if (forward.carrier == nullptr) return;
  carrier_ = estimate::reversed(*forward.carrier, mirror);
  mission_.carrier = &*carrier_;
}

estimate::FilterState ReversedRun::mirrored(const estimate::FilterState& state, const estimate::StateLayout& layout) const {
  Eigen::VectorXd sign = Eigen::VectorXd::Ones(layout.size());
  sign.segment<3>(estimate::kVel).setConstant(-1.0);
  for (const auto& block : layout.sensors()) {
    auto own = sign.segment(block.offset, block.size);
    block.process->reversal(own);
    if (block.sensor == noise::Sensor::kGyro && !block.signal_b) own = -own;
  }
  if (layout.time_offset()) sign(*layout.time_offset()) = -1.0;
  estimate::FilterState result;
  result.nav = ins::reversed(state.nav, mirror_);
  result.x = sign.cwiseProduct(state.x);
  result.P = sign.asDiagonal() * state.P * sign.asDiagonal();
  return result;
}

// A span includes its beginning and not its end; in reversed time it would be the opposite.
estimate::FilterOptions ReversedRun::mirrored(estimate::FilterOptions options) const {
  constexpr double kNext = 1e-9;  // s, the resolution of GpsTime
  for (estimate::Withheld& span : options.withheld)
    span = {ins::mirrored(span.to, mirror_) + kNext, ins::mirrored(span.from, mirror_) + kNext, span.satellites_left};
  for (geo::GpsTime& t : options.knots_at) t = ins::mirrored(t, mirror_);
  std::ranges::reverse(options.knots_at);
  return options;
}

}  // namespace coast::study
