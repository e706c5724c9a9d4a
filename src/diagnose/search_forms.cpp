// The part of the search that looks at lines and relations, which no catalogue has.

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "search.hpp"

namespace coast::diagnose {

namespace {

constexpr double kStable = 0.5;  // of a relation, from where it is believed

}  // namespace

std::optional<Proposal> Search::likeliest_form(const Examination& examination) const {
  std::optional<Proposal> best;
  for (const std::optional<Proposal>& form : {strongest_line(examination), likeliest_relation(examination, *run_)}) {
    if (!form || form->p_value > kFormFalseAlarm || form->stability < kStable || was_refused(*form)) continue;
    if (!best || form->likelihood_ratio - 2.0 * form->log_places > best->likelihood_ratio - 2.0 * best->log_places) best = form;
  }
  return best;
}

bool Search::was_refused(const Proposal& form) const {
  return std::ranges::any_of(refused_forms_, [&](const EffectPtr& e) {
    return e->name == form.effect->name && e->site == form.effect->site && e->axes == form.effect->axes &&
           e->relation == form.effect->relation;
  });
}

EffectPtr Search::refined(const EffectPtr& line) {
  constexpr int kSide = 6;
  constexpr double kStep = 0.1;  // of a line's width
  const double span = run_->mission().imu.samples.back().t - run_->mission().imu.samples.front().t;
  const std::vector<EffectPtr> before = suggested_;
  std::vector<EffectPtr> lines;
  for (int i = -kSide; i <= kSide; ++i)
    lines.push_back(harmonic_disturbance(line->site, line->axes.front().front() - 'x', line->fixed[0].value + i * kStep / span,
                                         line->fixed[1].value));
  suggested_.insert(suggested_.end(), lines.begin(), lines.end());
  const RunPtr start = std::move(run_);
  run_from(*start);
  const Examination e = examined({}, 0);
  const auto first = static_cast<Eigen::Index>(run_->hypotheses().size()) - 2 * static_cast<Eigen::Index>(lines.size());
  std::vector<double> ratio;
  for (Eigen::Index at = first; at < run_->hypotheses().size(); at += 2) {
    const Eigen::Vector2d score = e.score.segment<2>(at);
    ratio.push_back(score.dot(Eigen::Matrix2d(e.information.block<2, 2>(at, at)).ldlt().solve(score)));
  }
  const auto best = static_cast<std::size_t>(std::ranges::max_element(ratio) - ratio.begin());
  double shift = 0.0;  // of the vertex of the parabola through the largest and its neighbours
  if (best > 0 && best + 1 < ratio.size())
    shift = 0.5 * (ratio[best + 1] - ratio[best - 1]) / (2.0 * ratio[best] - ratio[best - 1] - ratio[best + 1]);
  suggested_ = before;
  run_from(*start);
  return harmonic_disturbance(line->site, line->axes.front().front() - 'x', lines[best]->fixed[0].value + shift * kStep / span,
                              line->fixed[1].value);
}

void Search::try_out(const Proposal& form) {
  const double before = log_likelihood_of(*run_);
  const std::vector<Taken> taken = taken_;
  const std::vector<Finding> findings = result_.findings;
  suggested_.push_back(form.effect->relation.empty() ? refined(form.effect) : form.effect);
  Standing start = standing();
  run_from(*start.run);
  const auto first = static_cast<Eigen::Index>(run_->hypotheses().size()) - static_cast<Eigen::Index>(form.effect->axes.size());
  for (Eigen::Index i = first; i < run_->hypotheses().size(); ++i)
    take({.hypothesis = i,
          .from = {},
          .likelihood_ratio = form.likelihood_ratio,
          .log_bayes = 0.5 * form.likelihood_ratio - form.log_places,
          .p_value = form.p_value});
  static_cast<void>(follow(examined({}, 0)));
  const RunPtr without_it = std::move(run_);
  const double gained = likelihood_from(*without_it) - before;
  if (gained - form.log_places > std::max(candidates_.gain, -std::log(kFormFalseAlarm))) {
    refused_.clear();
    noise_is_behind_ = true;
    Finding& found = result_.findings[taken.size()];
    found.delta_log_likelihood = gained;
    if (form.effect->relation.empty()) return;
    found.stability = form.stability;
    relation_ = {form.effect, before};
    return;
  }
  refused_forms_.push_back(form.effect);
  suggested_.pop_back();
  taken_ = taken;
  result_.findings = findings;
  return_to(std::move(start));
}

bool Search::give_up_what_bends() {
  if (!relation_ || log_likelihood_of(*run_) >= relation_->without) return false;
  const auto is_it = [this](const Finding& f) { return f.hypothesis.effect == relation_->effect.get(); };
  const auto found = std::ranges::find_if(result_.findings, is_it);
  if (found == result_.findings.end()) return false;  // something that has a name took its place
  give_up(static_cast<std::size_t>(found - result_.findings.begin()));
  return true;
}

bool Search::form_is_confirmed(const Taken& form, const Finding& finding, double gain) {
  if (!candidates_.all.empty() && !exceeds_candidates(gain - finding.price, &Candidates::gain) && makes_likelier(winner())) {
    refused_forms_.push_back(*std::ranges::find(suggested_, finding.hypothesis.effect, &EffectPtr::get));
    return false;
  }
  taken_.push_back(form);
  result_.findings.push_back(finding);
  run_again();
  return true;
}

}  // namespace coast::diagnose
