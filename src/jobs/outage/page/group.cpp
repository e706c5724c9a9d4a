// Sections of the page of an outage study, one for each group of outages and truth: comparison of error models.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coast/report/panels.hpp"
#include "common/page_parts.hpp"
#include "outage/tables.hpp"

namespace coast::jobs {

namespace {

using study::DriftMeasure;
using study::ModelRun;

/// One group of outages of one truth: the content of a section.
struct View {
  const OutageStudy& study;
  std::size_t group;
  std::string truth;
  std::string id;
  std::vector<const ModelRun*> runs;    ///< one per error model
  std::vector<const ModelRun*> floors;  ///< truth and error model the same, with less noise

  [[nodiscard]] const std::vector<study::OutageResult>& outages(const ModelRun& run) const { return run.outages[group]; }
  [[nodiscard]] const study::OutageGroup& gap() const { return study.result.groups[group]; }
  [[nodiscard]] bool one_place() const { return gap().starts_s.size() == 1; }
  /// What is counted: seeds of one outage, outages of one recording, or both.
  [[nodiscard]] const char* draws() const { return study.simulated && one_place() ? "seeds" : "outages"; }
};

constexpr std::array kModelTones{report::Tone::kX, report::Tone::kY, report::Tone::kZ};
constexpr std::array kFloorTones{report::Tone::kMuted, report::Tone::kReference};

report::Tone tone_of_run(const View& view, const ModelRun& run) {
  for (std::size_t i = 0; i < view.runs.size() && i < kModelTones.size(); ++i)
    if (view.runs[i] == &run) return kModelTones[i];
  for (std::size_t i = 0; i < view.floors.size() && i < kFloorTones.size(); ++i)
    if (view.floors[i] == &run) return kFloorTones[i];
  return report::Tone::kAuto;
}

std::vector<const ModelRun*> runs_and_floors(const View& view) {
  std::vector<const ModelRun*> all = view.runs;
  all.insert(all.end(), view.floors.begin(), view.floors.end());
  return all;
}

report::Table drift_table_of(const View& view) {
  report::Table table;
  table.id = view.id + "-drift-table";
  table.title = fmt::format("Drift over the {}", view.draws());
  table.caption =
      "Of the largest error inside each outage: horizontal by median, root mean square and 95 % quantile; N, E, D by root "
      "mean square. Inside: share of all errors within their stated 95 %.";
  table.columns = {{"error model", "", false},
                   {"solution", "", false},
                   {"median", "m"},
                   {"rms", "m"},
                   {"95 %", "m"},
                   {"N, rms", "m"},
                   {"E, rms", "m"},
                   {"D, rms", "m"},
                   {"inside", "%"}};
  for (const ModelRun* run : runs_and_floors(view))
    for (const bool smoothed : {false, true}) {
      const study::Drift drift = study::drift_of(view.outages(*run), smoothed);
      auto row = cells({run->filter, smoothed ? "smoothed" : "forward", number(drift.horizontal.median),
                        number(drift.horizontal.rms), number(drift.horizontal.p95), number(drift.largest[0].rms),
                        number(drift.largest[1].rms), number(drift.largest[2].rms), percent(drift.inside_95)});
      row.back().verdict = verdict_of_share(drift.inside_95, view.outages(*run).size());
      table.rows.push_back(std::move(row));
    }
  return table;
}

report::Table end_table(const View& view) {
  report::Table table;
  table.id = view.id + "-end-table";
  table.title = "At the end of the outage, forward";
  table.caption =
      "Root mean square of the error, and of the one sigma that the filter states: alike where the filter knows "
      "what its sensors do; an error above the stated sigma is a filter too sure of itself.";
  table.columns = {{"error model", "", false}};
  for (const std::string& axis : kNed) {
    table.columns.push_back({axis, "m"});
    table.columns.push_back({axis + " stated", "m"});
  }
  for (const ModelRun* run : runs_and_floors(view)) {
    const study::Drift drift = study::drift_of(view.outages(*run), false);
    auto row = cells({run->filter});
    for (std::size_t axis = 0; axis < 3; ++axis) {
      row.push_back({number(drift.end[axis].rms)});
      row.push_back({number(drift.predicted_end_rms_m(static_cast<Eigen::Index>(axis)))});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string interval(const study::PairedRatio& paired) {
  return fmt::format("{:.3f} ({:.3f} to {:.3f})", paired.ratio, paired.low, paired.high);
}

study::PairedRatio paired_of(const View& view, const StudyPair& pair, DriftMeasure measure, bool smoothed) {
  return study::compare(view.study.result, *pair.first, *pair.second, view.group, measure, smoothed);
}

report::Table paired_table(const View& view) {
  report::Table table;
  table.id = view.id + "-paired";
  table.title = "Paired ratios";
  table.caption =
      "Largest error of the second over that of the first, pair by pair: geometric mean with its 95 % interval; below 1 the "
      "second drifts less. Smaller: pairs in which the second's horizontal error is the smaller one, with the probability of "
      "so uneven a split by chance (sign test).";
  table.columns = {{"second : first", "", false}, {"solution", "", false}, {"N", "", false}, {"E", "", false}, {"D", "", false},
                   {"horizontal", "", false},     {"smaller", "", false},  {"by chance", ""}};
  for (const StudyPair& pair : pairs_of(view.study)) {
    if (pair.first->truth != view.truth) continue;
    for (const bool smoothed : {false, true}) {
      const auto of = [&](DriftMeasure measure) { return paired_of(view, pair, measure, smoothed); };
      const study::PairedRatio horizontal = of(DriftMeasure::kHorizontal);
      table.rows.push_back(
          cells({fmt::format("{} : {}", pair.second->filter, pair.first->filter), smoothed ? "smoothed" : "forward",
                 interval(of(DriftMeasure::kNorth)), interval(of(DriftMeasure::kEast)), interval(of(DriftMeasure::kDown)),
                 interval(horizontal), fmt::format("{} of {}", horizontal.second_smaller, horizontal.pairs),
                 number(horizontal.sign_test, 2)}));
    }
  }
  return table;
}

/// Fraction of the outages whose largest horizontal error is below x.
report::Panel distribution_panel(const View& view) {
  report::Panel panel = report::grid_panel(
      view.id + "-distribution", fmt::format("Distribution of the drift over the {}", view.draws()), 2,
      fmt::format("Share of the {} with a smaller largest horizontal error. The curve further left drifts less{}.",
                  view.draws(),
                  view.floors.empty() ? "" : "; the dashed floors are as far left as an error model can bring it"));
  for (const bool smoothed : {false, true}) {
    report::Plot& plot = report::add_cell(panel, smoothed ? "smoothed" : "forward", "", view.draws(), "%");
    plot.x = {"largest horizontal error", "m", report::Axis::Scale::kLog, {}, {}};
    plot.link.clear();
    plot.height_px = 300;
    const auto add = [&](const ModelRun& run, report::Line::Style style) {
      std::vector<double> errors = study::drifts(view.outages(run), DriftMeasure::kHorizontal, smoothed);
      std::ranges::sort(errors);
      report::Series series;
      for (std::size_t i = 0; i < errors.size(); ++i) {
        series.x.push_back(errors[i]);
        series.y.push_back(100.0 * static_cast<double>(i + 1) / static_cast<double>(errors.size()));
      }
      report::Line& line = report::add_line(plot, run.filter, std::move(series), tone_of_run(view, run));
      line.style = style;
      line.width_px = 1.8;
    };
    for (const ModelRun* run : view.floors) add(*run, report::Line::Style::kDashed);
    for (const ModelRun* run : view.runs) add(*run, report::Line::Style::kLine);
  }
  return panel;
}

/// Every outage by its error with the first error model and with the others.
report::Panel pairs_panel(const View& view) {
  report::Panel panel =
      report::grid_panel(view.id + "-pairs", "Pair by pair", 2,
                         fmt::format("Largest horizontal error with {} against that with the other model; below "
                                     "the line the other drifts less.",
                                     view.runs.front()->filter));
  for (const bool smoothed : {false, true}) {
    report::Plot& plot = report::add_cell(panel, smoothed ? "smoothed" : "forward", "", "", "m");
    plot.x = {view.runs.front()->filter, "m", report::Axis::Scale::kLog, {}, {}};
    plot.y = {"the other", "m", report::Axis::Scale::kLog, {}, {}};
    plot.link.clear();
    plot.height_px = 300;
    const std::vector<double> first = study::drifts(view.outages(*view.runs.front()), DriftMeasure::kHorizontal, smoothed);
    const auto [least, greatest] = std::ranges::minmax(first);
    report::Series equal;
    equal.x = equal.y = {least, greatest};
    report::add_line(plot, "equal", std::move(equal), report::Tone::kMuted);
    for (std::size_t i = 1; i < view.runs.size(); ++i) {
      report::Series series;
      series.x = first;
      series.y = study::drifts(view.outages(*view.runs[i]), DriftMeasure::kHorizontal, smoothed);
      report::add_points(plot, view.runs[i]->filter, std::move(series), tone_of_run(view, *view.runs[i])).radius_px = 2.5;
    }
  }
  return panel;
}

/// The first outage as in the paper: N, E, D in rows, one curve per error model; forward left, smoothed right.
report::Panel first_outage_panel(const View& view) {
  report::Panel panel = report::grid_panel(
      view.id + "-ned", fmt::format("Errors through the outage, seed {}", view.study.first_seed), 2,
      "The first error model in full, the others dashed, as in Figs. 4 and 5 of Stebler et al. (2011). One seed is one draw: "
      "the tables tell which difference lasts.");
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    for (const bool smoothed : {false, true}) {
      const char* title = smoothed ? "smoothed" : "forward";
      report::Plot& plot =
          report::add_cell(panel, axis == 0 ? title : "", "time in outage", kNed[static_cast<std::size_t>(axis)], "m");
      for (const ModelRun* run : view.runs) {
        const study::OutageResult& seed = view.outages(*run).front();
        report::Series series;
        for (const study::ErrorSample& sample : (smoothed ? *seed.smoothed : seed.forward).series) {
          series.x.push_back(sample.t - seed.outage.start);
          series.y.push_back(sample.position_n(axis));
        }
        report::Line& line = report::add_line(plot, run->filter, std::move(series), tone_of_run(view, *run));
        if (run != view.runs.front()) line.style = report::Line::Style::kDashed;
        line.width_px = 1.8;
      }
      plot.intervals.push_back({0.0, view.gap().duration_s, {}, report::Tone::kMuted});
      plot.height_px = 150;
    }
  return panel;
}

std::string lead_of(const View& view) {
  const study::OutageGroup& gap = view.gap();
  const std::string where =
      view.one_place()
          ? fmt::format("GNSS is withheld from {:.1f} s for {:g} s.", gap.starts_s.front(), gap.duration_s)
          : fmt::format("GNSS is withheld for {:g} s at {} places, one at a time.", gap.duration_s, gap.starts_s.size());
  std::string lead = view.study.described + " " + where;
  if (!view.study.simulated) return lead;
  const auto run = static_cast<std::size_t>(view.runs.front() - view.study.result.runs.data());
  lead += fmt::format(
      " White gyro noise alone, with all else known when GNSS is lost, drifts {} m (rms, each of N and E, closed form).",
      number(study::gyro_noise_drift(view.study.gyro_noise[run], gap.duration_s)));
  if (!view.floors.empty())
    lead +=
        " A floor is simulated with that noise alone, the same draws of it, and processed by a filter that knows it: no error "
        "model of sensors with at least that noise gets below it in the root mean square.";
  return lead;
}

report::Section section_of(const View& view) {
  report::Section section;
  section.id = view.id;
  section.title = fmt::format("{} of {:g} s", view.one_place() ? "Outage" : "Outages", view.gap().duration_s);
  if (view.study.simulated) section.title += ", sensors by " + view.truth;
  section.lead = lead_of(view);
  section.tables.push_back(drift_table_of(view));
  section.tables.push_back(end_table(view));
  if (view.runs.size() + view.floors.size() > 1) section.tables.push_back(paired_table(view));
  section.panels.push_back(distribution_panel(view));
  if (view.runs.size() > 1) section.panels.push_back(pairs_panel(view));
  if (!view.outages(*view.runs.front()).front().forward.series.empty()) section.panels.push_back(first_outage_panel(view));
  return section;
}

void add_tiles(const View& view, report::Page& page) {
  for (const StudyPair& pair : pairs_of(view.study))
    for (const bool smoothed : {false, true}) {
      if (pair.floor || pair.first->truth != view.truth) continue;
      const study::PairedRatio ratio = paired_of(view, pair, DriftMeasure::kHorizontal, smoothed);
      report::Tile tile;
      tile.label =
          fmt::format("{} : {}, {}, {:g} s{}", pair.second->filter, pair.first->filter, smoothed ? "smoothed" : "forward",
                      view.gap().duration_s, view.truth.empty() ? "" : ", sensors by " + view.truth);
      tile.value = fmt::format("{:.3f}", ratio.ratio);
      tile.explanation = fmt::format(
          "Ratio of the largest horizontal errors in {:g} s, geometric mean over {} {}; 95 % interval {:.3f} to {:.3f}. "
          "Below 1: {} drifts less.",
          view.gap().duration_s, ratio.pairs, view.draws(), ratio.low, ratio.high, pair.second->filter);
      tile.section = view.id + "-distribution";
      page.tiles.push_back(std::move(tile));
    }
}

}  // namespace

void add_groups(const OutageStudy& study, report::Page& page) {
  const std::vector<ModelRun>& runs = study.result.runs;
  for (std::size_t group = 0; group < study.result.groups.size(); ++group)
    for (std::size_t truth = 0; truth < study.truths; ++truth) {
      const std::size_t first = truth * study.models;
      View view{study, group, runs[first].truth, fmt::format("outage-{}-truth-{}", group + 1, truth + 1), {}, {}};
      for (std::size_t i = 0; i < study.models; ++i) view.runs.push_back(&runs[first + i]);
      for (std::size_t i = study.truths * study.models; i < runs.size(); ++i) view.floors.push_back(&runs[i]);
      add_tiles(view, page);
      page.sections.push_back(section_of(view));
    }
}

}  // namespace coast::jobs
