#include "search/moves/moves.hpp"

#include <array>
#include <optional>

namespace coast::diagnose {

namespace {

struct Entry {
  Move move;
  std::optional<Order> only = {};  ///< used only in this order
};
constexpr std::array kAll{
    Entry{drop_bent_relation},
    Entry{move_sizes},
    Entry{refit_estimated_noise},
    Entry{move_time_offset},
    Entry{add_random_effect, Order::kNoiseFirst},
    Entry{fit_stated_noise, Order::kNoiseFirst},
    Entry{add_random_effect_last, Order::kMeansFirst},
    Entry{fit_stated_noise_last, Order::kMeansFirst},
    Entry{add_form},
    Entry{add_mean_effect},
    Entry{settle_sizes},
    Entry{refit_noise},
};

}  // namespace

std::vector<Move> moves(Order order) {
  std::vector<Move> result;
  for (const Entry& entry : kAll)
    if (entry.only.value_or(order) == order) result.push_back(entry.move);
  return result;
}

}  // namespace coast::diagnose
