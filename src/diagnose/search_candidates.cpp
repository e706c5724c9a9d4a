// The part of the search that chooses among mean effects of the catalogue.

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "search.hpp"

namespace coast::diagnose {

namespace {

constexpr double kLinear = 0.1;  // share of a gain that the scores of a large effect do not know
constexpr std::size_t kMostByRuns = 3;

}  // namespace

bool Search::was_refused(const Suspicion& s) const {
  return std::ranges::find(refused_, s.hypothesis) != refused_.end() ||
         std::ranges::find(given_up_, s.hypothesis) != given_up_.end();
}

Candidates Search::candidates() const {
  Candidates result;
  for (const Suspicion& s : suspicions_.all) {
    if (was_refused(s) || !(s.p_value < of_catalogue())) continue;
    result.all.push_back({s, {}});
  }
  if (result.all.empty()) return result;
  for (const Suspicion& s : suspicions_.all)
    if (!was_refused(s)) result.gain = std::max(result.gain, 0.5 * s.likelihood_ratio);
  std::ranges::sort(result.all, std::ranges::greater{}, [](const Candidate& c) { return c.suspicion.log_bayes; });
  const double best = result.all.front().suspicion.log_bayes;
  std::erase_if(result.all,
                [best](const Candidate& c) { return c.suspicion.log_bayes < best - std::max(kLogOdds, kLinear * best); });
  if (result.all.size() > kMostByRuns) result.all.resize(kMostByRuns);
  return result;
}

double Search::gain_by_runs(const Suspicion& s) {
  const double before = run_->log_likelihood();
  const std::vector<Taken> taken = taken_;
  const MissionInput input = current_;
  std::unique_ptr<MissionRun> start = std::move(run_);
  taken_.push_back({s.hypothesis, s.from, {}, s.estimate});
  run_from(*start);
  const double first = run_->log_likelihood() - before;
  const Movement moved = movement(examined({}, 0), taken_);
  for (std::size_t i = 0; i < taken_.size(); ++i)
    if (i + 1 == taken_.size() || (!taken_[i].from && !s.from)) taken_[i].value += moved.by[i];
  run_again();
  const double second = run_->log_likelihood() - before;
  taken_ = taken;
  current_ = input;
  run_ = std::move(start);
  return std::max(first, second);
}

void Search::run_candidates() {
  for (Candidate& c : candidates_.all) {
    if (!c.by_runs) c.by_runs = gain_by_runs(c.suspicion);
    candidates_.gain = std::max(candidates_.gain, *c.by_runs);
  }
}

bool Search::beats_candidates(double gain) {
  if (gain > candidates_.gain) run_candidates();
  return gain > candidates_.gain;
}

Suspicion Search::winner() {
  if (candidates_.all.size() > 1) run_candidates();
  return std::ranges::max_element(candidates_.all, {}, &Candidate::log_bayes)->suspicion;
}

bool Search::makes_likelier(const Suspicion& s) {
  constexpr int kHalvings = 4;
  const double before = run_->log_likelihood();
  take(s);
  const std::unique_ptr<MissionRun> start = std::move(run_);
  for (int i = 0; i <= kHalvings; ++i, taken_.back().value *= 0.5) {
    run_from(*start);
    const double gained = run_->log_likelihood() - before;
    if (gained < 0.5 * result_.threshold) continue;
    result_.findings.back().delta_log_likelihood = gained;
    refused_.clear();
    return true;
  }
  taken_.pop_back();
  result_.findings.pop_back();
  refused_.push_back(s.hypothesis);
  run_from(*start);
  return false;
}

bool Search::take_time_offset() {
  constexpr double kFar = 0.1;  // s
  const std::optional<double> guess = std::exchange(options_.time_offset_s, std::nullopt);
  if (!guess || std::abs(*guess - input_.setup.time_offset_s) < kFar) return false;
  const auto at =
      std::ranges::find_if(run_->hypotheses().all(), [](const Hypothesis& h) { return h.effect->name == "gnss_time_offset"; });
  if (!makes_likelier(
          {.hypothesis = at - run_->hypotheses().all().begin(), .from = {}, .estimate = *guess - input_.setup.time_offset_s}))
    return false;
  Finding& finding = result_.findings.back();
  finding.p_value = suspicions_.chance.p_value(2.0 * finding.delta_log_likelihood);
  finding.alternatives.clear();  // what looked like it at the configured offset
  fit_noise_again();
  return true;
}

bool Search::review() {
  bool changed = false;
  for (std::size_t left = taken_.size(); left > 0; --left) {
    std::rotate(taken_.begin(), taken_.begin() + 1, taken_.end());
    std::rotate(result_.findings.begin(), result_.findings.begin() + 1, result_.findings.end());
    const Taken one = taken_.back();
    if (is_suggested(*run_->hypotheses()[one.hypothesis].effect)) continue;
    taken_.pop_back();
    result_.findings.pop_back();
    run_again();
    const LargestByChance chance = suspicions_.chance;
    suspicions_ = suspicions(examined({}, 0), run_->hypotheses(), of_whole_mission());
    suspicions_.judge(chance);
    candidates_ = candidates();
    if (candidates_.all.empty()) {
      changed = true;
      continue;
    }
    Suspicion best = winner();
    if (best.hypothesis == one.hypothesis) std::tie(best.from, best.estimate) = std::tie(one.from, one.value);
    if (!makes_likelier(best) || best.hypothesis != one.hypothesis) changed = true;
  }
  return changed;
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
                  .held_out_gain = {},
                  .alternatives = {},
                  .stability = {}};
  for (const Suspicion& other : suspicions_.all)
    if (other.hypothesis != s.hypothesis &&
        (s.log_bayes - other.log_bayes < kLogOdds || s.likelihood_ratio - other.likelihood_ratio < 2.0 * kLogOdds))
      finding.alternatives.push_back(
          alternative(other, std::max(s.log_bayes - other.log_bayes, 0.5 * (s.likelihood_ratio - other.likelihood_ratio))));
  for (const FittedEffect& fit : beaten_)
    if (0.5 * s.likelihood_ratio - fit.gain < kLogOdds)
      finding.alternatives.push_back(diagnose::alternative(fit, 0.5 * s.likelihood_ratio));
  std::ranges::sort(finding.alternatives, {}, &Alternative::log_odds);
  result_.findings.push_back(std::move(finding));
}

}  // namespace coast::diagnose
