#include "refinement.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>

#include "bounded_search.hpp"
#include "candidate.hpp"
#include "kalman/fixed_model.hpp"
#include "model_search.hpp"
#include "polish.hpp"
#include "spectrum.hpp"

namespace coast::noise {

namespace {

/// A sum to be tried, with parameters to start from or, once it is ranked, as fitted to the spectrum.
struct Step {
  SumModel model;
  std::vector<double> u;
  double cost = 0.0;  ///< criterion on the spectrum
};

std::span<const double> values_of(const std::vector<double>& u, const SumModel::Term& term) {
  return std::span(u).subspan(term.parameter, term.parameters);
}

/// Parameters of an autoregression one order higher that is the same series: a last partial autocorrelation of zero.
void raise_order(const SumModel::Term& from, std::span<const double> u, double interval, std::span<double> raised) {
  std::copy_n(u.begin(), u.size() - 1, raised.begin());
  raised[raised.size() - 2] = 0.0;
  raised[raised.size() - 1] = from.states > 0 ? u.back() : u.back() - std::log(interval);  // white noise has a density
}

/// Parameters of a process that joins the others: of a coarse grid where it does most, once the others have begun to make room.
void place(const SumModel& model, const SumModel::Term& added, const Spectrum& spectrum, const std::vector<Interval>& ranges,
           std::vector<double>& u) {
  std::vector<std::vector<double>> trials{u};
  for (std::size_t i = added.parameter; i < added.parameter + added.parameters; ++i) {
    std::vector<double> values;
    if (model.parameter(i).kind == ParameterInfo::Kind::kVariance)
      values = {ranges[i].upper - 3.0, ranges[i].upper - 7.0, ranges[i].upper - 11.0};
    else
      for (int k = 0; k < 8; ++k) values.push_back(ranges[i].lower + (ranges[i].upper - ranges[i].lower) * (k + 0.5) / 8.0);
    std::vector<std::vector<double>> more;
    for (const std::vector<double>& trial : trials)
      for (const double value : values) {
        more.push_back(trial);
        more.back()[i] = value;
      }
    trials = std::move(more);
  }
  double best = -std::numeric_limits<double>::infinity();
  for (const std::vector<double>& trial : trials) {
    constexpr int kBegun = 6;
    Fit fit;
    fit.u = trial;
    polish([&](const std::vector<double>& at) { return spectral_slope(spectrum, model, at); }, model, ranges, {},
           {.tolerance = 0.1, .steps = kBegun}, fit);
    if (!(fit.log_likelihood > best)) continue;
    best = fit.log_likelihood;
    u = fit.u;
  }
}

/// What the sum has in common with the one that was fitted, as it was there.
std::vector<double> start_from(const Step& now, const SumModel& model, const Spectrum& spectrum,
                               const std::vector<Interval>& ranges) {
  std::vector<double> u(model.parameters(), 0.0);
  std::vector<bool> used(now.model.terms().size(), false);
  const SumModel::Term* fresh = nullptr;
  for (const SumModel::Term& term : model.terms()) {
    std::size_t from = 0;
    while (from < used.size() && (used[from] || now.model.terms()[from].process != term.process)) ++from;
    if (from == used.size()) {
      fresh = &term;
      continue;
    }
    used[from] = true;
    std::ranges::copy(values_of(now.u, now.model.terms()[from]), u.begin() + static_cast<std::ptrdiff_t>(term.parameter));
  }
  if (fresh == nullptr) return u;
  const auto gone = static_cast<std::size_t>(std::ranges::find(used, false) - used.begin());
  if (gone < used.size())
    raise_order(now.model.terms()[gone], values_of(now.u, now.model.terms()[gone]), spectrum.interval,
                std::span(u).subspan(fresh->parameter, fresh->parameters));
  else
    place(model, *fresh, spectrum, ranges, u);
  return u;
}

/// Poles r exp(+-i phi) at the band's centre and width, and its variance.
std::vector<double> resonance(const Band& band, double interval) {
  const double r = std::exp(-std::numbers::pi * band.width * interval);
  const double phi = 2.0 * std::numbers::pi * band.centre * interval;
  const double second = -r * r;
  const double first = 2.0 * r * std::cos(phi) / (1.0 - second);
  return {std::atanh(first), std::atanh(second), std::log(band.variance * (1.0 - first * first) * (1.0 - second * second))};
}

/// The sum with an AR(2) for the strongest band that it does not explain, if there is one.
std::optional<Step> with_vibration(const Step& now, const Spectrum& spectrum) {
  constexpr std::ptrdiff_t kMostVibrations = 3;  // the strongest; slow processes need room too
  const auto is_vibration = [&](const SumModel::Term& term) {
    return term.process == &estimable("ar(2)") && &term != base_of(now.model);
  };
  if (std::ranges::count_if(now.model.terms(), is_vibration) >= kMostVibrations) return {};
  const std::optional<Band> band = strongest_band(spectrum, now.model, now.u);
  if (!band) return {};
  std::vector<const Estimable*> processes = processes_of(now.model);
  processes.push_back(&estimable("ar(2)"));
  Step step{SumModel(processes, now.model.mean()), now.u};
  if (step.model.states() > kMostStates || step.model.parameters() > kMostParameters) return {};
  std::ranges::copy(resonance(*band, spectrum.interval), std::back_inserter(step.u));
  return step;
}

/// Sampled, a Gauss-Markov process faster than the samples is an AR(1): it is named so, and as the sum's base can grow.
void name_base(Candidate& candidate, double interval) {
  constexpr double kFast = 0.3;  // of an interval
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
    const Step start = ranked({best.model, best.fit.u});
    Step now = start;
    for (bool gained = true; gained;) gained = follow(steps_up(now), now);
    for (bool gained = true; gained;) gained = follow(steps_down(now), now);
    const auto known = std::ranges::find_if(candidates_, [&](const Candidate& c) { return is(c, now.model); });
    best = known != candidates_.end() ? *known : on_all_samples(now.model, now.u);
    if (start.cost < now.cost + kNear) try_on_all_samples(start, best);
    for (bool gained = true; gained;) gained = settle(best);
  }

 private:
  static constexpr double kNear = 10.0;  // of a criterion: beyond it the spectrum's word is taken

  std::vector<Step> steps_up(const Step& from) const {
    std::vector<Step> steps;
    for (const SumModel& sum : larger(from.model, options_)) add(sum, from, steps);
    if (auto vibration = with_vibration(from, spectrum_)) steps.push_back(std::move(*vibration));
    return steps;
  }
  std::vector<Step> steps_down(const Step& from) const {
    std::vector<Step> steps;
    for (const SumModel& sum : smaller(from.model)) add(sum, from, steps);
    return steps;
  }
  /// A drift is not in the spectrum.
  void add(const SumModel& sum, const Step& from, std::vector<Step>& steps) const {
    if (sum.mean() == from.model.mean()) steps.push_back({sum, start_from(from, sum, spectrum_, sum.ranges(scale_))});
  }

  /// Fitted to the spectrum and scored by it.
  Step ranked(Step step) const {
    constexpr int kIterations = 40;
    const std::vector<Interval> box = step.model.ranges(scale_);
    Fit fit;
    fit.u = search_within(step.u, box, 1e-2, kIterations, [&](const std::vector<double>& u, Eigen::VectorXd& gradient) {
              const LikelihoodSlope at = spectral_slope(spectrum_, step.model, u);
              gradient = -at.gradient;
              return -at.log_likelihood;
            }).u;
    polish([&](const std::vector<double>& u) { return spectral_slope(spectrum_, step.model, u); }, step.model, box, {},
           {.tolerance = 1e-3, .steps = kIterations}, fit);
    const auto k = static_cast<double>(step.model.parameters());
    step.u = fit.u;
    step.cost = -2.0 * fit.log_likelihood + k * (options_.criterion == Criterion::kAicc ? 2.0 : std::log(samples_));
    return step;
  }
  void rank(std::vector<Step>& steps) const {
    tbb::parallel_for(std::size_t{0}, steps.size(), [&](std::size_t i) { steps[i] = ranked(std::move(steps[i])); });
    std::ranges::sort(steps, {}, &Step::cost);
  }
  bool follow(std::vector<Step> steps, Step& now) {
    progress();
    rank(steps);
    if (steps.empty() || !(steps.front().cost < now.cost)) return false;
    now = std::move(steps.front());
    return true;
  }

  /// The neighbours that are nearly as good by the spectrum, and the one with a drift or without.
  bool settle(Candidate& best) {
    constexpr std::size_t kTried = 2;
    const Step now = ranked({best.model, best.fit.u});
    std::vector<Step> steps = steps_down(now);
    std::ranges::move(steps_up(now), std::back_inserter(steps));
    rank(steps);
    std::erase_if(steps, [&](const Step& step) { return step.cost > now.cost + kNear || tried(step.model); });
    if (steps.size() > kTried) steps.erase(steps.begin() + kTried, steps.end());
    const Mean other = best.model.mean() == Mean::kLevel ? Mean::kLevelAndDrift : Mean::kLevel;
    const SumModel drifting(processes_of(best.model), other);
    if (!tried(drifting)) steps.push_back({drifting, best.fit.u});
    return std::ranges::any_of(steps, [&](const Step& step) { return try_on_all_samples(step, best); });
  }
  static bool is(const Candidate& candidate, const SumModel& model) {
    return candidate.on_all_samples && candidate.model.name() == model.name();
  }
  bool tried(const SumModel& model) const {
    return std::ranges::any_of(candidates_, [&](const Candidate& c) { return is(c, model); });
  }
  bool try_on_all_samples(const Step& step, Candidate& best) {
    if (tried(step.model)) return false;
    const Candidate candidate = on_all_samples(step.model, step.u);
    if (!better(candidate, best, options_.criterion)) return false;
    best = candidate;
    return true;
  }
  Candidate on_all_samples(const SumModel& model, const std::vector<double>& start) {
    constexpr double kTolerance = 1e-5;  // of log-likelihood
    constexpr int kSteps = 30;
    progress();
    const Likelihood likelihood(records_, model);
    Candidate candidate;
    candidate.model = model;
    candidate.fit.u = start;
    const auto by_spectrum = [&](const std::vector<double>& u) { return spectral_slope(spectrum_, model, u); };
    polish([&](const std::vector<double>& u) { return likelihood.slope(u); }, model, model.ranges(scale_),
           excess_curvature(by_spectrum, start), {.tolerance = kTolerance, .steps = kSteps}, candidate.fit);
    candidate.compared_log_likelihood = likelihood.value(candidate.fit.u).at_mean;
    candidate.on_all_samples = true;
    score(likelihood, candidate);
    if (options_.held_out || options_.criterion == Criterion::kHeldOut)
      candidate.held_out = held_out_score(records_, model, candidate.fit.u);
    candidates_.push_back(candidate);
    return candidate;
  }
  void progress() {
    if (options_.progress) options_.progress("comparing sums on all samples", 1.0 - 1.0 / (1.0 + 0.1 * rounds_++));
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
