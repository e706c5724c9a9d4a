#include "antenna.hpp"

namespace coast::estimate {

std::optional<Linearised> gnss_velocity(const FilterState& state, const UpdateContext& context, const record::GnssFix& fix) {
  if (!fix.velocity) return std::nullopt;
  AntennaPrediction predicted = antenna_velocity(state, context);
  Linearised m;
  m.kind = UpdateKind::kGnssVelocity;
  m.nu = context.C_n_e * fix.velocity->v_ea_n - predicted.value_e;
  m.H = std::move(predicted.H);
  m.R = context.C_n_e * fix.velocity->cov_n * context.C_n_e.transpose();
  return m;
}

}  // namespace coast::estimate
