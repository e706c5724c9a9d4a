// The page of a study of the estimators.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibrate/page/parts.hpp"
#include "coast/report/panels.hpp"
#include "coast/study/paired.hpp"
#include "common/page_parts.hpp"
#include "estimator_study/result.hpp"

namespace coast::jobs {

namespace {

using report::Tone;

constexpr std::array kTones{Tone::kForward, Tone::kSmoothed, Tone::kX, Tone::kY, Tone::kZ, Tone::kFloat, Tone::kPpp};

Tone tone_of_estimator(std::size_t e) {
  return kTones[e % kTones.size()];
}

report::Axis axis_of(std::string label, std::string unit, report::Axis::Scale scale = report::Axis::Scale::kLinear) {
  return {std::move(label), std::move(unit), scale, {}, {}};
}

/// Data for the plot of one parameter: its estimators, and their indices.
struct ParameterView {
  std::string name;
  std::string unit;
  std::optional<double> truth;
  std::optional<double> bound;
  struct Estimate {
    std::size_t estimator;
    std::size_t parameter;
  };
  std::vector<Estimate> estimates;
};

std::vector<ParameterView> parameters_of_study(const EstimatorStudyOutcome& outcome) {
  std::vector<ParameterView> views;
  for (std::size_t e = 0; e < outcome.summaries.size(); ++e)
    for (std::size_t i = 0; i < outcome.summaries[e].parameters.size(); ++i) {
      const noise::ParameterSummary& p = outcome.summaries[e].parameters[i];
      auto view = std::ranges::find(views, p.name, &ParameterView::name);
      if (view == views.end()) view = views.insert(views.end(), {p.name, p.unit, p.truth, p.bound, {}});
      // Of several bounds the smallest is drawn: that of the sum with the fewest other parameters.
      if (p.bound && (!view->bound || *p.bound < *view->bound)) view->bound = p.bound;
      view->estimates.push_back({e, i});
    }
  return views;
}

void name_rows(const EstimatorStudyConfig& config, const ParameterView& view, report::Plot& plot) {
  for (std::size_t row = 0; row < view.estimates.size(); ++row)
    plot.y.ticks.push_back({-static_cast<double>(row), config.study.estimators[view.estimates[row].estimator].name});
}

/// The range with nine tenths of the estimates of every estimator, and the truth.
std::pair<double, double> view_of(const EstimatorStudyOutcome& outcome, const ParameterView& view) {
  double low = view.truth.value_or(std::numeric_limits<double>::infinity());
  double high = view.truth.value_or(-std::numeric_limits<double>::infinity());
  for (const ParameterView::Estimate& at : view.estimates) {
    const noise::ParameterSummary& p = outcome.summaries[at.estimator].parameters[at.parameter];
    low = std::min(low, p.q05);
    high = std::max(high, p.q95);
  }
  if (view.truth && view.bound && std::isfinite(*view.bound)) {
    low = std::min(low, *view.truth - 2.0 * *view.bound);
    high = std::max(high, *view.truth + 2.0 * *view.bound);
  }
  const double air = 0.15 * std::max(high - low, 1e-300);
  return {low - air, high + air};
}

void add_boxes(const EstimatorStudyConfig& config, const EstimatorStudyOutcome& outcome, const ParameterView& view,
               report::Panel& panel) {
  report::Plot& plot = report::add_cell(panel, view.name, "", "", "");
  plot.x = axis_of("", config.unit(view.unit));
  plot.x.range = view_of(outcome, view);
  plot.link.clear();
  plot.height_px = 70 + 34 * static_cast<int>(view.estimates.size());
  name_rows(config, view, plot);
  if (view.truth && view.bound && std::isfinite(*view.bound))
    plot.intervals.push_back({*view.truth - *view.bound, *view.truth + *view.bound, "truth, one bound", Tone::kGood});
  if (view.truth) {
    report::Series line;
    line.x = {*view.truth, *view.truth};
    line.y = {-static_cast<double>(view.estimates.size()), 1.0};
    report::add_line(plot, "truth", std::move(line), Tone::kReference).width_px = 1.6;
  }
  for (std::size_t row = 0; row < view.estimates.size(); ++row) {
    const auto [e, i] = view.estimates[row];
    const noise::StudiedEstimator& estimator = config.study.estimators[e];
    const std::vector<double> values = noise::values_of(estimator, outcome.result.fits[e], i);
    const noise::ParameterSummary& p = outcome.summaries[e].parameters[i];
    const double y = -static_cast<double>(row);
    plot.boxes.push_back({estimator.name,
                          {{y, p.q05, study::quantile(values, 0.25), p.median, study::quantile(values, 0.75), p.q95}},
                          tone_of_estimator(e)});
    report::Series outside;
    for (const double value : values)
      if (value < p.q05 || value > p.q95) {
        outside.x.push_back(value);
        outside.y.push_back(y);
      }
    if (!outside.x.empty()) report::add_points(plot, estimator.name, std::move(outside), tone_of_estimator(e));
  }
}

report::Panel boxes_panel(const EstimatorStudyConfig& config, const EstimatorStudyOutcome& outcome) {
  report::Panel panel = report::grid_panel(
      "estimates", fmt::format("Estimates of {} runs", config.study.runs), 2,
      "Boxes hold half of the runs, whiskers nine tenths, as in Fig. 1 of Stebler et al. (2011). The line is the truth, the "
      "shaded stretch one Cramer-Rao standard deviation about it: no unbiased estimator has a box much narrower than 1.35 "
      "times "
      "half of that stretch. Good: centred on the line, and no wider.");
  for (const ParameterView& view : parameters_of_study(outcome)) add_boxes(config, outcome, view, panel);
  return panel;
}

report::Table estimator_table(const EstimatorStudyConfig& config, const EstimatorStudyOutcome& outcome) {
  report::Table table;
  table.id = "estimator-table";
  table.title = "Estimators";
  table.caption =
      "Shortfall: log-likelihood below the best that any estimator of the table found for the same sum or a part of it, on the "
      "same run. Seconds on this machine, intervals not counted.";
  table.columns = {{"estimator", "", false}, {"sum", "", false}, {"shortfall, mean", ""}, {"largest", ""}, {"iterations", ""},
                   {"passes", ""},           {"converged", "%"}, {"median time", "s"},    {"longest", "s"}};
  for (std::size_t e = 0; e < outcome.summaries.size(); ++e) {
    const noise::EstimatorSummary& s = outcome.summaries[e];
    table.rows.push_back(
        cells({config.study.estimators[e].name, config.study.estimators[e].model.name(), figure(s.mean_shortfall),
               figure(s.largest_shortfall), decimals(s.mean_iterations, 0), decimals(s.mean_passes, 0), percent(s.converged),
               figure(s.median_seconds), figure(s.largest_seconds)}));
  }
  return table;
}

report::Cell relative_cell(const std::optional<double>& value, const std::optional<double>& bound, double good, double centre) {
  if (!value || !bound || !std::isfinite(*bound)) return {"-"};
  const double ratio = *value / *bound;
  const bool inside = std::abs(ratio - centre) <= good;
  return {decimals(ratio, 2), inside ? report::Verdict::kGood : report::Verdict::kWarn};
}

report::Table parameter_table_of(const EstimatorStudyConfig& config, const EstimatorStudyOutcome& outcome) {
  constexpr double kSpread = 0.15;
  constexpr double kBias = 0.25;
  report::Table table;
  table.id = "parameter-table";
  table.title = "Estimates against truth and bound";
  table.caption =
      "Bound: Cramer-Rao standard deviation of an unbiased estimate with level and drift estimated beside it. Good: a standard "
      "deviation within 15 % of it, a bias below a quarter of it.";
  table.columns = {{"parameter", "", false},
                   {"estimator", "", false},
                   {"unit", "", false},
                   {"truth", ""},
                   {"bound", ""},
                   {"mean", ""},
                   {"sd", ""},
                   {"sd : bound", ""},
                   {"bias : bound", ""},
                   {"5 %", ""},
                   {"median", ""},
                   {"95 %", ""},
                   {"at zero", "%"}};
  const auto optional = [](const std::optional<double>& value) {
    return value && std::isfinite(*value) ? figure(*value) : std::string("-");
  };
  for (const ParameterView& view : parameters_of_study(outcome))
    for (const auto& [e, i] : view.estimates) {
      const noise::ParameterSummary& p = outcome.summaries[e].parameters[i];
      std::optional<double> bias;
      if (p.truth) bias = p.mean - *p.truth;
      auto row = cells({p.name, config.study.estimators[e].name, config.unit(p.unit), optional(p.truth), optional(p.bound),
                        figure(p.mean), figure(p.sd)});
      row.push_back(relative_cell(p.sd, p.bound, kSpread, 1.0));
      row.push_back(relative_cell(bias, p.bound, kBias, 0.0));
      for (const std::string& text :
           {figure(p.q05), figure(p.median), figure(p.q95), p.zero ? percent(*p.zero) : std::string("-")})
        row.push_back({text});
      table.rows.push_back(std::move(row));
    }
  return table;
}

std::optional<report::Panel> coverage_panel(const EstimatorStudyConfig& config, const EstimatorStudyOutcome& outcome) {
  report::Panel panel = report::grid_panel(
      "coverage", "How often 95 % intervals hold the truth", 2,
      "With the 95 % that so many runs leave open. Of processes by profile likelihood, of level and slope by the standard "
      "deviation of least squares with the processes as estimated. Good: bars across the line at 95 %.");
  for (std::size_t e = 0; e < outcome.summaries.size(); ++e) {
    if (!outcome.summaries[e].pooled) continue;
    report::Plot& plot = report::add_cell(panel, config.study.estimators[e].name, "", "", "");
    plot.x = axis_of("share", "%");
    plot.link.clear();
    report::Series shares;
    report::Series bars;
    const auto add = [&](const std::string& name, const noise::Coverage& coverage) {
      const double y = -static_cast<double>(plot.y.ticks.size());
      const noise::Interval interval = coverage.uncertainty();
      plot.y.ticks.push_back({y, name});
      shares.x.push_back(100.0 * coverage.share());
      shares.y.push_back(y);
      if (!bars.x.empty()) bars.breaks.push_back(static_cast<std::uint32_t>(bars.x.size()));
      bars.x.insert(bars.x.end(), {100.0 * interval.lower, 100.0 * interval.upper});
      bars.y.insert(bars.y.end(), {y, y});
    };
    add("pooled", *outcome.summaries[e].pooled);
    for (const noise::ParameterSummary& p : outcome.summaries[e].parameters)
      if (p.coverage) add(p.name, *p.coverage);
    plot.height_px = 70 + 24 * static_cast<int>(plot.y.ticks.size());
    plot.intervals.push_back({88.0, 99.0, "", Tone::kGood});
    report::Series nominal;
    nominal.x = {95.0, 95.0};
    nominal.y = {-static_cast<double>(plot.y.ticks.size()), 1.0};
    report::add_line(plot, "95 %", std::move(nominal), Tone::kReference);
    report::add_line(plot, "share", std::move(bars), tone_of_estimator(e)).width_px = 2.0;
    report::add_points(plot, "share", std::move(shares), tone_of_estimator(e)).radius_px = 4.0;
  }
  if (panel.plots.empty()) return {};
  return panel;
}

/// The first run: distance of each iteration from the best.
std::optional<report::Panel> way_panel(const EstimatorStudyConfig& config, const EstimatorStudyOutcome& outcome) {
  constexpr double kLeast = 1e-7;  // of the gain predicted by the search; less is rounding
  report::Panel panel = report::xy_panel(
      "way", "Convergence of the first run", axis_of("iteration", "", report::Axis::Scale::kLog),
      axis_of("log-likelihood below the best", "", report::Axis::Scale::kLog),
      "Below 0.1 the estimate would not change in any digit that matters. EM comes near in some dozens of passes and then "
      "crawls; "
      "of the default the passes over the whole record are drawn, from where the search on block means ended.");
  double best = -std::numeric_limits<double>::infinity();
  for (const auto& fits : outcome.result.fits) best = std::max(best, fits.front().log_likelihood);
  for (std::size_t e = 0; e < outcome.result.fits.size(); ++e) {
    const noise::Estimator kind = config.study.estimators[e].kind;
    if (kind != noise::Estimator::kEm && kind != noise::Estimator::kDefault) continue;
    report::Series series;
    const std::vector<double>& trace = outcome.result.fits[e].front().trace;
    for (std::size_t i = 0; i < trace.size(); ++i) {
      if (!std::isfinite(best - trace[i])) continue;
      series.x.push_back(static_cast<double>(i + 1));
      series.y.push_back(std::max(best - trace[i], kLeast));
    }
    if (series.x.empty()) continue;
    report::add_points(panel.plot(), config.study.estimators[e].name, series, tone_of_estimator(e)).radius_px = 2.5;
    report::add_line(panel.plot(), config.study.estimators[e].name, std::move(series), tone_of_estimator(e));
  }
  if (panel.plot().lines.empty()) return {};
  return panel;
}

std::optional<report::Panel> restitution_panel(const EstimatorStudyConfig& config, const EstimatorStudyOutcome& outcome) {
  if (outcome.result.restitution.empty()) return {};
  const noise::RestitutionPlan& plan = config.study.restitution;
  report::Panel panel = report::grid_panel(
      "restitution", "Restitution of Allan curves", static_cast<int>(std::min<std::size_t>(3, plan.runs)),
      fmt::format(
          "The record of a run and {} realisations of what {} made of it, as in Figs. 2 and 3 of Stebler et al. (2011). "
          "Good: the record among its realisations.",
          plan.realisations, config.study.estimators[plan.estimator].name));
  for (std::size_t r = 0; r < outcome.result.restitution.size(); ++r) {
    const noise::Restitution& restitution = outcome.result.restitution[r];
    report::Plot& plot = report::add_cell(panel, fmt::format("run {}", r + 1), "", "", "");
    plot.x = axis_of("averaging time", "s", report::Axis::Scale::kLog);
    plot.y = axis_of("Allan deviation", config.signal_unit, report::Axis::Scale::kLog);
    plot.link.clear();
    plot.height_px = 320;
    report::Series thin;
    for (const std::vector<double>& deviations : restitution.realisations) {
      if (!thin.x.empty()) thin.breaks.push_back(static_cast<std::uint32_t>(thin.x.size()));
      for (std::size_t i = 0; i < deviations.size(); ++i) {
        if (!(deviations[i] > 0.0)) continue;
        thin.x.push_back(restitution.record[i].tau);
        thin.y.push_back(deviations[i]);
      }
    }
    report::add_line(plot, "realisations", std::move(thin), Tone::kMuted).width_px = 0.7;
    report::Series record;
    for (const noise::AllanPoint& point : restitution.record) {
      if (!(point.allan.value > 0.0)) continue;
      record.x.push_back(point.tau);
      record.y.push_back(point.allan.value);
    }
    report::add_line(plot, "record", std::move(record), Tone::kX).width_px = 2.6;
  }
  return panel;
}

report::Table choice_table(const EstimatorStudyConfig& config, const EstimatorStudyOutcome& outcome) {
  report::Table table;
  table.id = "choices";
  table.title = "What BIC chooses";
  table.caption =
      "Of these sums, fitted to each run by maximum likelihood; sums with a variance at zero stand behind the others.";
  table.columns = {{"sum", "", false}, {"runs", ""}, {"share", "%"}};
  const std::vector<std::size_t> times = times_chosen(config, outcome);
  for (std::size_t i = 0; i < times.size(); ++i)
    table.rows.push_back(cells({config.study.choices[i].name(), fmt::format("{}", times[i]),
                                percent(static_cast<double>(times[i]) / static_cast<double>(config.study.runs))}));
  return table;
}

report::Section readings_section(const EstimatorStudyConfig& config) {
  report::Section section;
  section.id = "readings";
  section.title = "Other readings of the same numbers";
  section.lead =
      "Nothing is simulated here: the Allan curve and the Cramer-Rao bounds of each, over the same length of record.";
  report::Table table;
  table.id = "reading-table";
  table.title = "Bounds";
  table.caption =
      "Cramer-Rao standard deviation over the value: above 100 % a record of this length hardly determines the parameter.";
  table.columns = {{"reading", "", false}, {"parameter", "", false}, {"unit", "", false}, {"value", ""}, {"bound", "%"}};
  report::Panel panel = report::xy_panel("reading-allan", "Allan curves of the readings",
                                         axis_of("averaging time", "s", report::Axis::Scale::kLog),
                                         axis_of("Allan deviation", config.signal_unit, report::Axis::Scale::kLog));
  std::vector<StudyReading> all{{"truth", config.study.truth}};
  all.insert(all.end(), config.readings.begin(), config.readings.end());
  for (std::size_t r = 0; r < all.size(); ++r) {
    const noise::StudyTruth& truth = all[r].truth;
    report::Series series;
    constexpr int kPerDecade = 20;
    for (const double tau : averaging_times(config.study, kPerDecade)) {
      series.x.push_back(tau);
      series.y.push_back(allan_deviation(truth, config.study.interval, tau));
    }
    report::add_line(panel.plot(), all[r].name, std::move(series), tone_of_estimator(r)).width_px = 1.8;
    const std::vector<double> bounds = bounds_of(truth.model, truth, config.study.interval, config.study.samples);
    const std::vector<double> u = noise::in_order(truth.model, truth.u);
    for (std::size_t i = 0; i < u.size(); ++i) {
      const double value = truth.model.parameter(i).value(u[i]);
      table.rows.push_back(
          cells({all[r].name, truth.model.parameter_name(i), config.unit(std::string(truth.model.parameter(i).unit)),
                 figure(value), figure(100.0 * bounds[i] / std::abs(value))}));
    }
  }
  section.tables.push_back(std::move(table));
  section.panels.push_back(std::move(panel));
  return section;
}

void add_tiles(const EstimatorStudyConfig& config, const EstimatorStudyOutcome& outcome, report::Page& page) {
  for (std::size_t e = 0; e < outcome.summaries.size(); ++e) {
    const noise::EstimatorSummary& s = outcome.summaries[e];
    report::Tile tile;
    tile.label = fmt::format("{}: log-likelihood short by", config.study.estimators[e].name);
    tile.value = figure(s.largest_shortfall);
    tile.explanation = "Largest over the runs, against the best that any estimator found for the same sum or a part of it.";
    tile.section = "estimator-table";
    page.tiles.push_back(std::move(tile));
    if (!s.pooled) continue;
    report::Tile coverage;
    coverage.label = fmt::format("{}: 95 % intervals hold", config.study.estimators[e].name);
    coverage.value = percent(s.pooled->share());
    coverage.unit = "%";
    coverage.verdict = s.pooled->share() >= 0.92 && s.pooled->share() <= 0.97 ? report::Verdict::kGood : report::Verdict::kWarn;
    coverage.explanation = "Over all parameters of processes and all runs; good: 92 to 97 %.";
    coverage.section = "coverage";
    page.tiles.push_back(std::move(coverage));
  }
}

}  // namespace

report::Page estimator_study_page(const EstimatorStudyConfig& config, const EstimatorStudyOutcome& outcome) {
  const noise::EstimatorStudy& study = config.study;
  report::Page page;
  page.title = config.title;
  page.subtitle = config.file.filename().string();
  report::Section section;
  section.id = "estimators";
  section.title = "Estimators on records of known processes";
  section.lead =
      fmt::format("Simulated: {} records of {} samples at {:g} s, drawn from {} with seeds from {} on, slope {:g} per second.",
                  study.runs, study.samples, study.interval, study.truth.model.name(), study.first_seed, study.truth.slope);
  section.tables.push_back(estimator_table(config, outcome));
  section.tables.push_back(parameter_table_of(config, outcome));
  if (!study.choices.empty()) section.tables.push_back(choice_table(config, outcome));
  section.panels.push_back(boxes_panel(config, outcome));
  for (auto& panel : {coverage_panel(config, outcome), way_panel(config, outcome), restitution_panel(config, outcome)})
    if (panel) section.panels.push_back(*panel);
  add_tiles(config, outcome, page);
  page.sections.push_back(std::move(section));
  if (!config.readings.empty()) page.sections.push_back(readings_section(config));
  return page;
}

}  // namespace coast::jobs
