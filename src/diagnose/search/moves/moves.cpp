#include "search/moves/moves.hpp"

#include <array>

namespace coast::diagnose {

std::span<const Move> moves() {
  static constexpr std::array kAll{
      Move{drop_bent_relation}, Move{move_sizes}, Move{refit_estimated_noise}, Move{move_time_offset}, Move{add_random_effect},
      Move{fit_stated_noise},   Move{add_form},   Move{add_mean_effect},       Move{settle_sizes},     Move{refit_noise},
  };
  return kAll;
}

}  // namespace coast::diagnose
