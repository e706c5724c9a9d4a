#pragma once
// Results of examining the accepted run, shared by all moves; private to the room.

#include <functional>
#include <optional>

#include "search/candidates.hpp"
#include "search/movement.hpp"

namespace coast::diagnose {

/// Each part is computed when a move first requests it.
class Look {
 public:
  Look(const State& standing, Context& context);

  /// With the sizes estimated in the run, and their standard deviations.
  [[nodiscard]] const State& state() const { return state_; }
  [[nodiscard]] Context& context() const { return context_; }
  [[nodiscard]] const ExplainedRun& run() const { return *state_.run; }
  [[nodiscard]] const Movement& step() const { return step_; }
  /// With draws.
  [[nodiscard]] const Examination& examination();
  /// No candidates and no forms if the maximum number of effects is selected.
  [[nodiscard]] Candidates& candidates();
  /// Noise comes after the mean effects that are left.
  [[nodiscard]] bool takes_means_first() { return state_.limits.order == Order::kMeansFirst && !candidates().empty(); }
  /// A line or a relation that is not in the catalogue, if chance does not explain it.
  [[nodiscard]] const std::optional<Form>& form();
  /// Its minimum gain; 0 if there is none.
  [[nodiscard]] double form_gain();
  /// For stated noise that was not fitted yet, if innovations contradict it.
  [[nodiscard]] const std::optional<FittedNoise>& stated_noise();

  /// Stored by a move if none of its proposals was accepted.
  void note(const std::function<void(State&)>& reject) { reject(state_); }
  /// With the sizes of the run: earlier changes do not belong to any move.
  [[nodiscard]] State left() const;

 private:
  [[nodiscard]] bool is_full() const { return state_.account.findings.size() >= state_.limits.most_effects; }

  State state_;
  Context& context_;
  Movement step_;
  std::optional<Examination> examination_;
  std::optional<Candidates> candidates_;
  std::optional<std::optional<Form>> form_;
  std::optional<std::optional<FittedNoise>> stated_noise_;
};

}  // namespace coast::diagnose
