#include "verdict/names.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "search/begin.hpp"

namespace coast::diagnose {

namespace {

/// The effect of the catalogue that is the same function of the mission as a relation, and its size for a unit of the
/// relation.
struct NamedRelation {
  Hypothesis hypothesis;
  double scale = 1.0;
};
std::optional<NamedRelation> named(Eigen::Index relation, const State& state) {
  constexpr double kSame = 1e-6;  // of the variance: rounding
  const Eigen::MatrixXd& information = state.run->scores().information;
  const Hypotheses& hypotheses = state.run->hypotheses();
  for (Eigen::Index h = 0; h < hypotheses.size(); ++h) {
    const double scale = information(relation, h) / information(h, h);
    const bool is_same = scale * information(relation, h) > (1.0 - kSame) * information(relation, relation);
    if (!is_same || state.explanation.is_suggested(*hypotheses[h].effect) || hypotheses[h].begins_at_some_time()) continue;
    return NamedRelation{hypotheses[h], scale};
  }
  return std::nullopt;
}

/// Removes random effects not larger than the noise left by a mark. @return  their gain in log-likelihood
double taken_from(std::vector<NoiseFinding>& random, const Mark& mark) {
  double gained = 0.0;
  std::erase_if(random, [&](const NoiseFinding& f) {
    const bool is_part = f.sensor == name(mark.effect->site) && f.axis == axis_letter(mark.axis) &&
                         f.place == NoiseFinding::Place::kErrorModel && f.value < mark.effect->residue(mark.parameter);
    if (is_part) gained += f.delta_log_likelihood;
    return is_part;
  });
  return gained;
}

void tell_converter(const Mark& mark, double gained, std::vector<NoiseFinding>& converters) {
  const auto told = std::ranges::find_if(converters, [&](const NoiseFinding& f) {
    return f.name == mark.effect->name && f.sensor == name(mark.effect->site) && f.axis == axis_letter(mark.axis);
  });
  if (told != converters.end()) {
    told->delta_log_likelihood += gained;
    return;
  }
  converters.push_back(described(mark, gained));
  converters.back().place = NoiseFinding::Place::kErrorModel;  // the noise of a step does not raise the likelihood
}

}  // namespace

void name_relations(const State& state, std::vector<Finding>& findings) {
  for (std::size_t i = 0; i < findings.size(); ++i) {
    Finding& f = findings[i];
    if (f.hypothesis.effect->relation.empty()) continue;
    const std::optional<NamedRelation> same = named(state.explanation.effects[i].hypothesis, state);
    if (!same) continue;
    const Hypothesis& h = same->hypothesis;
    f.hypothesis = h;
    f.value *= same->scale;
    f.sd *= std::abs(same->scale);
    f.stability.reset();
    std::erase_if(f.alternatives, [&](const Alternative& a) {
      return a.name == h.effect->name && a.axis == h.axis_name() && a.sensor == name(h.effect->site);
    });
  }
}

void fold_residues(Account& account) {
  for (const Mark& mark : account.marks) {
    if (mark.effect->residue == nullptr) continue;
    const std::string axis = axis_letter(mark.axis);
    // An effect that depends on the signal may be the remainder of the steps, which depends on it too.
    for (Finding& f : account.findings)
      if (f.hypothesis.effect->site == mark.effect->site && f.hypothesis.axis_name().starts_with(axis))
        f.alternatives.insert(f.alternatives.begin(),
                              {std::string(mark.effect->name), std::string(name(mark.effect->site)), axis, 0.0});
    const double gained = taken_from(account.random, mark);
    if (gained != 0.0) tell_converter(mark, gained, account.converters);
  }
}

void join_entries_with_exits(std::vector<Finding>& all) {
  constexpr double kEqual = 4.0;  // sd of the sum
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

void join_times(std::vector<Finding>& all) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!all[i].hypothesis.effect->repeats()) continue;
    const auto is_same = [&](const Finding& f) { return f.hypothesis.effect == all[i].hypothesis.effect; };
    const auto later = all.begin() + static_cast<std::ptrdiff_t>(i) + 1;
    const auto others = std::stable_partition(later, all.end(), [&](const Finding& f) { return !is_same(f); });
    all[i].further.assign(std::make_move_iterator(others), std::make_move_iterator(all.end()));
    all.erase(others, all.end());
  }
}

std::vector<Finding> times_of(const Finding& finding) {
  std::vector<Finding> all = finding.further;
  all.push_back(finding);
  all.back().further.clear();
  std::ranges::sort(all, {}, &Finding::from);
  return all;
}

void join_quadratures(std::vector<Finding>& all, std::vector<EffectPtr>& suggested) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Hypothesis h = all[i].hypothesis;
    if (h.effect->name != "harmonic_disturbance") continue;
    const bool both = i + 1 < all.size() && all[i + 1].hypothesis.effect == h.effect;
    // One of them may have been given up.
    const double sine = h.axis == 0 ? all[i].value : 0.0;
    const double cosine = both ? all[i + 1].value : all[i].value - sine;
    const double phase = h.effect->fixed[1].value + std::atan2(cosine, sine);
    suggested.push_back(
        harmonic_disturbance(h.effect->site, h.effect->axes.front().front() - 'x', h.effect->fixed[0].value, phase));
    all[i].hypothesis = {suggested.back().get(), 0, h.plausible};
    all[i].value = std::hypot(sine, cosine);
    if (!both) continue;
    all[i].sd = std::max(all[i].sd, all[i + 1].sd);
    all.erase(all.begin() + static_cast<std::ptrdiff_t>(i) + 1);
  }
}

}  // namespace coast::diagnose
