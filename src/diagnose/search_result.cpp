// What the search found, in the words and the order that people want.

#include <algorithm>
#include <cmath>
#include <utility>

#include "search.hpp"

namespace coast::diagnose {

Diagnosis Search::finish() {
  describe_what_was_not_found();
  for (std::size_t i = 0; i < result_.findings.size(); ++i) result_.findings[i].value = taken_[i].value;
  name_relations();
  fold_residues();
  std::ranges::move(noise_findings(), std::back_inserter(result_.noise));
  std::ranges::move(random_effects_, std::back_inserter(result_.noise));
  std::ranges::transform(turned_on_, std::back_inserter(result_.noise), described_bias);
  join_entries_with_exits();
  join_quadratures();
  std::ranges::stable_sort(result_.findings, std::ranges::greater{}, &Finding::delta_log_likelihood);
  result_.suggested.insert(result_.suggested.end(), suggested_.begin(), suggested_.end());
  result_.after = run_->fit();
  const auto epochs = static_cast<double>(run_->solution().forward.innovations.size());
  result_.outage_change = outage_difference(result_.before, result_.after);
  result_.innovations_after = run_->solution().forward.innovations;
  result_.modelled = modelled();
  double of_biases = forgotten_;
  for (const TurnOn& one : turned_on_) of_biases += one.gain();
  result_.after.log_likelihood_per_epoch += of_biases / epochs;
  return std::move(result_);
}

void Search::look_at_start() {
  std::vector<TurnOn> told = std::exchange(turned_on_, beyond_stated(*run_));
  for (TurnOn& one : turned_on_)
    for (TurnOn& before : told)
      if (before.sensor == one.sensor && before.axis == one.axis) one.alternatives = std::move(before.alternatives);
}

MissionInput Search::modelled() const {
  MissionInput input = current_;
  for (const TurnOn& one : turned_on_) widen(one, input);
  return input;
}

std::vector<Alternative> Search::found() const {
  std::vector<Alternative> all;
  for (const Finding& f : result_.findings)
    all.push_back(
        {std::string(f.hypothesis.effect->name), std::string(name(f.hypothesis.effect->site)), f.hypothesis.axis_name(), 0.0});
  const auto add = [&all](const NoiseFinding& f) { all.push_back({f.name, f.sensor, f.axis, 0.0}); };
  std::ranges::for_each(noise_findings(), add);
  std::ranges::for_each(random_effects_, add);
  std::ranges::for_each(turned_on_, add, described_bias);
  return all;
}

void Search::tell_of(const Search& other, double log_odds) {
  if (log_odds > kLogOdds) return;
  const auto same = [](const Alternative& a) {
    return [&a](const Alternative& b) { return a.name == b.name && a.sensor == b.sensor && a.axis == b.axis; };
  };
  const std::vector<Alternative> ours = found();
  const std::vector<Alternative> theirs = other.found();
  const auto add = [&](const Alternative& explained, std::vector<Alternative>& alternatives) {
    if (std::ranges::any_of(theirs, same(explained))) return;
    for (const Alternative& one : theirs) {
      if (std::ranges::any_of(ours, same(one))) continue;
      std::erase_if(alternatives, same(one));
      alternatives.push_back({one.name, one.sensor, one.axis, log_odds});
    }
    std::ranges::sort(alternatives, {}, &Alternative::log_odds);
  };
  for (std::size_t i = 0; i < result_.findings.size(); ++i) add(ours[i], result_.findings[i].alternatives);
  for (NoiseFinding& f : random_effects_) add({f.name, f.sensor, f.axis, 0.0}, f.alternatives);
  for (TurnOn& one : turned_on_) {
    const NoiseFinding f = described_bias(one);
    add({f.name, f.sensor, f.axis, 0.0}, one.alternatives);
  }
}

std::vector<NoiseFinding> Search::noise_findings() const {
  std::vector<NoiseFinding> findings;
  if (!noise_) return findings;
  for (const NoiseFinding& f : noise_->findings)
    if (!asked_for_ || (f.sensor == "gnss" ? !asked_for_->gnss_scale : !asked_for_->imu_white_noise)) findings.push_back(f);
  return findings;
}

void Search::fold_residues() {
  for (const Mark& mark : marks_) {
    if (mark.effect->residue == nullptr) continue;
    const auto is_of_the_axis = [&](const NoiseFinding& f) {
      return f.sensor == name(mark.effect->site) && f.axis == axis_letter(mark.axis);
    };
    // What depends on the signal may be what is left of the steps, which does so too.
    for (Finding& f : result_.findings)
      if (f.hypothesis.effect->site == mark.effect->site && f.hypothesis.axis_name().starts_with(axis_letter(mark.axis)))
        f.alternatives.insert(f.alternatives.begin(), {std::string(mark.effect->name), std::string(name(mark.effect->site)),
                                                       axis_letter(mark.axis), 0.0});
    double gained = 0.0;
    std::erase_if(random_effects_, [&](const NoiseFinding& f) {
      const bool is_part =
          is_of_the_axis(f) && f.place == NoiseFinding::Place::kErrorModel && f.value < mark.effect->residue(mark.parameter);
      if (is_part) gained += f.delta_log_likelihood;
      return is_part;
    });
    if (gained == 0.0) continue;
    const auto told = std::ranges::find_if(
        result_.noise, [&](const NoiseFinding& f) { return f.name == mark.effect->name && is_of_the_axis(f); });
    if (told != result_.noise.end()) {
      told->delta_log_likelihood += gained;
      continue;
    }
    result_.noise.push_back(described(mark, gained));
    result_.noise.back().place = NoiseFinding::Place::kErrorModel;  // the noise of a step makes nothing likelier
  }
}

void Search::name_relations() {
  constexpr double kSame = 1e-6;  // of the variance: rounding
  std::vector<Finding>& all = result_.findings;
  if (std::ranges::all_of(all, [](const Finding& f) { return f.hypothesis.effect->relation.empty(); })) return;
  const Eigen::MatrixXd information = examined({}, 0).information;
  const Hypotheses& hypotheses = run_->hypotheses();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].hypothesis.effect->relation.empty()) continue;
    const Eigen::Index relation = taken_[i].hypothesis;
    for (Eigen::Index h = 0; h < hypotheses.size(); ++h) {
      const double scale = information(relation, h) / information(h, h);
      const bool is_same = scale * information(relation, h) > (1.0 - kSame) * information(relation, relation);
      if (!is_same || is_suggested(*hypotheses[h].effect) || hypotheses[h].begins_at_some_time()) continue;
      all[i].hypothesis = hypotheses[h];
      all[i].value *= scale;
      all[i].sd *= std::abs(scale);
      all[i].stability.reset();
      std::erase_if(all[i].alternatives, [&](const Alternative& a) {
        return a.name == hypotheses[h].effect->name && a.axis == hypotheses[h].axis_name() &&
               a.sensor == name(hypotheses[h].effect->site);
      });
      break;
    }
  }
}

void Search::join_entries_with_exits() {
  constexpr double kEqual = 4.0;  // sd of the sum
  std::vector<Finding>& all = result_.findings;
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = 0; j < all.size(); ++j) {
      Finding& entry = all[i];
      const Finding& exit = all[j];
      if (entry.to || exit.to || entry.hypothesis.effect != exit.hypothesis.effect ||
          entry.hypothesis.axis != exit.hypothesis.axis || !entry.from || !exit.from || !(*entry.from < *exit.from) ||
          std::abs(entry.value + exit.value) > kEqual * std::hypot(entry.sd, exit.sd))
        continue;
      entry.to = exit.from;
      entry.delta_log_likelihood += exit.delta_log_likelihood;
      all.erase(all.begin() + static_cast<std::ptrdiff_t>(j));
      i = 0;
      j = 0;
    }
}

void Search::join_quadratures() {
  std::vector<Finding>& all = result_.findings;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Hypothesis h = all[i].hypothesis;
    if (h.effect->name != "harmonic_disturbance") continue;
    const bool both = i + 1 < all.size() && all[i + 1].hypothesis.effect == h.effect;
    // One of them may have been given up.
    const double sine = h.axis == 0 ? all[i].value : 0.0;
    const double cosine = both ? all[i + 1].value : all[i].value - sine;
    const double phase = h.effect->fixed[1].value + std::atan2(cosine, sine);
    result_.suggested.push_back(
        harmonic_disturbance(h.effect->site, h.effect->axes.front().front() - 'x', h.effect->fixed[0].value, phase));
    all[i].hypothesis = {result_.suggested.back().get(), 0, h.plausible};
    all[i].value = std::hypot(sine, cosine);
    if (!both) continue;
    all[i].sd = std::max(all[i].sd, all[i + 1].sd);
    all.erase(all.begin() + static_cast<std::ptrdiff_t>(i) + 1);
  }
}

void Search::describe_what_was_not_found() {
  const Hypotheses& hypotheses = run_->hypotheses();
  std::vector<bool> told(static_cast<std::size_t>(hypotheses.size()), false);
  for (const Taken& one : taken_) told[static_cast<std::size_t>(one.hypothesis)] = true;
  // Of forms that a recording suggested and that were given up nothing is to be said.
  for (Eigen::Index i = 0; i < hypotheses.size(); ++i)
    if (is_suggested(*hypotheses[i].effect)) told[static_cast<std::size_t>(i)] = true;
  for (const Suspicion& s : suspicions_.all) {
    if (told[static_cast<std::size_t>(s.hypothesis)]) continue;
    told[static_cast<std::size_t>(s.hypothesis)] = true;
    result_.detectable_not_found.push_back({hypotheses[s.hypothesis], minimal_detectable(s.usual_sd, result_.threshold)});
  }
  for (Eigen::Index i = 0; i < hypotheses.size(); ++i)
    if (!told[static_cast<std::size_t>(i)])
      result_.not_observable.push_back({hypotheses[i], "of what is plausible this mission shows nothing"});
  for (const Effect& effect : catalogue())
    if (const char* reason = hypotheses.why_not_seen(effect)) result_.not_observable.push_back({{&effect, 0, 0.0}, reason});
}

}  // namespace coast::diagnose
