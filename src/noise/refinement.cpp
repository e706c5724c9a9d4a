#include "refinement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>

#include "candidate.hpp"
#include "coast/parallel.hpp"
#include "full_fit.hpp"
#include "kalman/fixed_model.hpp"
#include "model_search.hpp"
#include "spectral_step.hpp"

namespace coast::noise {

namespace {

/// Poles r exp(+-i phi) from the band's centre and width, and its variance.
std::vector<double> resonance(const Band& band, double interval) {
  const double r = std::exp(-std::numbers::pi * band.width * interval);
  const double phi = 2.0 * std::numbers::pi * band.centre * interval;
  const double second = -r * r;
  const double first = 2.0 * r * std::cos(phi) / (1.0 - second);
  return {std::atanh(first), std::atanh(second), std::log(band.variance * (1.0 - first * first) * (1.0 - second * second))};
}

/// The sum with an AR(2) for the strongest band that it does not explain, if there is one.
std::optional<SpectralStep> with_vibration(const SpectralStep& now, const Spectrum& spectrum) {
  constexpr std::ptrdiff_t kMostVibrations = 3;  // the strongest; slow processes need room too
  const auto is_vibration = [&](const SumModel::Term& term) {
    return term.process == &estimable("ar(2)") && &term != base_of(now.model);
  };
  if (std::ranges::count_if(now.model.terms(), is_vibration) >= kMostVibrations) return {};
  const std::optional<Band> band = strongest_band(spectrum, now.model, now.u);
  if (!band) return {};
  std::vector<const Estimable*> processes = processes_of(now.model);
  processes.push_back(&estimable("ar(2)"));
  SpectralStep step{SumModel(processes, now.model.mean()), now.u};
  if (step.model.states() > kMostStates || step.model.parameters() > kMostParameters) return {};
  std::ranges::copy(resonance(*band, spectrum.interval), std::back_inserter(step.u));
  return step;
}

/// A Gauss-Markov process faster than the samples is an AR(1) when sampled: it is named so, and its order can grow as a base.
void name_base(Candidate& candidate, double interval) {
  constexpr double kFast = 0.3;  // beta times the interval
  for (const SumModel::Term& term : candidate.model.terms()) {
    if (term.process != &estimable("gauss_markov") || std::exp(candidate.fit.u[term.parameter]) * interval < kFast) continue;
    const double phi = std::exp(-std::exp(candidate.fit.u[term.parameter]) * interval);
    std::vector<const Estimable*> processes{&estimable("ar(1)")};
    std::vector<double> u{std::atanh(phi), candidate.fit.u[term.parameter + 1] + std::log(1.0 - phi * phi)};
    for (const SumModel::Term& other : candidate.model.terms()) {
      if (&other == &term) continue;
      processes.push_back(other.process);
      std::ranges::copy(values_of(candidate.fit.u, other), std::back_inserter(u));
    }
    candidate.model = SumModel(processes, candidate.model.mean());
    candidate.fit.u = u;
    return;
  }
}

class Refinement {
 public:
  Refinement(const std::vector<StaticSignal>& records, const CalibrationOptions& options, std::vector<Candidate>& candidates)
      : records_(records), options_(options), candidates_(candidates) {
    const Likelihood likelihood(records, candidates.front().model);
    spectrum_ = spectrum_of(likelihood.records());
    scale_ = likelihood.scale();
    samples_ = likelihood.samples();
  }

  void run() {
    Candidate best = candidates_[choose(candidates_, options_.criterion)];
    name_base(best, spectrum_.interval);
    const SpectralStep start = ranked({best.model, best.fit.u});
    SpectralStep now = start;
    for (bool gained = true; gained;) gained = follow(steps_up(now), now);
    for (bool gained = true; gained;) gained = follow(steps_down(now), now);
    const auto known = std::ranges::find_if(candidates_, [&](const Candidate& c) { return is(c, now.model); });
    best = known != candidates_.end() ? *known : on_all_samples(now.model, now.u);
    if (start.cost < now.cost + kNear) try_on_all_samples(start, best);
    for (bool gained = true; gained;) gained = settle(best);
  }

 private:
  static constexpr double kNear = 10.0;  // of a criterion: beyond it the spectrum decides

  std::vector<SpectralStep> steps_up(const SpectralStep& from) const {
    std::vector<SpectralStep> steps;
    for (const SumModel& sum : larger(from.model, options_)) add(sum, from, steps);
    if (auto vibration = with_vibration(from, spectrum_)) steps.push_back(std::move(*vibration));
    return steps;
  }
  std::vector<SpectralStep> steps_down(const SpectralStep& from) const {
    std::vector<SpectralStep> steps;
    for (const SumModel& sum : smaller(from.model)) add(sum, from, steps);
    for (const SumModel& sum : exchanged(from.model, options_)) add(sum, from, steps);
    return steps;
  }
  /// A drift has no effect on the spectrum.
  void add(const SumModel& sum, const SpectralStep& from, std::vector<SpectralStep>& steps) const {
    if (sum.mean() == from.model.mean()) steps.push_back({sum, step_from(from, sum, spectrum_, sum.ranges(scale_))});
  }

  /// Fitted to the spectrum and scored by it.
  SpectralStep ranked(SpectralStep step) const {
    climb(spectrum_, step.model.ranges(scale_), step);
    step.cost = -2.0 * step.log_likelihood + cost_of_parameters(step);
    return step;
  }
  double cost_of_parameters(const SpectralStep& step) const {
    if (options_.criterion == Criterion::kAicc) return 2.0 * static_cast<double>(step.model.parameters());
    return penalty(step.model, independent_squares(spectral_slope(spectrum_, step.model, step.u).information), samples_);
  }
  void rank(std::vector<SpectralStep>& steps) const {
    coast::parallel_for(std::size_t{0}, steps.size(), [&](std::size_t i) { steps[i] = ranked(std::move(steps[i])); });
    std::ranges::sort(steps, {}, &SpectralStep::cost);
  }
  bool follow(std::vector<SpectralStep> steps, SpectralStep& now) {
    progress();
    rank(steps);
    if (steps.empty() || !(steps.front().cost < now.cost)) return false;
    now = std::move(steps.front());
    return true;
  }

  /// The neighbours that are nearly as good by the spectrum, and the sum with a drift added or removed.
  bool settle(Candidate& best) {
    constexpr std::size_t kTried = 3;
    const SpectralStep now = ranked({best.model, best.fit.u});
    std::vector<SpectralStep> steps = steps_down(now);
    std::ranges::move(steps_up(now), std::back_inserter(steps));
    rank(steps);
    std::erase_if(steps, [&](const SpectralStep& step) { return step.cost > now.cost + kNear || tried(step.model); });
    if (steps.size() > kTried) steps.erase(steps.begin() + kTried, steps.end());
    const Mean other = best.model.mean() == Mean::kLevel ? Mean::kLevelAndDrift : Mean::kLevel;
    const SumModel drifting(processes_of(best.model), other);
    if (!tried(drifting)) steps.push_back({drifting, best.fit.u});
    return std::ranges::any_of(steps, [&](const SpectralStep& step) { return try_on_all_samples(step, best); });
  }
  static bool is(const Candidate& candidate, const SumModel& model) {
    return candidate.on_all_samples && candidate.model.name() == model.name();
  }
  bool tried(const SumModel& model) const {
    return std::ranges::any_of(candidates_, [&](const Candidate& c) { return is(c, model); });
  }
  bool try_on_all_samples(const SpectralStep& step, Candidate& best) {
    if (tried(step.model)) return false;
    const Candidate candidate = on_all_samples(step.model, step.u);
    if (!better(candidate, best, options_.criterion)) return false;
    best = candidate;
    return true;
  }
  Candidate on_all_samples(const SumModel& model, const std::vector<double>& start) {
    progress();
    Candidate candidate = fit_on_all_samples(records_, spectrum_, model, start, options_);
    candidates_.push_back(candidate);
    return candidate;
  }
  void progress() {
    constexpr double kUsual = 16.0;  // rounds on the spectrum and sums fitted to all samples
    if (options_.progress)
      options_.progress("comparing sums on all samples",
                        kSearchShare + (1.0 - kSearchShare) * std::min(1.0, static_cast<double>(rounds_++) / kUsual));
  }

  const std::vector<StaticSignal>& records_;
  const CalibrationOptions& options_;
  std::vector<Candidate>& candidates_;
  Spectrum spectrum_;
  SignalScale scale_;
  double samples_ = 0.0;
  int rounds_ = 0;
};

}  // namespace

void refine(const std::vector<StaticSignal>& records, const CalibrationOptions& options, std::vector<Candidate>& candidates) {
  Refinement(records, options, candidates).run();
}

}  // namespace coast::noise
