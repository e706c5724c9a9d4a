#include "search/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "coast/parallel.hpp"
#include "search/movement.hpp"

namespace coast::diagnose {

namespace {

constexpr double kLinear = 0.1;  // fraction of a large effect's gain by which its score may be wrong
constexpr std::size_t kMostByRuns = 3;

/// How much likelier another time of an effect is where it happened before than where it did not. Rates with Jeffreys' prior:
/// n + 1/2 more are expected, against 1/2. Sizes in one mission are alike, and are the prior's scale.
double log_odds_of_another(const Suspicion& s, const Hypothesis& h, std::vector<double> sizes) {
  if (sizes.empty()) return 0.0;
  const double information = 1.0 / (s.sd * s.sd);
  const double score = s.estimate * information;
  const double rate = std::log(2.0 * static_cast<double>(sizes.size()) + 1.0);
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::ranges::nth_element(sizes, middle);
  return rate + log_bayes_factor(score, information, *middle) - log_bayes_factor(score, information, h.plausible);
}

/// Of the times of an effect among the findings.
std::vector<double> sizes_of(const Effect& effect, const Account& account) {
  std::vector<double> sizes;
  for (const Finding& f : account.findings)
    if (f.hypothesis.effect == &effect) sizes.push_back(std::abs(f.value));
  return sizes;
}

}  // namespace

double evidence_of(const Suspicion& s, const State& state) {
  return s.log_bayes - log_choices(state);
}

Candidates::Candidates(const State& state, Context& context) : state_(&state), context_(&context) {
  find();
  if (all_.empty()) return;
  bound();
  std::ranges::sort(all_, std::ranges::greater{}, [](const Candidate& c) { return c.suspicion.log_bayes; });
  const double best = all_.front().suspicion.log_bayes;
  const double least = best - std::max(kLogOdds, kLinear * best);
  std::erase_if(all_, [least](const Candidate& c) { return c.suspicion.log_bayes < least; });
  if (all_.size() > kMostByRuns) all_.resize(kMostByRuns);
}

std::vector<Suspicion> Candidates::possible(const std::vector<Suspicion>& suspicions) const {
  std::vector<Suspicion> all;
  for (const Suspicion& s : suspicions) {
    if (state_->excluded.excludes(s.hypothesis)) continue;
    all.push_back(s);
    const Hypothesis& h = state_->run->hypotheses()[s.hypothesis];
    if (h.effect->repeats()) all.back().log_bayes += log_odds_of_another(s, h, sizes_of(*h.effect, state_->account));
  }
  return all;
}

void Candidates::find() {
  const Suspicions& suspicions = state_->seen.suspicions;
  const double false_alarm = context_->false_alarm_of_catalogue();
  for (const Suspicion& s : possible(suspicions.all))
    if (s.p_value < false_alarm) all_.push_back({s});
  // No plausible effect explains the remainder: use implausible ones, if they are likelier nevertheless.
  if (!all_.empty()) return;
  for (const Suspicion& s : possible(suspicions.implausible))
    if (evidence_of(s, *state_) > kLogOdds) all_.push_back({s});
}

void Candidates::bound() {
  for (const Suspicion& s : possible(state_->seen.suspicions.all)) {
    gain_ = std::max(gain_, 0.5 * s.likelihood_ratio);
    evidence_ = std::max(evidence_, evidence_of(s, *state_));
  }
}

bool Candidates::gain_is_exceeded_by(double gain) {
  if (gain > gain_) run_all();
  return gain > gain_;
}

bool Candidates::evidence_is_exceeded_by(double evidence) {
  if (evidence > evidence_) run_all();
  return evidence > evidence_;
}

// Each is run with its estimate and with the next one: scores are linear about zero, and for a large effect wrong by tens of
// percent.
void Candidates::run_all() {
  std::vector<Candidate*> pending;
  std::vector<Runs::Request> requests;
  for (Candidate& c : all_) {
    if (c.by_runs) continue;
    const Suspicion& s = c.suspicion;
    pending.push_back(&c);
    requests.push_back({state_->explanation.with({s.hypothesis, s.from, {}, s.estimate}), state_->run});
  }
  if (pending.empty()) return;
  const std::vector<RunPtr> first = context_->runs.try_all(requests);
  std::vector<std::optional<Movement>> steps(first.size());
  coast::parallel_for(std::size_t{0}, first.size(), [&](std::size_t i) {
    if (first[i]) steps[i] = movement(first[i]->sizes());
  });
  std::vector<Runs::Request> next;
  for (std::size_t i = 0; i < first.size(); ++i)
    if (first[i]) next.push_back({moved(first[i]->explanation(), *steps[i]), first[i]});
  const std::vector<RunPtr> second = context_->runs.try_all(next);
  for (std::size_t i = 0, k = 0; i < pending.size(); ++i) {
    pending[i]->by_runs = -std::numeric_limits<double>::infinity();
    if (first[i]) note_runs(*pending[i], *first[i], *steps[i], second[k++].get());
  }
  for (const Candidate& c : all_) {
    gain_ = std::max(gain_, *c.by_runs);
    evidence_ = std::max(evidence_, c.log_bayes() - log_choices(*state_));
  }
}

void Candidates::note_runs(Candidate& candidate, const ExplainedRun& first, const Movement& step, const ExplainedRun* second) {
  const Explanation next = moved(first.explanation(), step);
  for (std::size_t i = 0; i < state_->explanation.effects.size(); ++i)
    if (std::abs(next.effects[i].value) < kInsignificant * step.sd(static_cast<Eigen::Index>(i)) &&
        !is_of_a_line(state_->account.findings[i]))
      candidate.freed += state_->account.findings[i].price + log_choices(*state_);
  double best = first.log_likelihood();
  if (second != nullptr) best = std::max(best, second->log_likelihood());
  candidate.by_runs = best - state_->run->log_likelihood();
}

Suspicion Candidates::likeliest() {
  if (all_.size() > 1) run_all();
  return std::ranges::max_element(all_, {}, &Candidate::log_bayes)->suspicion;
}

void Candidates::add_selected(Eigen::Index hypothesis, double gain) {
  auto at = std::ranges::find(all_, hypothesis, &Candidate::hypothesis);
  if (at == all_.end()) {
    const Suspicion* suspicion = state_->seen.suspicions.of(hypothesis);
    if (suspicion == nullptr || gain < 0.5 * threshold(*state_, *context_)) return;
    at = all_.insert(all_.end(), {*suspicion});
  }
  at->by_runs = gain;
}

std::optional<double> Candidates::gained_by_runs(Eigen::Index hypothesis) const {
  const auto at = std::ranges::find(all_, hypothesis, &Candidate::hypothesis);
  return at != all_.end() ? at->by_runs : std::nullopt;
}

}  // namespace coast::diagnose
