// One axis: tables, unobservable parameters, and its panels in order.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibrate/page/parts.hpp"
#include "calibrate/units.hpp"
#include "common/page_parts.hpp"

namespace coast::jobs {

namespace {

using report::Verdict;

std::string optional_figure(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? figure(*value) : "not bounded";
}

report::Note outlier_note(const noise::AxisCalibration& r) {
  const noise::Outlier& worst =
      *std::ranges::max_element(r.outliers, {}, [](const noise::Outlier& o) { return std::abs(o.sigmas); });
  const auto excluded = std::ranges::count_if(r.outliers, &noise::Outlier::excluded);
  return {report::Note::Kind::kWarning, fmt::format("{} outlier{}", r.outliers.size(), r.outliers.size() == 1 ? "" : "s"),
          fmt::format("Standardised innovations beyond what one clean record in a hundred shows; the largest, {:.1f} sigma, at "
                      "{:.2f} s. {}. `outliers: keep` or `outliers: exclude` in the calibration file decides for all.",
                      worst.sigmas, worst.time_s,
                      excluded > 0 ? fmt::format("{} of {} were left out and everything was estimated again", excluded,
                                                 r.outliers.size())
                                   : "They were kept")};
}

/// The two ways to the maximum have to agree.
std::optional<report::Note> search_note(const noise::AxisCalibration& r) {
  constexpr double kMatters = 0.1;
  if (!r.em) return {};
  const double lead = r.em->log_likelihood - r.best().fit.log_likelihood;
  if (!(lead > kMatters)) return {};
  return report::Note{report::Note::Kind::kWarning, "The direct search ended below EM",
                      fmt::format("EM came {:.2g} higher in log-likelihood, so the values below are not the maximum.", lead)};
}

std::string lead_of(const CalibratedAxis& axis) {
  const noise::AxisCalibration& r = axis.result;
  const noise::Candidate& best = r.best();
  std::string text =
      fmt::format("{} of {} candidates, with the {}. Log-likelihood {:.1f}.", best.model.name(), r.candidates.size(),
                  r.candidates.size() == 1 ? "processes stated" : "best criterion", best.fit.log_likelihood);
  if (!r.band.tau.empty())
    text += r.band.inside ? " The Allan curve is inside the simultaneous 95 % band of the estimate."
                          : " The Allan curve leaves the simultaneous 95 % band of the estimate.";
  if (r.common_parameters_p)
    text += fmt::format(" One set of parameters for all records against one for each: p = {:.2g}.", *r.common_parameters_p);
  return text;
}

}  // namespace

report::Table parameter_table(const CalibratedAxis& axis) {
  report::Table table;
  table.id = id_of(axis) + "-parameters";
  table.title = "Parameters";
  table.caption =
      "Interval: profile likelihood, or bootstrap where it was asked for; not bounded: the likelihood does not fall far "
      "enough. "
      "Bound: the Cramer-Rao standard deviation. Last: how long a record would have to be to know the value to 25 %.";
  table.columns = {
      {"parameter", "", false},      {"value", ""}, {"unit", "", false}, {"95 % from", ""}, {"to", ""}, {"bound", "%"},
      {"record for 25 %", "", false}};
  for (std::size_t i = 0; i < axis.result.parameters.size(); ++i) {
    const noise::ParameterEstimate& p = axis.result.parameters[i];
    const SheetValue v = sheet_value(axis.result.best().model, i, axis.axis.sensor, p);
    const bool bounded = v.lower.has_value() && v.upper.has_value();
    std::vector<report::Cell> row = cells({v.name, figure(v.value), v.unit, optional_figure(v.lower), optional_figure(v.upper),
                                           optional_figure(100.0 * v.relative_bound), duration_text(p.duration_for_quarter)});
    if (!bounded) row[v.lower ? 4 : 3].verdict = Verdict::kWarn;
    table.rows.push_back(std::move(row));
  }
  return table;
}

report::Table means_table(const CalibratedAxis& axis) {
  const char* unit = sheet_units(axis.axis.sensor).signal;
  report::Table table;
  table.id = id_of(axis) + "-means";
  table.title = "Level and drift";
  table.caption = "Level: at the middle of the record. Intervals: profile likelihood, with the processes free to follow.";
  table.columns = {{"record", "", false}, {"coefficient", "", false}, {"value", ""},
                   {"unit", "", false},   {"95 % from", ""},          {"to", ""}};
  const auto value = [unit](const std::optional<double>& si, double per) {
    return si ? figure(in_unit(*si * per, unit)) : std::string("not bounded");
  };
  for (std::size_t r = 0; r < axis.result.means.size(); ++r) {
    const noise::MeanEstimate& mean = axis.result.means[r];
    for (Eigen::Index k = 0; k < mean.value.size(); ++k) {
      const double per = k == 0 ? 1.0 : 3600.0;
      const noise::ProfileInterval& interval = axis.result.mean_intervals[r][static_cast<std::size_t>(k)];
      table.rows.push_back(
          cells({record_name(axis.signals[r].source), k == 0 ? "level" : "drift", value(mean.value(k), per),
                 k == 0 ? unit : fmt::format("{} per hour", unit), value(interval.lower, per), value(interval.upper, per)}));
    }
  }
  return table;
}

namespace {

/// The largest log-likelihood and the smallest criteria of the candidates compared on the same samples.
struct BestOf {
  double log_likelihood = -std::numeric_limits<double>::infinity();
  double bic = std::numeric_limits<double>::infinity();
  double aicc = std::numeric_limits<double>::infinity();
};
BestOf best_of(const std::vector<noise::Candidate>& candidates, bool on_all_samples) {
  BestOf best;
  for (const noise::Candidate& c : candidates) {
    if (c.on_all_samples != on_all_samples) continue;
    best.log_likelihood = std::max(best.log_likelihood, c.compared_log_likelihood);
    best.bic = std::min(best.bic, c.bic);
    best.aicc = std::min(best.aicc, c.aicc);
  }
  return best;
}

}  // namespace

report::Table candidate_table(const CalibratedAxis& axis) {
  const noise::AxisCalibration& r = axis.result;
  const BestOf of_extracts = best_of(r.candidates, false);
  const BestOf of_all = best_of(r.candidates, true);
  const bool held_out = std::ranges::any_of(r.candidates, [](const noise::Candidate& c) { return c.held_out.has_value(); });
  report::Table table;
  table.id = id_of(axis) + "-candidates";
  table.title = "Candidates";
  table.caption =
      "Differences to the largest log-likelihood and to the smallest criteria among those compared on the same samples: a long "
      "record is searched on block means and its beginning first, and the best go on with all samples. Degenerate: a variance "
      "went to zero, so the sum without that process says the same.";
  table.columns = {{"sum of processes", "", false},
                   {"compared on", "", false},
                   {"parameters", ""},
                   {"log-likelihood", ""},
                   {"BIC", ""},
                   {"AICc", ""}};
  if (held_out) table.columns.push_back({"held out, per sample", ""});
  table.columns.push_back({"remark", "", false});
  for (std::size_t i = 0; i < r.candidates.size(); ++i) {
    const noise::Candidate& c = r.candidates[i];
    const BestOf& best = c.on_all_samples ? of_all : of_extracts;
    const auto difference = [](double value, double reference) {
      return std::isfinite(value) ? decimals(value - reference, 1) : std::string("none");
    };
    std::vector<report::Cell> row =
        cells({c.model.name(), c.on_all_samples ? "all samples" : "extracts", fmt::format("{}", c.parameters),
               difference(c.compared_log_likelihood, best.log_likelihood), difference(c.bic, best.bic),
               difference(c.aicc, best.aicc)});
    if (held_out) row.push_back({c.held_out ? fmt::format("{:.6f}", *c.held_out) : "none"});
    row.push_back({i == r.chosen  ? "chosen"
                   : c.degenerate ? "degenerate"
                                  : "",
                   i == r.chosen ? Verdict::kGood : Verdict::kNone});
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::optional<report::Table> combination_table(const CalibratedAxis& axis) {
  constexpr double kNothing = 10.0;  // relative to the value itself
  if (axis.result.combinations.size() < 2) return {};
  report::Table table;
  table.id = id_of(axis) + "-combinations";
  table.title = "What the record knows";
  table.caption =
      "Directions of the information matrix, from the best known to the least: products of powers of the parameters.";
  table.columns = {{"combination", "", false}, {"known to", "%"}};
  for (const noise::Combination& c : axis.result.combinations)
    table.rows.push_back(cells({c.text, c.relative_sd < kNothing ? figure(100.0 * c.relative_sd) : "nothing known"}));
  return table;
}

report::Section axis_section(const CalibrationConfig& config, const CalibratedAxis& axis) {
  const noise::AxisCalibration& r = axis.result;
  report::Section section;
  section.id = id_of(axis);
  section.title = axis.axis.title();
  section.lead = lead_of(axis);
  for (const std::string& remark : r.remarks) section.notes.push_back({report::Note::Kind::kInfo, "", remark});
  if (!r.outliers.empty()) section.notes.push_back(outlier_note(r));
  if (auto note = search_note(r)) section.notes.push_back(std::move(*note));
  section.tables.push_back(parameter_table(axis));
  section.tables.push_back(means_table(axis));
  if (auto table = combination_table(axis)) section.tables.push_back(std::move(*table));
  section.tables.push_back(candidate_table(axis));
  if (auto table = tests_table(axis)) section.tables.push_back(std::move(*table));
  section.panels.push_back(allan_panel(axis));
  add_restitution(axis, config.common.seed, section);
  const auto add = [&](std::optional<report::Panel> panel) {
    if (panel) section.panels.push_back(std::move(*panel));
  };
  add(components_panel(axis));
  add(tests_panel(axis));
  add(records_panel(axis));
  add(whiteness_panel(axis));
  add(search_panel(axis));
  return section;
}

std::string id_of(const CalibratedAxis& axis) {
  return fmt::format("{}-{}", axis.axis.sensor_name(), axis.axis.axis_name());
}

report::Tone tone_of(const CalibratedAxis& axis) {
  return kComponentTones[static_cast<std::size_t>(axis.axis.axis)];
}

std::string record_name(const std::string& source) {
  std::string name = std::filesystem::path(source).filename().string();
  return name.substr(0, name.find('.', 1));
}

std::string duration_text(double seconds) {
  if (!std::isfinite(seconds)) return "no length";
  if (seconds < 600.0) return figure(seconds) + " s";
  if (seconds < 2.0 * 86400.0) return figure(seconds / 3600.0) + " h";
  return figure(seconds / 86400.0) + " d";
}

std::string figure(double value) {
  const double size = std::abs(value);
  if (size > 0.0 && (size < 1e-3 || size >= 1e6)) return fmt::format("{:.2e}", value);
  return number(value);
}

}  // namespace coast::jobs
