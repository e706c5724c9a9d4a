#include "search/search.hpp"

#include <utility>

#include "search/moves/moves.hpp"
#include "search/review.hpp"

namespace coast::diagnose {

namespace {

/// Linearised about the sensor errors estimated in the run, if these differ: otherwise another effect would have to explain the
/// part of the selected effects that was estimated as sensor errors.
State about_its_sensors(State state, Context& context) {
  if (!state.run->found_sensors_elsewhere()) return state;
  const RunPtr run = context.runs.about(state.explanation, state.run);
  return with_run(std::move(state), run);
}

}  // namespace

Step step(const State& standing, Context& context) {
  Look look(standing, context);
  for (const Move move : moves()) {
    const Proposals proposals = move(look);
    if (std::optional<State> next = first_accepted(proposals.tries, look.state(), context)) {
      if (proposals.is_noise && context.orders_part && !look.candidates().empty()) context.orders_part(standing);
      return {about_its_sensors(*std::move(next), context), true};
    }
    if (proposals.reject) look.note(proposals.reject);
    if (proposals.looks_again) return {look.left(), true};
  }
  return {look.left(), false};
}

State searched(State state, Context& context) {
  constexpr int kMostSteps = 30;
  constexpr int kMostReviews = 2;
  for (int review = 0; review <= kMostReviews; ++review) {
    bool goes_on = true;
    for (int i = 0; i < kMostSteps && goes_on; ++i) {
      Step next = step(state, context);
      state = std::move(next.state);
      goes_on = next.goes_on;
    }
    if (review == kMostReviews) break;
    Reviewed reviewed = diagnose::reviewed(std::move(state), context);
    state = std::move(reviewed.state);
    if (!reviewed.changed) break;
  }
  return state;
}

}  // namespace coast::diagnose
