// Course of the estimation, tests of the innovations, and estimates from each record alone.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibrate/page/parts.hpp"
#include "calibrate/units.hpp"
#include "coast/report/panels.hpp"
#include "common/page_parts.hpp"

namespace coast::jobs {

namespace {

/// Distance of each iteration from the optimum; points at the optimum have no place on a logarithmic axis.
report::Series below(const std::vector<double>& trace, double optimum) {
  constexpr double kLeast = 1e-9;
  report::Series series;
  for (std::size_t i = 0; i < trace.size(); ++i) {
    const double distance = optimum - trace[i];
    if (!std::isfinite(distance) || distance < kLeast) continue;
    series.x.push_back(static_cast<double>(i + 1));
    series.y.push_back(distance);
  }
  return series;
}

}  // namespace

std::optional<report::Panel> search_panel(const CalibratedAxis& axis) {
  const noise::Fit& direct = axis.result.best().fit;
  if (!axis.result.em) return {};
  const noise::Fit& em = *axis.result.em;
  const double optimum = std::max(direct.log_likelihood, em.log_likelihood);
  report::Series of_em = below(em.trace, optimum);
  report::Series of_direct = below(direct.trace, optimum);
  if (of_em.x.empty() && of_direct.x.empty()) return {};
  report::Panel panel =
      report::xy_panel(id_of(axis) + "-search", "Convergence", {"iteration", "", report::Axis::Scale::kLinear, {}, {}},
                       {"below the optimum", "", report::Axis::Scale::kLog, {}, {}},
                       fmt::format("Log-likelihood under the largest that either found. The direct search: {} passes over the "
                                   "record at full rate; EM: {}, "
                                   "{}. Below 0.1 no estimate changes in a digit that matters.",
                                   direct.passes, em.passes, em.converged ? "converged" : "not converged by then"));
  // At least two decades, as a shorter logarithmic axis has no numbers.
  double least = std::numeric_limits<double>::infinity();
  double greatest = 0.0;
  for (const report::Series* series : {&of_em, &of_direct})
    for (const double y : series->y) {
      least = std::min(least, y);
      greatest = std::max(greatest, y);
    }
  panel.plot().y.range.emplace(std::min(0.5 * least, 0.01 * greatest), 2.0 * greatest);
  const auto add = [&](const char* name, report::Series series, report::Tone tone) {
    if (series.x.empty()) return;
    report::add_points(panel.plot(), name, series, tone).radius_px = 2.5;
    report::add_line(panel.plot(), name, std::move(series), tone);
  };
  add("EM", std::move(of_em), report::Tone::kForward);
  add("direct search", std::move(of_direct), report::Tone::kSmoothed);
  return panel;
}

std::optional<report::Panel> whiteness_panel(const CalibratedAxis& axis) {
  const noise::Whiteness& whiteness = axis.result.whiteness;
  if (whiteness.autocorrelation.empty()) return {};
  report::Panel panel = report::xy_panel(
      id_of(axis) + "-innovations", "Autocorrelation of the innovations",
      {"lag", "samples", report::Axis::Scale::kLinear, {}, {}}, {"correlation", "", report::Axis::Scale::kLinear, {}, {}},
      fmt::format("Good: 19 of 20 inside the bounds; p = {:.2g} that white innovations would look like this (Ljung and Box). A "
                  "long record shows what is too small to matter: see how large the correlations are.",
                  whiteness.p_value));
  for (std::size_t lag = 5; lag <= whiteness.autocorrelation.size(); lag += 5)
    panel.plot().x.ticks.push_back({static_cast<double>(lag), fmt::format("{}", lag)});
  report::Series stems;
  double largest = 0.0;
  for (std::size_t i = 0; i < whiteness.autocorrelation.size(); ++i) {
    if (i > 0) stems.breaks.push_back(static_cast<std::uint32_t>(stems.x.size()));
    const auto lag = static_cast<double>(i + 1);
    stems.x.insert(stems.x.end(), {lag, lag});
    stems.y.insert(stems.y.end(), {0.0, whiteness.autocorrelation[i]});
    largest = std::max(largest, std::abs(whiteness.autocorrelation[i]));
  }
  const double bound = 1.96 / std::sqrt(static_cast<double>(axis.signals.front().values.size()));
  report::add_line(panel.plot(), "autocorrelation", std::move(stems), tone_of(axis)).width_px = 3.0;
  report::add_bound(panel.plot(), bound, "95 %");
  report::add_bound(panel.plot(), -bound);
  report::add_bound(panel.plot(), 0.0);
  const double reach = 1.2 * std::max(largest, bound);
  panel.plot().y.range.emplace(-reach, reach);
  return panel;
}

std::optional<report::Panel> records_panel(const CalibratedAxis& axis) {
  if (axis.own.size() < 2) return {};
  const noise::AxisCalibration& r = axis.result;
  const noise::SumModel& model = r.best().model;
  report::Panel panel = report::grid_panel(
      id_of(axis) + "-records", "Each record alone", 3,
      fmt::format("The same sum fitted to each record, with 95 % intervals by the Cramer-Rao bound; the dashed line is the "
                  "common estimate. That all have one set of parameters has p = {:.2g}.",
                  r.common_parameters_p.value_or(1.0)));
  for (std::size_t i = 0; i < model.parameters(); ++i) {
    const noise::ParameterInfo info = model.parameter(i);
    noise::ParameterEstimate one{};
    const auto shown = [&](double u) {
      one.value = info.value(u);
      return sheet_value(model, i, axis.axis.sensor, one).value;
    };
    const SheetValue common = sheet_value(model, i, axis.axis.sensor, r.parameters[i]);
    report::Plot& plot = report::add_cell(panel, common.name, "record", "", common.unit);
    plot.x.unit.clear();
    plot.link.clear();
    if (info.kind != noise::ParameterInfo::Kind::kPartial) plot.y.scale = report::Axis::Scale::kLog;
    report::Series values;
    report::Series bars;
    for (std::size_t k = 0; k < axis.own.size(); ++k) {
      const auto x = static_cast<double>(k + 1);
      plot.x.ticks.push_back({x, fmt::format("{}", k + 1)});
      values.x.push_back(x);
      values.y.push_back(shown(axis.own[k].u[i]));
      constexpr double kWidest = 4.0;  // of log: wider is as good as unknown
      const double reach = std::min(1.96 * axis.own[k].sd[i], kWidest);
      if (!bars.x.empty()) bars.breaks.push_back(static_cast<std::uint32_t>(bars.x.size()));
      bars.x.insert(bars.x.end(), {x, x});
      bars.y.insert(bars.y.end(), {shown(axis.own[k].u[i] - reach), shown(axis.own[k].u[i] + reach)});
    }
    report::add_line(plot, "95 %", std::move(bars), tone_of(axis)).width_px = 2.0;
    report::add_points(plot, "estimate", std::move(values), tone_of(axis)).radius_px = 4.0;
    report::add_bound(plot, common.value);
    plot.x.range.emplace(0.5, static_cast<double>(axis.own.size()) + 0.5);
  }
  return panel;
}

}  // namespace coast::jobs
