#include "measurement.hpp"

namespace coast::estimate {

namespace {

record::GnssFix scaled(const record::GnssFix& fix, const GnssScale& s) {
  record::GnssFix result = fix;
  const Eigen::Vector3d scale(s.horizontal, s.horizontal, s.vertical);
  result.position_cov_n = scale.asDiagonal() * fix.position_cov_n * scale.asDiagonal();
  if (result.velocity) result.velocity->cov_n *= s.velocity * s.velocity;
  return result;
}

}  // namespace

std::optional<Linearised> linearise(const Measurement& m, const Mission& mission, const FilterOptions& options,
                                    const FilterState& state, const UpdateContext& context) {
  switch (m.kind) {
    case UpdateKind::kGnssPosition:
      return gnss_position(state, context, scaled(mission.gnss.fixes[m.index], options.gnss_scale));
    case UpdateKind::kGnssVelocity:
      return gnss_velocity(state, context, scaled(mission.gnss.fixes[m.index], options.gnss_scale));
    case UpdateKind::kZeroVelocity:
      return zero_velocity(state, *options.vehicle.zero_velocity_sd_mps);
    case UpdateKind::kNonHolonomic:
      return non_holonomic(state, context, *options.vehicle.non_holonomic);
    case UpdateKind::kMemberDifference: {
      record::MemberBlocks::Block block = mission.imu.members.blocks[m.index];
      for (const std::size_t member : m.left_out) block.means[member].reset();
      return member_difference(state, context.layout, block, m.sensor, m.member);
    }
    case UpdateKind::kAid: {
      const AidStream& stream = mission.aids[m.aid];
      return stream.aid->linearise((*stream.samples)[m.index], state, context, context.layout.aids()[m.aid]);
    }
    case UpdateKind::kCarrierPhase:
    case UpdateKind::kHeadingHold:
      break;  // not functions of one state: tight_coupling.hpp, heading_hold()
  }
  return std::nullopt;
}

}  // namespace coast::estimate
