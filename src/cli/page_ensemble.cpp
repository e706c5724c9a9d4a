// The page of an ensemble: how error models compare over many seeds of one scenario.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coast/report/panels.hpp"
#include "outage_page.hpp"
#include "page_parts.hpp"

namespace coast::cli {

namespace {

using study::DriftMeasure;
using study::EnsembleRun;

/// One outage of one truth: what a section shows.
struct View {
  const EnsembleStudy& study;
  const study::EnsembleResult& result;
  std::size_t outage;
  std::string truth;
  std::string id;
  std::vector<const EnsembleRun*> runs;    ///< one per error model
  std::vector<const EnsembleRun*> floors;  ///< truth and error model the same, with less noise

  [[nodiscard]] const std::vector<study::OutageResult>& seeds(const EnsembleRun& run) const { return run.outages[outage]; }
  [[nodiscard]] const study::ElapsedOutage& gap() const { return result.outages[outage]; }
};

constexpr std::array kModelTones{report::Tone::kX, report::Tone::kY, report::Tone::kZ};
constexpr std::array kFloorTones{report::Tone::kMuted, report::Tone::kReference};

report::Tone tone_of_run(const View& view, const EnsembleRun& run) {
  for (std::size_t i = 0; i < view.runs.size() && i < kModelTones.size(); ++i)
    if (view.runs[i] == &run) return kModelTones[i];
  for (std::size_t i = 0; i < view.floors.size() && i < kFloorTones.size(); ++i)
    if (view.floors[i] == &run) return kFloorTones[i];
  return report::Tone::kAuto;
}

std::vector<const EnsembleRun*> runs_and_floors(const View& view) {
  std::vector<const EnsembleRun*> all = view.runs;
  all.insert(all.end(), view.floors.begin(), view.floors.end());
  return all;
}

report::Table drift_table_of(const View& view) {
  report::Table table;
  table.id = view.id + "-drift-table";
  table.title = "Drift over the seeds";
  table.caption =
      "Of the largest error inside each seed's outage: horizontal by median, root mean square and 95 % quantile over the "
      "seeds; N, E, D by root mean square. Inside: share of all errors within their stated 95 %.";
  table.columns = {{"error model", "", false},
                   {"solution", "", false},
                   {"median", "m"},
                   {"rms", "m"},
                   {"95 %", "m"},
                   {"N, rms", "m"},
                   {"E, rms", "m"},
                   {"D, rms", "m"},
                   {"inside", "%"}};
  for (const EnsembleRun* run : runs_and_floors(view))
    for (const bool smoothed : {false, true}) {
      const study::EnsembleDrift drift = study::ensemble_drift(view.seeds(*run), smoothed);
      auto row = cells({run->filter, smoothed ? "smoothed" : "forward", number(drift.horizontal.median),
                        number(drift.horizontal.rms), number(drift.horizontal.p95), number(drift.largest[0].rms),
                        number(drift.largest[1].rms), number(drift.largest[2].rms), percent(drift.inside_95)});
      row.back().verdict = verdict_of_share(drift.inside_95, view.seeds(*run).size());
      table.rows.push_back(std::move(row));
    }
  return table;
}

report::Table end_table(const View& view) {
  report::Table table;
  table.id = view.id + "-end-table";
  table.title = "At the end of the outage, forward";
  table.caption =
      "Root mean square over the seeds of the error, and of the one sigma that the filter states: alike where the filter knows "
      "what its sensors do; an error above the stated sigma is a filter too sure of itself.";
  table.columns = {{"error model", "", false}};
  for (const std::string& axis : kNed) {
    table.columns.push_back({axis, "m"});
    table.columns.push_back({axis + " stated", "m"});
  }
  for (const EnsembleRun* run : runs_and_floors(view)) {
    const study::EnsembleDrift drift = study::ensemble_drift(view.seeds(*run), false);
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

study::PairedRatio paired_of(const EnsemblePair& pair, std::size_t outage, DriftMeasure measure, bool smoothed) {
  return study::paired_ratio(study::drifts(pair.first->outages[outage], measure, smoothed),
                             study::drifts(pair.second->outages[outage], measure, smoothed));
}

report::Table paired_table(const View& view) {
  report::Table table;
  table.id = view.id + "-paired";
  table.title = "Paired ratios";
  table.caption =
      "Largest error of the second over that of the first, seed by seed: geometric mean with its 95 % interval; below 1 the "
      "second drifts less. Smaller: seeds in which the second's horizontal error is the smaller one, with the probability of "
      "so "
      "uneven a split by chance (sign test).";
  table.columns = {{"second : first", "", false}, {"solution", "", false}, {"N", "", false}, {"E", "", false}, {"D", "", false},
                   {"horizontal", "", false},     {"smaller", "", false},  {"by chance", ""}};
  for (const EnsemblePair& pair : pairs_of(view.study, view.result)) {
    if (pair.first->truth != view.truth) continue;
    for (const bool smoothed : {false, true}) {
      const auto of = [&](DriftMeasure measure) { return paired_of(pair, view.outage, measure, smoothed); };
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

/// Share of the seeds whose largest horizontal error is below x.
report::Panel distribution_panel(const View& view) {
  report::Panel panel = report::grid_panel(view.id + "-distribution", "Distribution of the drift over the seeds", 2,
                                           "Share of the seeds with a smaller largest horizontal error. The curve further left "
                                           "drifts less; the dashed floors are as far left as an error "
                                           "model can bring it.");
  for (const bool smoothed : {false, true}) {
    report::Plot& plot = report::add_cell(panel, smoothed ? "smoothed" : "forward", "", "seeds", "%");
    plot.x = {"largest horizontal error", "m", report::Axis::Scale::kLog, {}, {}};
    plot.link.clear();
    plot.height_px = 300;
    const auto add = [&](const EnsembleRun& run, report::Line::Style style) {
      std::vector<double> errors = study::drifts(view.seeds(run), DriftMeasure::kHorizontal, smoothed);
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
    for (const EnsembleRun* run : view.floors) add(*run, report::Line::Style::kDashed);
    for (const EnsembleRun* run : view.runs) add(*run, report::Line::Style::kLine);
  }
  return panel;
}

/// Every seed at its error with the first error model and with the others.
report::Panel pairs_panel(const View& view) {
  report::Panel panel =
      report::grid_panel(view.id + "-pairs", "Seed by seed", 2,
                         fmt::format("Largest horizontal error with {} against that with the other model; below "
                                     "the line the other drifts less.",
                                     view.runs.front()->filter));
  for (const bool smoothed : {false, true}) {
    report::Plot& plot = report::add_cell(panel, smoothed ? "smoothed" : "forward", "", "", "m");
    plot.x = {view.runs.front()->filter, "m", report::Axis::Scale::kLog, {}, {}};
    plot.y = {"the other", "m", report::Axis::Scale::kLog, {}, {}};
    plot.link.clear();
    plot.height_px = 300;
    const std::vector<double> first = study::drifts(view.seeds(*view.runs.front()), DriftMeasure::kHorizontal, smoothed);
    const auto [least, greatest] = std::ranges::minmax(first);
    report::Series equal;
    equal.x = equal.y = {least, greatest};
    report::add_line(plot, "equal", std::move(equal), report::Tone::kMuted);
    for (std::size_t i = 1; i < view.runs.size(); ++i) {
      report::Series series;
      series.x = first;
      series.y = study::drifts(view.seeds(*view.runs[i]), DriftMeasure::kHorizontal, smoothed);
      report::add_points(plot, view.runs[i]->filter, std::move(series), tone_of_run(view, *view.runs[i])).radius_px = 2.5;
    }
  }
  return panel;
}

/// The first seed as the paper draws it: N, E, D in rows, one curve per error model; forward left, smoothed right.
report::Panel first_seed_panel(const View& view) {
  report::Panel panel = report::grid_panel(
      view.id + "-ned", fmt::format("Errors through the outage, seed {}", view.study.plan.first_seed), 2,
      "The first error model in full, the others dashed, as in Figs. 4 and 5 of Stebler et al. (2011). One seed is one draw: "
      "the tables tell which difference lasts.");
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    for (const bool smoothed : {false, true}) {
      const char* title = smoothed ? "smoothed" : "forward";
      report::Plot& plot =
          report::add_cell(panel, axis == 0 ? title : "", "time in outage", kNed[static_cast<std::size_t>(axis)], "m");
      for (const EnsembleRun* run : view.runs) {
        const study::OutageResult& seed = view.seeds(*run).front();
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

report::Section section_of(const View& view) {
  report::Section section;
  section.id = view.id;
  section.title = fmt::format("Outage of {:g} s, sensors by {}", view.gap().duration_s, view.truth);
  section.lead = fmt::format(
      "Simulated: the motion, GNSS and sensor errors of {}, with the errors of the IMU drawn from {}, seeds {} to {}. Each "
      "recording is processed with every error model, GNSS and IMU alone, and compared with the simulated truth; GNSS is "
      "withheld from {:.1f} s for {:g} s. White gyro noise alone, with all else known when GNSS is lost, drifts {} m (rms, "
      "each of N and E, closed form).",
      view.study.scenario.filename().string(), view.truth, view.study.plan.first_seed,
      view.study.plan.first_seed + view.study.plan.seeds - 1, view.gap().start_s, view.gap().duration_s,
      number(gyro_noise_drift_of(view.study, *view.runs.front(), view.gap().duration_s)));
  if (!view.floors.empty())
    section.lead +=
        " A floor is simulated with that noise alone, the same draws of it, and processed by a filter that knows it: no error "
        "model of sensors with at least that noise gets below it in the root mean square.";
  section.tables.push_back(drift_table_of(view));
  section.tables.push_back(end_table(view));
  section.tables.push_back(paired_table(view));
  section.panels.push_back(distribution_panel(view));
  if (view.runs.size() > 1) section.panels.push_back(pairs_panel(view));
  section.panels.push_back(first_seed_panel(view));
  return section;
}

void add_tiles(const View& view, report::Page& page) {
  for (const EnsemblePair& pair : pairs_of(view.study, view.result))
    for (const bool smoothed : {false, true}) {
      if (pair.floor || pair.first->truth != view.truth) continue;
      const study::PairedRatio ratio = paired_of(pair, view.outage, DriftMeasure::kHorizontal, smoothed);
      report::Tile tile;
      tile.label = fmt::format("{} : {}, {}, sensors by {}", pair.second->filter, pair.first->filter,
                               smoothed ? "smoothed" : "forward", view.truth);
      tile.value = fmt::format("{:.3f}", ratio.ratio);
      tile.explanation = fmt::format(
          "Ratio of the largest horizontal errors in {:g} s, geometric mean over {} seeds; 95 % interval {:.3f} to {:.3f}. "
          "Below 1: {} drifts less.",
          view.gap().duration_s, ratio.pairs, ratio.low, ratio.high, pair.second->filter);
      tile.section = view.id + "-distribution";
      page.tiles.push_back(std::move(tile));
    }
}

}  // namespace

std::vector<EnsemblePair> pairs_of(const EnsembleStudy& study, const study::EnsembleResult& result) {
  const std::size_t filters = study.filters.size();
  const std::size_t floors = study.truths * filters;  // where they begin among the runs
  std::vector<EnsemblePair> pairs;
  for (std::size_t truth = 0; truth < study.truths; ++truth) {
    const EnsembleRun* first = &result.runs[truth * filters];
    for (std::size_t i = 1; i < filters; ++i) pairs.push_back({first, first + i});
    for (std::size_t i = floors; i < result.runs.size(); ++i) pairs.push_back({first, &result.runs[i], true});
  }
  return pairs;
}

double gyro_noise_drift_of(const EnsembleStudy& study, const EnsembleRun& run, double duration_s) {
  const auto which = std::ranges::find_if(study.plan.cases, [&](const auto& c) { return c.truth.name == run.truth; });
  geo::Psd density;
  for (int axis = 0; axis < 3; ++axis)
    density.value = std::max(density.value, which->truth.model.white_density(noise::Sensor::kGyro, axis).value);
  return study::gyro_noise_drift(density, duration_s);
}

void add_ensemble(const EnsembleStudy& study, const study::EnsembleResult& result, report::Page& page) {
  const std::size_t filters = study.filters.size();
  for (std::size_t outage = 0; outage < result.outages.size(); ++outage)
    for (std::size_t truth = 0; truth < study.truths; ++truth) {
      View view{
          study, result, outage, study.plan.cases[truth].truth.name, fmt::format("outage-{}-truth-{}", outage + 1, truth + 1),
          {},    {}};
      for (std::size_t i = 0; i < filters; ++i) view.runs.push_back(&result.runs[truth * filters + i]);
      for (std::size_t i = study.truths * filters; i < result.runs.size(); ++i) view.floors.push_back(&result.runs[i]);
      add_tiles(view, page);
      page.sections.push_back(section_of(view));
    }
}

}  // namespace coast::cli
