#pragma once
// Parts of array.yaml also used by a study of arrays.

#include <string_view>

#include "coast/jobs/synth.hpp"

namespace coast::jobs {

/// [d, h, p, q] of an ARMA(d,h)-GARCH(p,q).  @throws InputError  not four whole numbers from 0 to 9, or q without p
[[nodiscard]] noise::ArmaGarchOrders arma_garch_orders(const config::Node& list);

[[nodiscard]] std::string_view merge_name(array::Merge merge);

[[nodiscard]] std::string_view merge_name(array::Merge merge);

}  // namespace coast::jobs
