// The part of the search that chooses among mean effects of the catalogue.

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "search.hpp"

namespace coast::diagnose {

namespace {

constexpr double kLinear = 0.1;     // share of a gain that the scores of a large effect do not know
constexpr double kNotLinear = 1.3;  // times what its score tells: an effect that gains more is not to be judged by scores
constexpr std::size_t kMostByRuns = 3;

}  // namespace

bool Search::was_refused(const Suspicion& s) const {
  const auto has = [&s](const std::vector<Eigen::Index>& all) { return std::ranges::find(all, s.hypothesis) != all.end(); };
  return has(refused_) || has(given_up_) || has(exchanged_);
}

Candidates Search::candidates() const {
  Candidates result;
  for (const Suspicion& s : suspicions_.all) {
    if (was_refused(s) || !(s.p_value < of_catalogue())) continue;
    result.all.push_back({.suspicion = s, .by_runs = {}});
  }
  // Nothing that is plausible explains what is left: what is not, where it is the likelier all the same.
  if (result.all.empty())
    for (const Suspicion& s : suspicions_.implausible)
      if (!was_refused(s) && evidence_of(s) > kLogOdds) result.all.push_back({.suspicion = s, .by_runs = {}});
  if (result.all.empty()) return result;
  for (const Suspicion& s : suspicions_.all) {
    if (was_refused(s)) continue;
    result.gain = std::max(result.gain, 0.5 * s.likelihood_ratio);
    result.evidence = std::max(result.evidence, evidence_of(s));
  }
  std::ranges::sort(result.all, std::ranges::greater{}, [](const Candidate& c) { return c.suspicion.log_bayes; });
  const double best = result.all.front().suspicion.log_bayes;
  std::erase_if(result.all,
                [best](const Candidate& c) { return c.suspicion.log_bayes < best - std::max(kLogOdds, kLinear * best); });
  if (result.all.size() > kMostByRuns) result.all.resize(kMostByRuns);
  return result;
}

void Search::run_without(Candidate& candidate) {
  const Suspicion& s = candidate.suspicion;
  const double before = log_likelihood_of(*run_);
  const double choice = log_choices();
  const std::vector<Taken> taken = taken_;
  Standing start = standing();
  taken_.push_back({s.hypothesis, s.from, {}, s.estimate});
  double best = likelihood_from(*start.run);
  if (run_ != nullptr) {
    const Movement moved = move_all(examined({}, 0));
    const RunPtr first = std::move(run_);
    for (std::size_t i = 0; i < taken.size(); ++i)
      if (std::abs(taken_[i].value) < kNothing * moved.sd(static_cast<Eigen::Index>(i)))
        candidate.freed += result_.findings[i].price + choice;
    best = std::max(best, likelihood_from(*first));
  }
  candidate.by_runs = best - before;
  taken_ = taken;
  return_to(std::move(start));
}

void Search::run_candidates() {
  for (Candidate& c : candidates_.all) {
    if (!c.by_runs) run_without(c);
    candidates_.gain = std::max(candidates_.gain, *c.by_runs);
    candidates_.evidence = std::max(candidates_.evidence, c.log_bayes() - log_choices());
  }
}

bool Search::exceeds_candidates(double value, double Candidates::*figure) {
  if (value > candidates_.*figure) run_candidates();
  return value > candidates_.*figure;
}

Suspicion Search::winner() {
  if (candidates_.all.size() > 1) run_candidates();
  return std::ranges::max_element(candidates_.all, {}, &Candidate::log_bayes)->suspicion;
}

bool Search::makes_likelier(const Suspicion& s) {
  constexpr int kHalvings = 4;
  const double before = log_likelihood_of(*run_);
  const std::vector<Taken> others = taken_;
  take(s);
  Standing start = standing();
  const auto gains_enough = [&](const MissionRun& last) {
    result_.findings.back().delta_log_likelihood = likelihood_from(last) - before;
    return result_.findings.back().delta_log_likelihood >= 0.5 * result_.threshold;
  };
  for (double value = s.estimate, i = 0; i <= kHalvings; ++i, value *= 0.5) {
    taken_.back().value = value;
    bool is_taken = gains_enough(*start.run);
    if (!is_taken && run_ != nullptr) {
      move_all(examined({}, 0));
      const RunPtr first = std::move(run_);
      is_taken = gains_enough(*first);
    }
    if (is_taken) {
      refused_.clear();
      return true;
    }
    std::ranges::copy(others, taken_.begin());
  }
  taken_.pop_back();
  result_.findings.pop_back();
  refused_.push_back(s.hypothesis);
  return_to(std::move(start));
  return false;
}

bool Search::take_time_offset() {
  constexpr double kFar = 0.1;  // s
  const std::optional<double> guess = std::exchange(options_.time_offset_s, std::nullopt);
  if (!guess || std::abs(*guess - input_.setup.time_offset_s) < kFar) return false;
  // Noise that was fitted there explains how nothing fits, and would explain it ever after.
  const std::optional<FittedNoise> fitted = std::exchange(noise_, std::nullopt);
  if (fitted) run_again();
  const auto at =
      std::ranges::find_if(run_->hypotheses().all(), [](const Hypothesis& h) { return h.effect->name == "gnss_time_offset"; });
  if (!makes_likelier(
          {.hypothesis = at - run_->hypotheses().all().begin(), .from = {}, .estimate = *guess - input_.setup.time_offset_s})) {
    noise_ = fitted;
    run_again();
    return false;
  }
  Finding& finding = result_.findings.back();
  finding.p_value = suspicions_.chance.p_value(2.0 * finding.delta_log_likelihood);
  finding.alternatives.clear();  // what looked like it at the configured offset
  settle();
  last_fit_.reset();
  noise_is_behind_ = true;
  if (fitted) fit_noise();
  return true;
}

void Search::reconsider(const Taken& one, double gain) {
  auto at = std::ranges::find(candidates_.all, one.hypothesis, &Candidate::hypothesis);
  if (at == candidates_.all.end()) {
    const Suspicion* suspicion = suspicions_.of(one.hypothesis);
    if (suspicion == nullptr || gain < 0.5 * result_.threshold) return;
    at = candidates_.all.insert(candidates_.all.end(), {.suspicion = *suspicion, .by_runs = {}});
  }
  at->by_runs = gain;
}

bool Search::review() {
  bool changed = false;
  for (std::size_t left = taken_.size(); left > 0; --left) {
    std::rotate(taken_.begin(), taken_.begin() + 1, taken_.end());
    std::rotate(result_.findings.begin(), result_.findings.begin() + 1, result_.findings.end());
    if (last_is_confirmed()) continue;
    changed = true;
    settle();
    forget_what_vanished();
    left = std::min(left, taken_.size() + 1);
  }
  if (changed) noise_is_behind_ = true;
  return changed;
}

bool Search::last_is_confirmed() {
  const Taken one = taken_.back();
  const Finding finding = result_.findings.back();
  const bool has_name = !is_suggested(*finding.hypothesis.effect);
  if (!has_name && finding.hypothesis.effect->relation.empty()) return true;  // nothing that has a name looks like a line
  const double with_it = log_likelihood_of(*run_);
  take_out(taken_.size() - 1);
  if (!has_name) refused_.push_back(one.hypothesis);  // among those that have one
  candidates_ = candidates();
  const double gain = with_it - log_likelihood_of(*run_);
  if (!has_name) return form_is_confirmed(one, finding, gain);
  reconsider(one, gain);
  if (candidates_.all.empty()) return false;
  Suspicion best = winner();
  if (best.hypothesis == one.hypothesis) {
    std::tie(best.from, best.estimate) = std::tie(one.from, one.value);
    if (gain > kNotLinear * 0.5 * best.likelihood_ratio) {
      best.log_bayes += gain - 0.5 * best.likelihood_ratio;
      best.likelihood_ratio = 2.0 * gain;
    }
  }
  return makes_likelier(best) && best.hypothesis == one.hypothesis;
}

bool Search::may_have_lasted(std::size_t index) const {
  return !run_->hypotheses()[taken_[index].hypothesis].effect->lasting.empty();
}

bool Search::put_lasting_in_place_of(std::size_t index) {
  const Taken one = taken_[index];
  const Hypothesis begins = run_->hypotheses()[one.hypothesis];
  take_out(index);
  candidates_ = {};
  refused_.clear();
  exchanged_.push_back(one.hypothesis);
  ++options_.most_effects;
  noise_is_behind_ = true;
  const auto is_lasting = [&](Eigen::Index hypothesis) {
    const Hypothesis& h = run_->hypotheses()[hypothesis];
    return h.effect->name == begins.effect->lasting && h.axis_name() == begins.axis_name();
  };
  const auto share = std::ranges::find_if(taken_, is_lasting, &Taken::hypothesis);
  const bool is_taken = share != taken_.end();
  if (is_taken) {
    share->value += one.value;
  } else {
    const auto lasting = std::ranges::find_if(suspicions_.all, is_lasting, &Suspicion::hypothesis);
    if (lasting == suspicions_.all.end() || was_refused(*lasting)) return false;
    Suspicion from_the_start = *lasting;
    from_the_start.estimate = one.value;
    take(from_the_start);
  }
  const RunPtr without_it = std::move(run_);
  const double gained = likelihood_from(*without_it) - log_likelihood_of(*without_it);
  if (!is_taken) result_.findings.back().delta_log_likelihood = gained;
  return run_ != nullptr;
}

bool Search::put_constant_in_place_of_bias(std::size_t index) {
  const TurnOn bias = turned_on_[index];
  refused_.clear();  // beside the bias that has all of it
  const std::optional<Suspicion> constant = constant_like(bias, *run_);
  const auto is_taken = [&](const Taken& one) { return one.hypothesis == constant->hypothesis; };
  if (!constant || is_shared(bias) || was_refused(*constant) || std::ranges::any_of(taken_, is_taken)) return false;
  candidates_ = {};
  ++options_.most_effects;
  noise_is_behind_ = true;
  share(bias);
  take(*constant);
  const RunPtr without_it = std::move(run_);
  result_.findings.back().delta_log_likelihood = likelihood_from(*without_it) - log_likelihood_of(*without_it);
  if (run_ != nullptr) run_again();  // sensors are found anew about what is left of the bias
  return run_ != nullptr;
}

std::optional<double> log_odds_told(double by_data, double by_evidence) {
  const double odds = std::max(by_data, by_evidence);
  return odds < kLogOdds ? std::optional(odds) : std::nullopt;
}

std::optional<double> Search::gained_by_runs(const Suspicion& s) const {
  const auto at = std::ranges::find(candidates_.all, s.hypothesis, &Candidate::hypothesis);
  return at != candidates_.all.end() ? at->by_runs : std::nullopt;
}

Alternative Search::alternative(const Suspicion& s, double log_odds) const {
  const Hypothesis& h = run_->hypotheses()[s.hypothesis];
  return {std::string(h.effect->name), std::string(name(h.effect->site)), h.axis_name(), log_odds};
}

void Search::take(const Suspicion& s) {
  taken_.push_back({s.hypothesis, s.from, {}, s.estimate});
  const Hypotheses& hypotheses = run_->hypotheses();
  Finding finding{.hypothesis = hypotheses[s.hypothesis],
                  .from = s.from,
                  .to = {},
                  .from_sd_s = s.from_sd_s,
                  .value = s.estimate,
                  .sd = s.sd,
                  .p_value = s.p_value,
                  .price = s.price(),
                  .held_out_gain = {},
                  .alternatives = {},
                  .stability = {}};
  const auto tell = [&](const Suspicion& other) {
    if (other.hypothesis == s.hypothesis || std::ranges::find(exchanged_, other.hypothesis) != exchanged_.end()) return;
    const double by_data = gained_by_runs(s) && gained_by_runs(other) ? *gained_by_runs(s) - *gained_by_runs(other)
                                                                      : 0.5 * (s.likelihood_ratio - other.likelihood_ratio);
    if (const auto odds = log_odds_told(by_data, by_data + other.price() - s.price()))
      finding.alternatives.push_back(alternative(other, *odds));
  };
  std::ranges::for_each(suspicions_.all, tell);
  std::ranges::for_each(suspicions_.implausible, tell);
  for (const FittedEffect& fit : beaten_)
    if (const auto odds = log_odds_told(0.5 * s.likelihood_ratio - fit.gain, evidence_of(s) - diagnose::evidence_of(fit)))
      finding.alternatives.push_back(diagnose::alternative(fit, *odds));
  std::ranges::sort(finding.alternatives, {}, &Alternative::log_odds);
  result_.findings.push_back(std::move(finding));
}

}  // namespace coast::diagnose
