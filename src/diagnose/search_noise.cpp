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

/// The log-likelihood over the logarithm of the correlation time, and how the root follows it.
struct OverTime {
  double time = 0.0;        ///< of the vertex
  double log_sd = 0.0;      ///< of the time
  double root_slope = 0.0;  ///< of the root's logarithm
};
OverTime over_time(const FittedEffect& shorter, const FittedEffect& best, const FittedEffect& longer) {
  constexpr double kFlat = 0.01;  // nothing is said of the time within a factor of a thousand
  const double down = std::log(shorter.noise.time / best.noise.time), up = std::log(longer.noise.time / best.noise.time);
  // Through (down, a), (0, 0), (up, b): y = p x + q x^2.
  const double a = (shorter.gain - best.gain) / down, b = (longer.gain - best.gain) / up;
  const double q = std::min((b - a) / (up - down), -kFlat);
  const double p = a - q * down;
  return {best.noise.time * std::exp(std::clamp(-0.5 * p / q, down, up)), 1.0 / std::sqrt(-2.0 * q),
          std::log(longer.noise.root / shorter.noise.root) / (up - down)};
}

}  // namespace

void Search::look_at_samples() {
  for (const SampleEffect& effect : sample_catalogue())
    for (int axis = 0; axis < 3; ++axis) {
      const std::optional<double> found = effect.find(axis_series(input_, effect.site, axis));
      if (!found) continue;
      const double before = log_likelihood_of(*run_);
      MissionInput modelled = input_;
      model_noise(modelled);  // noise is raised beside what was fitted
      effect.model(modelled, effect.site, axis, *found);
      std::swap(input_.imu, modelled.imu);
      run_again();
      const double gained = log_likelihood_of(*run_) - before;
      marks_.push_back({&effect, axis, *found});
      if (gained > kLeastOfSamples) {
        result_.noise.push_back(described(marks_.back(), gained));
        continue;
      }
      std::swap(input_.imu, modelled.imu);
      run_again();
    }
}

NoiseFinding described(const Mark& mark, double gained) {
  const SampleEffect& effect = *mark.effect;
  return {.name = std::string(effect.name),
          .sensor = std::string(name(effect.site)),
          .axis = axis_letter(mark.axis),
          .parameter = std::string(effect.parameter),
          .unit = std::string(effect.unit),
          .value = mark.parameter,
          .sd = 0.0,
          .delta_log_likelihood = gained,
          .p_value = std::exp(-gained),
          .place = NoiseFinding::Place::kEffects,
          .meaning = std::string(effect.meaning),
          .equation = std::string(effect.equation),
          .separating_manoeuvre = std::string(effect.separating_manoeuvre)};
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
  const double before = log_likelihood_of(*run_);
  const FittedNoise last = *std::exchange(noise_, std::nullopt);
  Standing start = standing();
  run_again();
  fit_noise();
  if (log_likelihood_of(*run_) > before) return true;
  noise_ = last;  // a part of a long mission is not all of it
  return_to(std::move(start));
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
  if (const std::optional<AddedNoise> before = drop_same(first->noise)) {
    AddedNoise both = fits.front().noise;
    both.root = std::hypot(both.root, before->root);
    fits.front() = fitted(both);
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

std::optional<AddedNoise> Search::drop_same(const AddedNoise& noise) {
  const auto same =
      std::ranges::find_if(added_, [&](const AddedNoise& one) { return one.effect == noise.effect && one.axis == noise.axis; });
  if (same == added_.end()) return std::nullopt;
  const AddedNoise dropped = *same;
  random_effects_.erase(random_effects_.begin() + (same - added_.begin()));
  added_.erase(same);
  run_again();
  return dropped;
}

FittedEffect Search::fitted(const AddedNoise& noise) const {
  return fitted_effect(noise, current_, run_->layout(), run_->log_likelihood());
}

FittedEffect Search::fitted_in_time(FittedEffect fit) const {
  const std::vector<double>& times = fit.noise.effect->times;
  const auto at_time = [&](double time) {
    AddedNoise noise = fit.noise;
    noise.time = time;
    return fitted(noise);
  };
  std::vector<std::optional<FittedEffect>> fits(times.size());
  auto best = static_cast<std::size_t>(std::ranges::find(times, fit.noise.time) - times.begin());
  fits[best] = fit;
  for (bool uphill = true; uphill;) {
    uphill = false;
    for (std::size_t k = best > 0 ? best - 1 : 0; k < std::min(best + 2, times.size()); ++k) {
      if (!fits[k]) fits[k] = at_time(times[k]);
      if (fits[k]->gain <= fits[best]->gain) continue;
      best = k;
      uphill = true;
      break;
    }
  }
  if (times.size() < 2) return *fits[best];
  // At an end of the table one step more says whether the likelihood falls there.
  const FittedEffect shorter = best > 0 ? *fits[best - 1] : at_time(times[0] * times[0] / times[1]);
  const FittedEffect longer = best + 1 < times.size() ? *fits[best + 1] : at_time(times[best] * times[best] / times[best - 1]);
  const OverTime over = over_time(shorter, *fits[best], longer);
  FittedEffect between = at_time(over.time);
  if (!(between.gain > fits[best]->gain)) between = *fits[best];
  between.log_sd = std::hypot(between.log_sd, over.root_slope * over.log_sd);
  between.log_time_sd = over.log_sd;
  return between;
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
                       .time_sd_s = f.noise.time * f.log_time_sd,
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
