#include "antenna.hpp"

namespace coast::estimate {

Linearised gnss_position(const FilterState& state, const UpdateContext& context, const record::GnssFix& fix) {
  const StateLayout& layout = context.layout;
  AntennaPrediction predicted = antenna_position(state, context);
  if (layout.gnss_error()) {
    predicted.value_e += context.C_n_e * state.x.segment<3>(*layout.gnss_error());
    predicted.H.block<3, 3>(0, *layout.gnss_error()) = context.C_n_e;
  }
  if (layout.base_offset()) {
    predicted.value_e += state.x.segment<3>(*layout.base_offset());
    predicted.H.block<3, 3>(0, *layout.base_offset()).setIdentity();
  }
  Linearised m;
  m.kind = UpdateKind::kGnssPosition;
  m.nu = fix.r_ea_e - predicted.value_e;
  m.H = std::move(predicted.H);
  m.R = context.C_n_e * fix.position_cov_n * context.C_n_e.transpose();
  return m;
}

}  // namespace coast::estimate
