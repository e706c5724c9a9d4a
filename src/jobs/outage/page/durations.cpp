// For an outage study with several durations, or several manoeuvres: drift, prediction and gain as functions of them.

#include <fmt/format.h>

#include <set>

#include "coast/report/panels.hpp"
#include "common/page_parts.hpp"
#include "outage/tables.hpp"

namespace coast::jobs {

namespace {

using report::Axis;
using study::Drift;
using study::ModelRun;

constexpr std::array kRunTones{report::Tone::kX, report::Tone::kY, report::Tone::kZ, report::Tone::kReference};

report::Tone tone_of(std::size_t run) {
  return run < kRunTones.size() ? kRunTones[run] : report::Tone::kAuto;
}

std::string name_of(const OutageStudy& study, const ModelRun& run) {
  return study.truths > 1 ? fmt::format("{}, sensors by {}", run.filter, run.truth) : run.filter;
}

/// A number of one solution of one run, as function of duration.
template <class Value>
report::Series over_durations(const OutageStudy& study, const ModelRun& run, Value value) {
  report::Series series;
  for (std::size_t g = 0; g < study.result.groups.size(); ++g) {
    series.x.push_back(study.result.groups[g].duration_s);
    series.y.push_back(value(run.outages[g]));
  }
  return series;
}

double horizontal(const Eigen::Vector3d& ned) {
  return ned.head<2>().norm();
}

double end_rms(const Drift& drift) {
  return std::hypot(drift.end[0].rms, drift.end[1].rms);
}

Axis duration_axis() {
  return {"duration of the outage", "s", Axis::Scale::kLog, {}, {}};
}

report::Panel drift_panel(const OutageStudy& study) {
  report::Panel panel = report::grid_panel("durations-drift", "Drift against duration", 2,
                                           "Largest horizontal error of an outage: median in full, 68 % thin, 95 % dashed, the "
                                           "largest as dots. Noise of accelerometers grows with the power 1.5, of gyros with "
                                           "2.5.");
  for (const bool smoothed : {false, true}) {
    report::Plot& plot = report::add_cell(panel, smoothed ? "smoothed" : "forward", "", "", "m");
    plot.x = duration_axis();
    plot.y = {"largest horizontal error", "m", Axis::Scale::kLog, {}, {}};
    plot.link.clear();
    plot.height_px = 320;
    for (std::size_t i = 0; i < study.result.runs.size(); ++i) {
      const ModelRun& run = study.result.runs[i];
      const std::string name = name_of(study, run);
      const auto of = [&](double study::Spread::*quantile) {
        return over_durations(study, run,
                              [&](const auto& outages) { return study::drift_of(outages, smoothed).horizontal.*quantile; });
      };
      report::add_line(plot, name + ", median", of(&study::Spread::median), tone_of(i)).width_px = 2.2;
      report::add_line(plot, name + ", 68 %", of(&study::Spread::p68), tone_of(i)).width_px = 1.0;
      report::add_line(plot, name + ", 95 %", of(&study::Spread::p95), tone_of(i)).style = report::Line::Style::kDashed;
      report::add_points(plot, name + ", largest", of(&study::Spread::max), tone_of(i)).radius_px = 2.5;
    }
  }
  return panel;
}

report::Panel prediction_panel(const OutageStudy& study) {
  report::Panel panel =
      report::grid_panel("durations-prediction", "Predicted and actual", 2,
                         "Left: root mean square of the forward error at the end of an outage over that of the sigma stated "
                         "there, horizontal; 1 is a "
                         "filter that knows its sensors. Right: share of all errors, axis by axis, inside their stated 95 %.");
  report::add_cell(panel, "error over stated sigma", "", "", "");
  report::add_cell(panel, "inside 95 %", "", "", "%");
  report::Plot& ratio = panel.plots[0];  // after the last add_cell, which moves the cells
  report::Plot& inside = panel.plots[1];
  ratio.y.label = "rms : sigma";
  inside.y.label = "inside";
  ratio.bounds.push_back({1.0, "as stated", report::Tone::kMuted});
  inside.bounds.push_back({95.0, "95 %", report::Tone::kMuted});
  for (report::Plot* plot : {&ratio, &inside}) {
    plot->x = duration_axis();
    plot->link.clear();
    plot->height_px = 260;
  }
  for (std::size_t i = 0; i < study.result.runs.size(); ++i) {
    const ModelRun& run = study.result.runs[i];
    report::add_line(ratio, name_of(study, run),
                     over_durations(study, run,
                                    [](const auto& outages) {
                                      const Drift drift = study::drift_of(outages, false);
                                      return end_rms(drift) / horizontal(drift.predicted_end_rms_m);
                                    }),
                     tone_of(i))
        .width_px = 2.0;
    for (const bool smoothed : {false, true}) {
      report::Line& line = report::add_line(
          inside, name_of(study, run) + (smoothed ? ", smoothed" : ", forward"),
          over_durations(study, run, [&](const auto& outages) { return 100.0 * study::drift_of(outages, smoothed).inside_95; }),
          tone_of(i));
      line.width_px = 2.0;
      if (smoothed) line.style = report::Line::Style::kDashed;
    }
  }
  return panel;
}

double gain_of(const std::vector<study::OutageResult>& outages) {
  return study::drift_of(outages, false).horizontal.rms / study::drift_of(outages, true).horizontal.rms;
}

report::Panel gain_panel(const OutageStudy& study) {
  report::Panel panel = report::xy_panel(
      "durations-gain", "What the smoother gains", duration_axis(), {"forward : smoothed", "", Axis::Scale::kLog, {}, {}},
      "Root mean square of the largest horizontal error, forward over smoothed. With everything known on either side of the "
      "outage it is 8 where white noise of accelerometers drifts and 32 where that of gyros does.");
  report::Plot& plot = panel.plot();
  plot.height_px = 260;
  plot.bounds.push_back({study::kSmoothingGainOfAccelNoise, "accelerometer noise", report::Tone::kMuted});
  plot.bounds.push_back({study::kSmoothingGainOfGyroNoise, "gyro noise", report::Tone::kMuted});
  for (std::size_t i = 0; i < study.result.runs.size(); ++i)
    report::add_line(plot, name_of(study, study.result.runs[i]), over_durations(study, study.result.runs[i], gain_of),
                     tone_of(i))
        .width_px = 2.0;
  return panel;
}

report::Table duration_table(const OutageStudy& study) {
  report::Table table;
  table.id = "durations-table";
  table.title = "By duration";
  table.caption =
      "Largest horizontal error over the outages of a duration, forward and smoothed; gain: rms of forward over that of "
      "smoothed; inside: share of all errors within their stated 95 %, forward and smoothed.";
  table.columns = {{"error model", "", false}, {"duration", "s"},     {"outages", ""},          {"forward median", "m"},
                   {"forward rms", "m"},       {"forward 95 %", "m"}, {"smoothed median", "m"}, {"smoothed rms", "m"},
                   {"smoothed 95 %", "m"},     {"gain", ""},          {"forward inside", "%"},  {"smoothed inside", "%"}};
  for (const ModelRun& run : study.result.runs)
    for (std::size_t g = 0; g < study.result.groups.size(); ++g) {
      const Drift forward = study::drift_of(run.outages[g], false);
      const Drift smoothed = study::drift_of(run.outages[g], true);
      const std::size_t count = run.outages[g].size();
      auto row = cells({name_of(study, run), fmt::format("{:g}", study.result.groups[g].duration_s), fmt::format("{}", count),
                        number(forward.horizontal.median), number(forward.horizontal.rms), number(forward.horizontal.p95),
                        number(smoothed.horizontal.median), number(smoothed.horizontal.rms), number(smoothed.horizontal.p95),
                        number(forward.horizontal.rms / smoothed.horizontal.rms), percent(forward.inside_95),
                        percent(smoothed.inside_95)});
      row[row.size() - 2].verdict = verdict_of_share(forward.inside_95, count);
      row.back().verdict = verdict_of_share(smoothed.inside_95, count);
      table.rows.push_back(std::move(row));
    }
  return table;
}

report::Table manoeuvre_table(const OutageStudy& study) {
  report::Table table;
  table.id = "manoeuvres-table";
  table.title = "By manoeuvre";
  table.caption =
      "What was flown or driven during an outage: static, straight at even speed, accelerating (0.5 m/s^2 rms), turn (3 "
      "deg/s). "
      "Medians of the largest horizontal error.";
  table.columns = {{"error model", "", false}, {"duration", "s"}, {"manoeuvre", "", false}, {"outages", ""},
                   {"forward", "m"},           {"smoothed", "m"}, {"forward inside", "%"},  {"smoothed inside", "%"}};
  for (const ModelRun& run : study.result.runs)
    for (std::size_t g = 0; g < study.result.groups.size(); ++g)
      for (const ManoeuvreDrift& part : by_manoeuvre(run.outages[g])) {
        const Drift forward = study::drift_of(part.outages, false);
        const Drift smoothed = study::drift_of(part.outages, true);
        auto row = cells({name_of(study, run), fmt::format("{:g}", study.result.groups[g].duration_s),
                          std::string(study::name(part.manoeuvre)), fmt::format("{}", part.outages.size()),
                          number(forward.horizontal.median), number(smoothed.horizontal.median), percent(forward.inside_95),
                          percent(smoothed.inside_95)});
        row[row.size() - 2].verdict = verdict_of_share(forward.inside_95, part.outages.size());
        row.back().verdict = verdict_of_share(smoothed.inside_95, part.outages.size());
        table.rows.push_back(std::move(row));
      }
  return table;
}

std::size_t manoeuvres(const OutageStudy& study) {
  std::set<study::Manoeuvre> all;
  for (const auto& group : study.result.runs.front().outages)
    for (const study::OutageResult& outage : group) all.insert(outage.manoeuvre);
  return all.size();
}

}  // namespace

void add_durations(const OutageStudy& study, report::Page& page) {
  const bool durations = study.result.groups.size() > 1;
  const bool several = manoeuvres(study) > 1;
  if (!durations && !several) return;
  report::Section section;
  section.id = "durations";
  section.title = "All outages";
  section.lead = study.described;
  if (durations) {
    section.tables.push_back(duration_table(study));
    section.panels.push_back(drift_panel(study));
    section.panels.push_back(prediction_panel(study));
    section.panels.push_back(gain_panel(study));
  }
  if (several) section.tables.push_back(manoeuvre_table(study));
  page.sections.push_back(std::move(section));
}

}  // namespace coast::jobs
