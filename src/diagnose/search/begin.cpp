#include "search/begin.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "search/proposal.hpp"

namespace coast::diagnose {

namespace {

constexpr double kLeastOfSamples = 3.0;  // logarithm of the likelihood ratio above which a converter's mark matters

/// The mission corrected for one converter, and with noise for the remainder.
Proposal mended(const Mark& mark, const State& state, const Context& context) {
  const MissionInput& recorded = context.runs.recorded();
  MissionInput input{*state.explanation.imu, recorded.gnss, recorded.setup};
  state.explanation.add_noise(input);  // noise is raised in addition to the fitted one
  mark.effect->model(input, mark.effect->site, mark.axis, mark.parameter);
  Explanation explanation = state.explanation;
  explanation.imu = std::make_shared<const record::ImuRecording>(std::move(input.imu));
  return {.explanation = std::move(explanation),
          .about = state.run,
          .before = state.run->log_likelihood(),
          .least_gain = kLeastOfSamples,
          .accept = [mark](State& next, double gain) { next.account.converters.push_back(described(mark, gain)); }};
}

}  // namespace

MissionInput with_open_gate(const MissionInput& input) {
  MissionInput open = input;
  open.setup.filter.gate_probability = 0.0;
  open.setup.noise_fit.reset();
  return open;
}

State begin(Context& context) {
  State state;
  state.limits.most_effects = static_cast<std::size_t>(context.options.most_effects);
  state.limits.time_offset_s = context.options.time_offset_s;
  state.explanation.imu = std::make_shared<const record::ImuRecording>(context.runs.recorded().imu);
  const RunPtr first = context.runs.first(state.explanation);
  const RunPtr second = context.runs.about(state.explanation, first);
  state = with_run(std::move(state), second);
  return context.asked_for ? with_fitted_noise(std::move(state), context) : state;
}

// Marks are those of the recorded samples: corrected ones are not multiples of a step.
State with_mended_samples(State state, Context& context) {
  for (const SampleEffect& effect : sample_catalogue())
    for (int axis = 0; axis < 3; ++axis) {
      const std::optional<double> found = effect.find(axis_series(context.runs.recorded(), effect.site, axis));
      if (!found) continue;
      const Mark mark{&effect, axis, *found};
      if (std::optional<State> next = accepted(mended(mark, state, context), state, context)) state = *std::move(next);
      state.account.marks.push_back(mark);
    }
  return state;
}

State with_draws(State state, const Context& context) {
  state.seen.drawn = std::make_shared<const Examination>(state.run->examined({.seed = context.options.seed}));
  return state;
}

NoiseFinding described(const Mark& mark, double gain) {
  const SampleEffect& effect = *mark.effect;
  return {.name = std::string(effect.name),
          .sensor = std::string(name(effect.site)),
          .axis = axis_letter(mark.axis),
          .parameter = std::string(effect.parameter),
          .unit = std::string(effect.unit),
          .value = mark.parameter,
          .sd = 0.0,
          .delta_log_likelihood = gain,
          .p_value = std::exp(-gain),
          .place = NoiseFinding::Place::kEffects,
          .meaning = std::string(effect.meaning),
          .equation = std::string(effect.equation),
          .separating_manoeuvre = std::string(effect.separating_manoeuvre)};
}

}  // namespace coast::diagnose
