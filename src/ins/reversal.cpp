#include "coast/ins/reversal.hpp"

#include <algorithm>

#include "coast/geo/rotation.hpp"

namespace coast::ins {

namespace {

void reverse(record::MemberBlocks& members, geo::GpsTime mirror) {
  for (record::MemberBlocks::Block& block : members.blocks) {
    const geo::GpsTime to = mirrored(block.from, mirror);
    block.from = mirrored(block.to, mirror);
    block.to = to;
    for (auto& means : block.means)
      if (means) means->gyro = -means->gyro;
  }
  std::reverse(members.blocks.begin(), members.blocks.end());
}

}  // namespace

BodyIncrement reversed(const BodyIncrement& increment) {
  return {increment.dt, -increment.phi, geo::rotation_matrix(-increment.phi) * increment.u};
}

record::NavState reversed(const record::NavState& state, geo::GpsTime mirror) {
  return {mirrored(state.t, mirror), state.r_eb_e, -state.v_eb_e, state.q_b_e};
}

void reverse(record::ImuRecording& recording, geo::GpsTime mirror, IncrementKind kind) {
  for (record::ImuSample& sample : recording.samples) {
    sample.t = mirrored(sample.t - sample.dt, mirror);
    if (kind == IncrementKind::kCompensated) sample.dv = geo::rotation_matrix(-sample.dtheta) * sample.dv;
    sample.dtheta = -sample.dtheta;
  }
  std::reverse(recording.samples.begin(), recording.samples.end());
  std::reverse(recording.temperature.begin(), recording.temperature.end());
  for (record::NoiseLevel& level : recording.noise) {
    const geo::GpsTime to = mirrored(level.from, mirror);
    level.from = mirrored(level.to, mirror);
    level.to = to;
  }
  std::reverse(recording.noise.begin(), recording.noise.end());
  reverse(recording.members, mirror);
}

void reverse(record::GnssRecording& recording, geo::GpsTime mirror) {
  for (record::GnssFix& fix : recording.fixes) {
    fix.t = mirrored(fix.t, mirror);
    if (fix.velocity) fix.velocity->v_ea_n = -fix.velocity->v_ea_n;
  }
  std::reverse(recording.fixes.begin(), recording.fixes.end());
}

}  // namespace coast::ins
