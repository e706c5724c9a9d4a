#include "search/sizes.hpp"

namespace coast::diagnose {

std::vector<Proposal> moved_sizes(const State& state, const Movement& step) {
  constexpr int kHalvings = 3;
  constexpr double kLess = 3.0;  // by which a run may be less likely because of another point of linearisation
  std::vector<Proposal> proposals;
  if (state.seen.stuck == state.run->key()) return proposals;
  double share = 1.0;
  for (int i = 0; i <= kHalvings; ++i, share *= 0.5)
    proposals.push_back({.explanation = moved(state.run->explanation(), step, share),
                         .about = state.run,
                         .before = state.run->log_likelihood(),
                         .least_gain = -kLess});
  return proposals;
}

void keep_sizes(State& state) {
  state.explanation = state.run->explanation();
  state.seen.stuck = state.run->key();
}

State with_settled_sizes(State state, Context& context) {
  constexpr int kMost = 8;
  for (int i = 0; i < kMost; ++i) {
    const Movement step = movement(state.run->sizes());
    note_deviations(state, step);
    if (step.farthest() < kNear) return state;
    std::optional<State> next = first_accepted(moved_sizes(state, step), state, context);
    if (!next) {
      keep_sizes(state);
      return state;
    }
    state = *std::move(next);
  }
  return state;
}

}  // namespace coast::diagnose
