#pragma once
// Proposals of a move, and the rule by which they are accepted; private to the room.

#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "search/state.hpp"

namespace coast::diagnose {

class Look;

/// Whether the sizes of an explanation are changed by its run's results, with one more run.
enum class Sizes { kStay, kMoveIfNeeded, kMove };

/// An explanation to run. It is accepted if its run is likelier than `before` by at least `least_gain`.
struct Proposal {
  Explanation explanation;
  RunPtr about;         ///< the run about which it is linearised
  double before = 0.0;  ///< log-likelihood
  double least_gain = -std::numeric_limits<double>::infinity();
  Sizes sizes = Sizes::kStay;
  /// Sets its report and history after acceptance. @param state  with its run
  std::function<void(State& state, double gain)> accept = [](State&, double) {};
  /// Of what `accept` makes of the state: with less it is not accepted after all.
  double least_log_likelihood = -std::numeric_limits<double>::infinity();
};

/// Proposals of one move, in the order of trial. The first accepted one ends the step.
struct Proposals {
  std::vector<Proposal> tries = {};
  /// Stored if none is accepted; empty: nothing to store.
  std::function<void(State&)> reject = {};
  bool looks_again = false;  ///< then start again with the first move; otherwise the next move follows
  bool is_noise = false;     ///< comes after mean effects in the order that takes those first
};

/// A move uses the results of a run and proposes explanations. It has no side effects.
using Move = Proposals (*)(Look&);

/// Runs a proposal. @return  the state with its run if it is accepted
[[nodiscard]] std::optional<State> accepted(const Proposal& proposal, const State& from, Context& context);
/// The first accepted one.
[[nodiscard]] std::optional<State> first_accepted(const std::vector<Proposal>& proposals, const State& from, Context& context);

}  // namespace coast::diagnose
