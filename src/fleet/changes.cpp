#include "coast/fleet/changes.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>

#include "coast/geo/units.hpp"
#include "coast/parallel.hpp"
#include "search.hpp"

namespace coast::fleet {

namespace {

/// A value of the t distribution. Bailey (1994), Math. Comp. 62, 779; for nu = infinity Box and Muller's.
double draw_t(std::mt19937_64& random, double nu) {
  const auto uniform = [&random] { return (static_cast<double>(random() >> 11U) + 0.5) * 0x1p-53; };
  const double u = uniform();
  const double angle = 2.0 * geo::kPi * uniform();
  const double square = std::isfinite(nu) ? nu * (std::pow(u, -2.0 / nu) - 1.0) : -2.0 * std::log(u);
  return std::sqrt(square) * std::cos(angle);
}

/// Largest statistic of each drawn fleet without changes, ascending.
std::vector<double> null_maxima(const std::vector<PanelTest>& tests, const ChangeOptions& options, double nu) {
  std::vector<double> maxima(static_cast<std::size_t>(options.simulations), 0.0);
  coast::parallel_for(std::size_t{0}, maxima.size(), [&](std::size_t i) {
    std::mt19937_64 random(options.seed * 1000003U + i);
    for (const PanelTest& test : tests) {
      std::vector<Eigen::VectorXd> z;
      for (const WhitenedUnit& unit : test.units())
        z.push_back(Eigen::VectorXd::NullaryExpr(unit.z.size(), [&] { return draw_t(random, nu); }));
      maxima[i] = std::max(maxima[i], test.strongest(z).statistic());
    }
  });
  std::ranges::sort(maxima);
  return maxima;
}

std::vector<Observations> observations_of(const Panel& panel, const std::vector<Change>& changes, const LeftOut& left_out) {
  std::vector<Observations> all;
  for (std::size_t u = 0; u < panel.series.size(); ++u) {
    Design design = design_of(panel.series[u], u, changes, left_out.empty() ? std::vector<bool>{} : left_out[u]);
    if (design.observations.y.size() > 0) all.push_back(std::move(design.observations));
  }
  return all;
}

double scale_of(const std::vector<Observations>& all, const Scatter& scatter) {
  std::vector<WhitenedUnit> units;
  std::vector<Eigen::VectorXd> z;
  for (const Observations& o : all) {
    units.push_back(whiten(o, scatter));
    z.push_back(units.back().z);
  }
  return fit_robustly(units, z).scale;
}

/// Robust -2 log-likelihood of one unit, without log|V|.
double cost_of_unit(const Panel& panel, std::size_t u, const std::vector<Change>& changes, const Scatter& scatter) {
  const std::vector<WhitenedUnit> unit{whiten(design_of(panel.series[u], u, changes).observations, scatter)};
  const RobustFit fit = fit_robustly(unit, {unit[0].z});
  return loss(fit.residuals[0] * fit.scale);
}

/// The search in one panel.
class Search {
 public:
  Search(const Panel& panel, const std::vector<double>& null, double threshold, bool with_walk)
      : panel_(panel), null_(null), threshold_(threshold), with_walk_(with_walk) {
    constexpr int kMostRounds = 25;
    for (int round = 0; round < kMostRounds; ++round) {
      estimate_scatter();
      const PanelTest test(panel_, model_.changes, model_.scatter, {});
      const Strongest best = test.strongest(test.values());
      if (best.statistic() <= threshold_) break;
      add(test, best.shared.statistic > threshold_ && is_broad(test, best.shared) ? best.shared : best.own);
      prune();
    }
    estimate_scatter();
  }

  [[nodiscard]] const PanelChanges& model() const { return model_; }
  /// -2 log-likelihood, with what each change of a unit costs.
  [[nodiscard]] double score() const {
    double sum = cost(model_.changes) + threshold_ * static_cast<double>(model_.changes.size());
    for (const Observations& o : observations_of(panel_, model_.changes, {})) sum += whiten(o, model_.scatter).log_det;
    return sum;
  }
  void merge_simultaneous();
  void date_steps();

 private:
  void estimate_scatter() {
    model_.scatter = with_walk_ ? panel_scatter(observations_of(panel_, model_.changes, {}), true)
                                : robust_scatter(panel_, model_.changes, {});
  }

  [[nodiscard]] double unit_cost(std::size_t u, const std::vector<Change>& changes) const {
    return cost_of_unit(panel_, u, changes, model_.scatter);
  }
  [[nodiscard]] double cost(const std::vector<Change>& changes) const {
    double sum = 0.0;
    for (std::size_t u = 0; u < panel_.series.size(); ++u) sum += unit_cost(u, changes);
    return sum;
  }

  [[nodiscard]] std::vector<double> gaps(const Change& change) const;
  void add(const PanelTest& test, const Candidate& best);
  [[nodiscard]] static bool is_broad(const PanelTest& test, const Candidate& shared);
  [[nodiscard]] Change step_or_drift(const Candidate& best) const;
  void prune();

  const Panel& panel_;
  const std::vector<double>& null_;
  double threshold_;
  bool with_walk_;
  PanelChanges model_;
};

/// Dates of the missions of all units that have a part in the change, ascending.
std::vector<double> Search::gaps(const Change& change) const {
  std::set<double> dates;
  for (const std::size_t u : change.units)
    for (const Estimate& e : panel_.series[u].estimates) dates.insert(e.t);
  return {dates.begin(), dates.end()};
}

/// Whether more than one or two units make a sum what it is: what three show together is one event, not three.
bool Search::is_broad(const PanelTest& test, const Candidate& shared) {
  constexpr double kSeen = 6.635;  // chi-square with one degree of freedom, 1 %
  std::vector<double> statistics = test.of_units(shared);
  if (std::ranges::count_if(statistics, [](double s) { return s > kSeen; }) >= 3) return true;
  double sum = 0.0;
  for (const double s : statistics) sum += std::sqrt(s);
  return std::sqrt(std::ranges::max(statistics)) < 0.25 * sum;
}

/// What one unit shows may be a step or a drift. The evidence of a step is the mean over its dates; a lever arm or a mounting
/// moves, and hardly ever drifts.
Change Search::step_or_drift(const Candidate& best) const {
  Change change;
  change.units = {best.unit};
  std::vector<Change> with = model_.changes;
  with.push_back(change);
  Change& trial = with.back();
  const std::vector<double> dates = gaps(change);
  constexpr double kMovesPrice = 6.0;  // odds of 20 to 1
  trial.kind = ChangeKind::kDrift;
  const bool moves = panel_.quantity.starts_with("lever_arm") || panel_.quantity.starts_with("mounting");
  const double of_drift = unit_cost(best.unit, with) + (moves ? kMovesPrice : 0.0);
  trial.kind = ChangeKind::kStep;
  double least = std::numeric_limits<double>::infinity();
  std::vector<double> costs;
  for (std::size_t k = 3; k + 3 <= dates.size(); ++k) {
    trial.t = 0.5 * (dates[k - 1] + dates[k]);
    costs.push_back(unit_cost(best.unit, with));
    if (costs.back() >= least) continue;
    least = costs.back();
    change.t = trial.t;
  }
  double evidence = 0.0;
  for (const double cost : costs) evidence += std::exp(-0.5 * (cost - least)) / static_cast<double>(costs.size());
  change.kind = !costs.empty() && least - 2.0 * std::log(evidence) < of_drift ? ChangeKind::kStep : ChangeKind::kDrift;
  return change;
}

void Search::add(const PanelTest& test, const Candidate& best) {
  constexpr double kUnitLevel = 0.05;
  Change change;
  if (best.shared) {
    change.kind = best.kind;
    change.shared = true;
    change.t = best.t;
    change.factor = best.factor;
    change.level = best.level;
    const std::vector<double> statistics = test.of_units(best);
    const double level = kUnitLevel / static_cast<double>(statistics.size());
    std::vector<std::size_t> touched;
    for (std::size_t u = 0; u < statistics.size(); ++u) {
      if (statistics[u] > 0.0) touched.push_back(u);
      if (chi_square_1_tail(statistics[u]) < level) change.units.push_back(u);
    }
    if (change.units.size() < 2) change.units = touched;  // too small in each to be seen there
  } else {
    change = step_or_drift(best);
  }
  change.statistic = best.statistic;
  const auto larger = null_.end() - std::ranges::lower_bound(null_, best.statistic);
  change.p = (1.0 + static_cast<double>(larger)) / (1.0 + static_cast<double>(null_.size()));
  model_.changes.push_back(change);
}

/// Drops earlier changes that the latest one explains.
void Search::prune() {
  for (std::size_t c = model_.changes.size() - 1; c-- > 0;) {
    std::vector<Change> without = model_.changes;
    without.erase(without.begin() + static_cast<std::ptrdiff_t>(c));
    double gain = 0.0;
    for (const std::size_t u : model_.changes[c].units) gain += unit_cost(u, without) - unit_cost(u, model_.changes);
    if (gain < threshold_) model_.changes = std::move(without);
  }
}

/// Steps of three units or more whose dates may be one date become one change.
void Search::merge_simultaneous() {
  constexpr std::size_t kFewest = 3;
  std::vector<Change>& all = model_.changes;
  for (std::size_t a = 0; a < all.size(); ++a) {
    if (all[a].kind != ChangeKind::kStep) continue;
    std::vector<std::size_t> with;
    for (std::size_t b = 0; b < all.size(); ++b)
      if (b != a && all[b].kind == ChangeKind::kStep && all[b].t_95.first <= all[a].t_95.second &&
          all[a].t_95.first <= all[b].t_95.second)
        with.push_back(b);
    if (!all[a].shared && with.size() + 1 < kFewest) continue;
    std::set<std::size_t> units(all[a].units.begin(), all[a].units.end());
    for (const std::size_t b : with) {
      units.insert(all[b].units.begin(), all[b].units.end());
      all[a].statistic = std::max(all[a].statistic, all[b].statistic);
      all[a].p = std::min(all[a].p, all[b].p);
    }
    all[a].units.assign(units.begin(), units.end());
    all[a].shared = true;
    for (std::size_t i = with.size(); i-- > 0;) {
      all.erase(all.begin() + static_cast<std::ptrdiff_t>(with[i]));
      if (with[i] < a) --a;
    }
  }
}

/// The date of each step and its 95 % interval: flat prior in time, likelihood at every gap between missions.
void Search::date_steps() {
  for (std::size_t c = 0; c < model_.changes.size(); ++c) {
    if (model_.changes[c].kind != ChangeKind::kStep) continue;
    std::vector<Change> trial = model_.changes;
    const std::vector<double> dates = gaps(trial[c]);
    struct Gap {
      double from, to, cost;
    };
    std::vector<Gap> all;
    for (std::size_t k = 1; k < dates.size(); ++k) {
      trial[c].t = 0.5 * (dates[k - 1] + dates[k]);
      double sum = 0.0;
      for (const std::size_t u : trial[c].units) sum += unit_cost(u, trial);
      all.push_back({dates[k - 1], dates[k], sum});
    }
    std::ranges::sort(all, {}, &Gap::cost);
    double total = 0.0;
    for (const Gap& gap : all) total += (gap.to - gap.from) * std::exp(-0.5 * (gap.cost - all[0].cost));
    Change& change = model_.changes[c];
    change.t = 0.5 * (all[0].from + all[0].to);
    change.t_95 = {all[0].from, all[0].to};
    double sum = 0.0;
    for (const Gap& gap : all) {
      change.t_95 = {std::min(change.t_95.first, gap.from), std::max(change.t_95.second, gap.to)};
      sum += (gap.to - gap.from) * std::exp(-0.5 * (gap.cost - all[0].cost));
      if (sum >= 0.95 * total) break;
    }
  }
}

/// Sizes with sigmas, by generalised least squares with all that is in the model.
void size_changes(const Panel& panel, const LeftOut& left_out, PanelChanges& model) {
  const double scale = robust_scale(panel, model, left_out);
  for (Change& change : model.changes) change.size.assign(change.units.size(), 0.0), change.size_sd = change.size;
  for (std::size_t u = 0; u < panel.series.size(); ++u) {
    const Design design = design_of(panel.series[u], u, model.changes, left_out[u]);
    const Observations& o = design.observations;
    if (o.y.size() < o.X.cols()) continue;
    const LeastSquares fit = least_squares(o, model.scatter);
    for (std::size_t c = 0; c < model.changes.size(); ++c) {
      if (!design.of_changes[c]) continue;
      Change& change = model.changes[c];
      const auto at = static_cast<std::size_t>(std::ranges::find(change.units, u) - change.units.begin());
      change.size[at] = fit.beta[*design.of_changes[c]];
      change.size_sd[at] = scale * std::sqrt(fit.covariance(*design.of_changes[c], *design.of_changes[c]));
    }
  }
  for (Change& change : model.changes) {
    double weights = 0.0;
    for (std::size_t i = 0; i < change.units.size();) {
      if (change.size_sd[i] == 0.0) {  // no part of its own beside the others: not told
        const auto offset = static_cast<std::ptrdiff_t>(i);
        change.units.erase(change.units.begin() + offset);
        change.size.erase(change.size.begin() + offset);
        change.size_sd.erase(change.size_sd.begin() + offset);
        continue;
      }
      const double weight = 1.0 / (change.size_sd[i] * change.size_sd[i]);
      change.common_size += weight * change.size[i];
      weights += weight;
      ++i;
    }
    if (weights > 0.0) change.common_size /= weights, change.common_sd = 1.0 / std::sqrt(weights);
  }
  std::erase_if(model.changes, [](const Change& change) { return change.units.empty(); });
}

/// Changes against independent scatter; where there are some, a random walk may be the better account of them.
PanelChanges search_panel(const Panel& panel, const std::vector<double>& null, double threshold) {
  constexpr double kWalkPrice = 10.83;  // chi-square with one degree of freedom, 0.1 %
  Search plain(panel, null, threshold, false);
  plain.date_steps();
  plain.merge_simultaneous();
  plain.date_steps();
  const auto own = std::ranges::count(plain.model().changes, false, &Change::shared);
  if (own == 0) return plain.model();
  Search walking(panel, null, threshold, true);
  if (walking.model().scatter.walk == 0.0 || walking.score() + kWalkPrice >= plain.score()) return plain.model();
  walking.date_steps();
  walking.merge_simultaneous();
  walking.date_steps();
  PanelChanges model = walking.model();
  for (const Observations& o : observations_of(panel, model.changes, {}))
    model.walk_gain += restricted_log_likelihood(o, model.scatter) - restricted_log_likelihood(o, {model.scatter.tau, 0.0});
  return model;
}

/// Whether a unit has a step already whose date may be that of another one.
bool has_step(const PanelChanges& model, std::size_t unit, const Change& other) {
  return std::ranges::any_of(model.changes, [&](const Change& c) {
    return c.kind == ChangeKind::kStep && std::ranges::find(c.units, unit) != c.units.end() &&
           c.t_95.first <= other.t_95.second && other.t_95.first <= c.t_95.second;
  });
}

/// A step of one unit in one axis: the other axes of the quantity have it too where it is seen there at 1 %, at this date. This
/// adds no false alarm, as the event is told already.
void extend_to_other_axes(const Fleet& fleet, std::vector<PanelChanges>& models) {
  constexpr double kSeen = 6.635;  // chi-square with one degree of freedom, 1 %
  const std::vector<PanelChanges> found = models;
  for (std::size_t p = 0; p < found.size(); ++p)
    for (std::size_t q = 0; q < found.size(); ++q) {
      const Panel& panel = fleet.panels[q];
      if (p == q || panel.quantity != fleet.panels[p].quantity) continue;
      for (const Change& change : found[p].changes) {
        if (change.kind != ChangeKind::kStep || change.units.size() != 1) continue;
        const auto same = std::ranges::find(panel.series, fleet.panels[p].series[change.units[0]].unit, &Series::unit);
        if (same == panel.series.end()) continue;
        const auto u = static_cast<std::size_t>(same - panel.series.begin());
        if (has_step(models[q], u, change)) continue;
        std::vector<Change> with = models[q].changes;
        with.push_back(change);
        with.back().units = {u};
        const double gain =
            cost_of_unit(panel, u, models[q].changes, models[q].scatter) - cost_of_unit(panel, u, with, models[q].scatter);
        with.back().statistic = gain;
        if (gain > kSeen) models[q].changes = std::move(with);
      }
    }
}

std::vector<LeftOut> none_left_out(const Fleet& fleet) {
  std::vector<LeftOut> all;
  for (const Panel& panel : fleet.panels) {
    LeftOut& of_panel = all.emplace_back();
    for (const Series& series : panel.series) of_panel.emplace_back(series.estimates.size(), false);
  }
  return all;
}

}  // namespace

Scatter robust_scatter(const Panel& panel, const std::vector<Change>& changes, const LeftOut& left_out) {
  const std::vector<Observations> all = observations_of(panel, changes, left_out);
  const auto too_small = [&](double tau) { return scale_of(all, {tau, 0.0}) > 1.0; };
  if (!too_small(0.0)) return {};
  double low = 0.0;
  double high = std::numeric_limits<double>::infinity();
  for (const Observations& o : all) high = std::min(high, o.sigma.minCoeff());
  for (int step = 0; step < 200 && too_small(high); ++step) low = high, high *= 2.0;
  for (int step = 0; step < 14; ++step) {
    const double middle = 0.5 * (low + high);
    (too_small(middle) ? low : high) = middle;
  }
  return {0.5 * (low + high), 0.0};
}

double robust_scale(const Panel& panel, const PanelChanges& model, const std::vector<std::vector<bool>>& left_out) {
  return scale_of(observations_of(panel, model.changes, left_out), model.scatter);
}

FleetChanges find_changes(const Fleet& fleet, const ChangeOptions& options, const std::function<void(double)>& progress) {
  constexpr double kLightest = 4.0;  // nu of drawn fleets: what has changed and is not modelled yet looks like heavy tails
  const auto tell = [&](double share) {
    if (progress) progress(share);
  };
  FleetChanges result;
  result.panels.resize(fleet.panels.size());
  std::vector<LeftOut> left_out;
  Tails tails;
  for (int pass = 0; pass < 2; ++pass) {
    std::vector<PanelTest> tests;
    for (std::size_t p = 0; p < fleet.panels.size(); ++p) {
      if (pass == 0) result.panels[p].scatter = robust_scatter(fleet.panels[p], {}, {});
      tests.emplace_back(fleet.panels[p], std::vector<Change>{}, result.panels[p].scatter, LeftOut{});
    }
    if (pass == 0) {
      left_out = none_left_out(fleet);
      static_cast<void>(find_departures(fleet, result.panels, 0.0, left_out, tails));
    }
    tell(0.1 + 0.5 * pass);
    const std::vector<double> null = null_maxima(tests, options, std::max(tails.nu, kLightest));
    const auto quantile =
        static_cast<std::size_t>((1.0 - 0.5 * options.false_alarm_probability) * static_cast<double>(null.size()));
    result.threshold = null[std::min(quantile, null.size() - 1)];
    tell(0.4 + 0.5 * pass);
    coast::parallel_for(std::size_t{0}, fleet.panels.size(),
                        [&](std::size_t p) { result.panels[p] = search_panel(fleet.panels[p], null, result.threshold); });
    extend_to_other_axes(fleet, result.panels);
    left_out = none_left_out(fleet);
    result.departures = find_departures(fleet, result.panels, 0.5 * options.false_alarm_probability, left_out, tails);
    if (std::ranges::all_of(result.panels, [](const PanelChanges& panel) { return panel.changes.empty(); })) break;
  }
  result.tails_nu = tails.nu;
  for (std::size_t p = 0; p < fleet.panels.size(); ++p) size_changes(fleet.panels[p], left_out[p], result.panels[p]);
  tell(1.0);
  return result;
}

}  // namespace coast::fleet
