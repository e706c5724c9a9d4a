// The part of the search that looks at noise.

#include <algorithm>
#include <cmath>
#include <utility>

#include "search.hpp"

namespace coast::diagnose {

namespace {

constexpr double kContradicted = 4.0;    // sd of the innovations' variance or correlation, from where noise is fitted
constexpr double kLeastOfSamples = 3.0;  // logarithm of the likelihood ratio, from where a converter's mark matters
constexpr std::size_t kMostRandom = 4;

const NoiseSuspicion* strongest(const NoiseSuspicions& suspected, const NoiseEffect& effect, const AddedNoise& beside) {
  const NoiseSuspicion* best = nullptr;
  for (const NoiseSuspicion& s : suspected.all)
    if (s.noise.effect == &effect && effect.site == beside.effect->site && s.noise.axis == beside.axis &&
        (best == nullptr || s.likelihood_ratio > best->likelihood_ratio))
      best = &s;
  return best;
}

}  // namespace

void Search::look_at_samples() {
  for (const SampleEffect& effect : sample_catalogue())
    for (int axis = 0; axis < 3; ++axis) {
      const std::optional<double> found = effect.find(axis_series(input_, effect.site, axis));
      if (!found) continue;
      const double before = run_->log_likelihood();
      MissionInput modelled = input_;
      model_noise(modelled);  // noise is raised beside what was fitted
      effect.model(modelled, effect.site, axis, *found);
      std::swap(input_.imu, modelled.imu);
      run_again();
      const double gained = run_->log_likelihood() - before;
      if (gained < kLeastOfSamples) {
        std::swap(input_.imu, modelled.imu);
        run_again();
        continue;
      }
      result_.noise.push_back({.name = std::string(effect.name),
                               .sensor = std::string(name(effect.site)),
                               .axis = axis_letter(axis),
                               .parameter = std::string(effect.parameter),
                               .unit = std::string(effect.unit),
                               .value = *found,
                               .sd = 0.0,
                               .delta_log_likelihood = gained,
                               .p_value = std::exp(-gained),
                               .place = NoiseFinding::Place::kEffects,
                               .meaning = std::string(effect.meaning),
                               .equation = std::string(effect.equation),
                               .separating_manoeuvre = std::string(effect.separating_manoeuvre)});
    }
}

bool Search::take_noise(const Examination& examination, double form_gain) {
  std::optional<FittedNoise> stated;
  if (!noise_ && !noise_tried_ && contradiction(run_->solution().forward.innovations) > kContradicted) {
    noise_tried_ = true;
    stated = fitted_noise(run_->prepared(), last_fit_, progress_);
    if (stated) last_fit_ = stated->fit;
  }
  const double stated_gain = stated ? stated->gain() : 0.0;
  if (added_.size() < kMostRandom && take_random_effect(examination, std::max(form_gain, stated_gain))) return true;
  if (!stated || stated_gain <= form_gain || !exceeds_candidates(stated_gain, &Candidates::gain)) return false;
  noise_ = std::move(stated);
  return true;
}

void Search::fit_noise() {
  noise_is_behind_ = false;
  explained_ = 0.0;
  noise_ = fitted_noise(run_->prepared(), last_fit_, progress_);
  if (!noise_) return;
  last_fit_ = noise_->fit;
  run_again();
}

bool Search::fit_noise_again() {
  if (!std::exchange(noise_is_behind_, false)) return false;
  const bool was_tried = std::exchange(noise_tried_, false);
  if (!noise_) return was_tried;
  const double before = run_->log_likelihood();
  const FittedNoise last = *std::exchange(noise_, std::nullopt);
  run_again();
  fit_noise();
  if (run_->log_likelihood() > before) return true;
  noise_ = last;  // a part of a long mission is not all of it
  run_again();
  return false;
}

bool Search::take_random_effect(const Examination& examination, double to_beat) {
  beaten_.clear();
  const NoiseSuspicions suspected = noise_suspicions(examination, *run_);
  const NoiseSuspicion* first = nullptr;
  for (const NoiseSuspicion& s : suspected.all)
    if (s.p_value < kNoiseFalseAlarm && !was_refused(s.noise) &&
        (first == nullptr || s.likelihood_ratio > first->likelihood_ratio))
      first = &s;
  if (first == nullptr) return false;
  std::vector<FittedEffect> fits{fitted(first->noise)};
  const double p_value = suspected.chance.p_value(2.0 * std::max(0.0, fits.front().gain));
  const double gain = fits.front().gain - std::log(suspected.chance.count);
  if (p_value > kNoiseFalseAlarm || gain <= to_beat ||
      !exceeds_candidates(diagnose::evidence_of(fits.front()), &Candidates::evidence)) {
    if (p_value > kNoiseFalseAlarm) refused_noise_.push_back(first->noise);
    beaten_ = std::move(fits);
    return false;
  }
  fits.front() = fitted_in_time(fits.front());
  for (const NoiseEffect& effect : noise_catalogue())
    if (const NoiseSuspicion* s = strongest(suspected, effect, first->noise); s != nullptr && &effect != first->noise.effect)
      fits.push_back(fitted_in_time(fitted(s->noise)));
  std::ranges::sort(fits, std::ranges::greater{}, [](const FittedEffect& fit) { return diagnose::evidence_of(fit); });
  describe(fits, p_value);
  added_.push_back(fits.front().noise);
  return true;
}

FittedEffect Search::fitted(const AddedNoise& noise) const {
  return fitted_effect(noise, current_, run_->layout(), run_->log_likelihood());
}

FittedEffect Search::fitted_in_time(FittedEffect fit) const {
  const std::vector<double>& times = fit.noise.effect->times;
  const auto count = static_cast<std::ptrdiff_t>(times.size());
  const std::ptrdiff_t begin = std::ranges::find(times, fit.noise.time) - times.begin();
  for (const std::ptrdiff_t step : {-1, 1}) {
    const double before = fit.gain;
    for (std::ptrdiff_t k = begin + step; k >= 0 && k < count; k += step) {
      AddedNoise noise = fit.noise;
      noise.time = times[static_cast<std::size_t>(k)];
      FittedEffect other = fitted(noise);
      if (!(other.gain > fit.gain)) break;
      fit = std::move(other);
    }
    if (fit.gain > before) break;
  }
  return fit;
}

bool Search::was_refused(const AddedNoise& noise) const {
  return std::ranges::any_of(refused_noise_, [&](const AddedNoise& other) {
    return other.axis == noise.axis && other.effect->site == noise.effect->site;
  });
}

Alternative alternative(const FittedEffect& fit, double log_odds) {
  return {std::string(fit.noise.effect->name), std::string(name(fit.noise.effect->site)), axis_letter(fit.noise.axis),
          log_odds};
}

// That it is of this correlation time is chosen too.
double evidence_of(const FittedEffect& fit) {
  return fit.gain - price_of_random_effect(fit.log_sd) - std::log(static_cast<double>(fit.noise.effect->times.size()));
}

double price_of_random_effect(double log_sd) {
  constexpr double kRange = 9.21;  // of the root's logarithm: four decades are equally plausible
  constexpr double kRootTwoPi = 2.5066;
  const double choices = 3.0 * static_cast<double>(noise_catalogue().size());  // axes of each
  return std::log(choices) + std::max(0.0, std::log(kRange / (kRootTwoPi * log_sd)));
}

void Search::describe(const std::vector<FittedEffect>& fits, double p_value) {
  const FittedEffect& f = fits.front();
  NoiseFinding finding{.name = std::string(f.noise.effect->name),
                       .sensor = std::string(name(f.noise.effect->site)),
                       .axis = axis_letter(f.noise.axis),
                       .parameter = std::string(f.noise.effect->parameter),
                       .unit = std::string(f.noise.effect->unit),
                       .value = f.noise.root,
                       .sd = f.noise.root * f.log_sd,
                       .delta_log_likelihood = f.gain,
                       .p_value = p_value,
                       .place = f.noise.effect->level ? NoiseFinding::Place::kEffects : NoiseFinding::Place::kErrorModel,
                       .time_s = f.noise.time,
                       .meaning = std::string(f.noise.effect->meaning),
                       .equation = std::string(f.noise.effect->equation),
                       .separating_manoeuvre = std::string(f.noise.effect->separating_manoeuvre)};
  for (std::size_t i = 1; i < fits.size(); ++i)
    if (const std::optional<double> odds =
            log_odds_told(f.gain - fits[i].gain, diagnose::evidence_of(f) - diagnose::evidence_of(fits[i])))
      finding.alternatives.push_back(diagnose::alternative(fits[i], *odds));
  for (const Suspicion& s : suspicions_.all)
    if (const std::optional<double> odds =
            log_odds_told(f.gain - 0.5 * s.likelihood_ratio, diagnose::evidence_of(f) - evidence_of(s)))
      finding.alternatives.push_back(alternative(s, *odds));
  std::ranges::sort(finding.alternatives, {}, &Alternative::log_odds);
  random_effects_.push_back(std::move(finding));
}

}  // namespace coast::diagnose
