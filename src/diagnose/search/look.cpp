#include "search/look.hpp"

#include <cmath>
#include <utility>

#include "search/begin.hpp"

namespace coast::diagnose {

namespace {

constexpr double kUncertain = 0.1;     // of a likelihood ratio whose variance is from some hundred draws
constexpr double kStable = 0.5;        // of a relation that is accepted
constexpr double kContradicted = 4.0;  // sd of the innovations' variance or correlation above which noise is fitted

std::optional<Form> likeliest_form(const Examination& examination, const State& state) {
  std::optional<Form> best;
  for (const std::optional<Form>& form : {strongest_line(examination), likeliest_relation(examination, state.run->mission())}) {
    if (!form || form->p_value > kFormFalseAlarm || form->stability < kStable) continue;
    if (state.excluded.excludes(*form->effect)) continue;
    if (!best || form->likelihood_ratio - 2.0 * form->log_places > best->likelihood_ratio - 2.0 * best->log_places) best = form;
  }
  return best;
}

}  // namespace

Look::Look(const State& standing, Context& context)
    : state_(standing), context_(context), step_(movement(standing.run->sizes())) {
  state_.explanation = moved(standing.run->explanation(), step_);
  note_deviations(state_, step_);
}

State Look::left() const {
  return with_run(state_, state_.run);
}

const Examination& Look::examination() {
  if (examination_) return *examination_;
  Seen& seen = state_.seen;
  examination_ = run().scores();
  if (!seen.drawn || !examination_->take_draws_of(*seen.drawn)) {
    state_ = with_draws(std::move(state_), context_);
    examination_ = *seen.drawn;
  }
  seen.suspicions =
      suspicions(*examination_, run().hypotheses(), rows_of(state_.explanation.effects, run().hypotheses().size()));
  return *examination_;
}

Candidates& Look::candidates() {
  if (candidates_) return *candidates_;
  static_cast<void>(examination());
  candidates_ = is_full() ? Candidates() : Candidates(state_, context_);
  return *candidates_;
}

const std::optional<Form>& Look::form() {
  if (!form_) form_ = is_full() ? std::nullopt : likeliest_form(examination(), state_);
  return *form_;
}

double Look::form_gain() {
  return form() ? (0.5 + kUncertain) * form()->likelihood_ratio - form()->log_places : 0.0;
}

const std::optional<FittedNoise>& Look::stated_noise() {
  if (stated_noise_) return *stated_noise_;
  stated_noise_.emplace();
  const bool is_open = !state_.account.noise && !state_.noise.tried;
  if (!is_open || !(contradiction(run().mission().solution().forward.innovations) > kContradicted)) return *stated_noise_;
  state_.noise.tried = true;
  *stated_noise_ = fitted_noise(run().mission().prepared(), state_.noise.last, context_.runs.progress());
  if (*stated_noise_) state_.noise.last = (*stated_noise_)->fit;
  return *stated_noise_;
}

}  // namespace coast::diagnose
