#include "campaign/page/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "coast/report/panels.hpp"
#include "common/page_parts.hpp"

namespace coast::jobs {

namespace {

using report::Axis;
using report::Verdict;

constexpr std::size_t kDrawn = 12;  // groups in a figure: more curves cannot be told apart

std::string of(const std::optional<study::Spread>& spread, double study::Spread::*what) {
  return spread ? number((*spread).*what) : "";
}

report::Table group_table(const std::vector<GroupSummary>& groups) {
  report::Table table;
  table.id = "groups-table";
  table.title = "Groups";
  table.caption =
      "A group is one entry of the plan with one error model, one set of outages and one of effects. NIS over its expected "
      "value: median over the missions. Errors: root mean square of a mission against its reference, median and 95 % of the "
      "missions.";
  table.columns = {{"group", "", false},
                   {"units", ""},
                   {"failed", ""},
                   {"missing", ""},
                   {"good", ""},
                   {"doubtful", ""},
                   {"unusable", ""},
                   {"NIS : expected", ""},
                   {"forward horizontal", "m"},
                   {"95 %", "m"},
                   {"smoothed horizontal", "m"},
                   {"95 %", "m"},
                   {"smoothed down", "m"}};
  for (const GroupSummary& group : groups) {
    const auto& [forward, smoothed] = group.horizontal_rms;
    auto row =
        cells({group.name, fmt::format("{}", group.units), fmt::format("{}", group.failed), fmt::format("{}", group.missing),
               fmt::format("{}", group.good), fmt::format("{}", group.doubtful), fmt::format("{}", group.unusable),
               of(group.nis_ratio, &study::Spread::median), of(forward, &study::Spread::median),
               of(forward, &study::Spread::p95), of(smoothed, &study::Spread::median), of(smoothed, &study::Spread::p95),
               of(group.down_rms[1], &study::Spread::median)});
    if (group.failed > 0) row[2].verdict = Verdict::kBad;
    if (group.missing > 0) row[3].verdict = Verdict::kWarn;
    if (group.doubtful > 0) row[5].verdict = Verdict::kWarn;
    if (group.unusable > 0) row[6].verdict = Verdict::kBad;
    table.rows.push_back(std::move(row));
  }
  return table;
}

report::Table failure_table(const std::vector<CampaignFailure>& failures) {
  report::Table table;
  table.id = "failures-table";
  table.title = "Failed";
  table.caption = "What each unit that has no result said. Those beyond a thousand stand in missions.csv.";
  table.columns = {
      {"mission", "", false}, {"error model", "", false}, {"outages", "", false}, {"effects", "", false}, {"error", "", false}};
  for (const CampaignFailure& f : failures)
    table.rows.push_back(cells({f.mission, f.error_model, f.outages, f.effects, f.error}));
  return table;
}

report::Table duration_table(const std::vector<GroupSummary>& groups) {
  report::Table table;
  table.id = "durations-table";
  table.title = "By duration";
  table.caption =
      "Largest horizontal error over the outages of a duration, forward and smoothed; gain: rms of forward over that of "
      "smoothed; inside: share of all errors within their stated 95 %.";
  table.columns = {{"group", "", false},   {"duration", "s"},     {"outages", ""},          {"forward median", "m"},
                   {"forward rms", "m"},   {"forward 95 %", "m"}, {"smoothed median", "m"}, {"smoothed rms", "m"},
                   {"smoothed 95 %", "m"}, {"gain", ""},          {"forward inside", "%"},  {"smoothed inside", "%"}};
  for (const GroupSummary& group : groups)
    for (const GroupSummary::Duration& d : group.durations) {
      if (!d.forward) continue;
      const study::Spread& forward = d.forward->horizontal;
      auto row = cells({group.name, fmt::format("{:g}", d.seconds), fmt::format("{}", d.outages), number(forward.median),
                        number(forward.rms), number(forward.p95), "", "", "", "", percent(d.forward->inside_95), ""});
      row[10].verdict = verdict_of_share(d.forward->inside_95, d.outages);
      if (d.smoothed) {
        const study::Spread& smoothed = d.smoothed->horizontal;
        row[6].text = number(smoothed.median);
        row[7].text = number(smoothed.rms);
        row[8].text = number(smoothed.p95);
        row[9].text = number(forward.rms / smoothed.rms);
        row[11].text = percent(d.smoothed->inside_95);
        row[11].verdict = verdict_of_share(d.smoothed->inside_95, d.outages);
      }
      table.rows.push_back(std::move(row));
    }
  return table;
}

/// Median and 95 % of the largest horizontal error over durations, a curve for each group.
report::Panel drift_panel(const std::vector<GroupSummary>& groups) {
  report::Panel panel = report::grid_panel("drift", "Drift against duration", 2,
                                           "Largest horizontal error of an outage: median in full, 95 % dashed. Noise of "
                                           "accelerometers grows with the power 1.5, of gyros with 2.5.");
  for (const bool smoothed : {false, true}) {
    report::Plot& plot = report::add_cell(panel, smoothed ? "smoothed" : "forward", "", "", "m");
    plot.x = {"duration of the outage", "s", Axis::Scale::kLog, {}, {}};
    plot.y = {"largest horizontal error", "m", Axis::Scale::kLog, {}, {}};
    plot.link.clear();
    plot.height_px = 340;
    for (std::size_t g = 0; g < std::min(kDrawn, groups.size()); ++g) {
      report::Series median, p95;
      for (const GroupSummary::Duration& d : groups[g].durations) {
        const std::optional<study::Drift>& drift = smoothed ? d.smoothed : d.forward;
        if (!drift) continue;
        median.x.push_back(d.seconds);
        median.y.push_back(drift->horizontal.median);
        p95.x.push_back(d.seconds);
        p95.y.push_back(drift->horizontal.p95);
      }
      if (median.x.empty()) continue;
      if (median.x.size() == 1) {
        report::add_points(plot, groups[g].name + ", median", std::move(median)).radius_px = 3.0;
        continue;
      }
      report::add_line(plot, groups[g].name + ", median", std::move(median)).width_px = 2.0;
      report::add_line(plot, groups[g].name + ", 95 %", std::move(p95)).style = report::Line::Style::kDashed;
    }
  }
  return panel;
}

/// Errors against the reference, group by group: from the median to the largest.
report::Panel reference_panel(const std::vector<GroupSummary>& groups) {
  report::Panel panel = report::xy_panel(
      "reference", "Errors against the references", {"horizontal rms of a mission", "m", Axis::Scale::kLog, {}, {}},
      {"group", "", Axis::Scale::kLinear, {}, {}}, "Dots: median, 68 %, 95 % and the largest of the missions.");
  report::Plot& plot = panel.plot();
  const std::size_t drawn = std::min(kDrawn, groups.size());
  plot.height_px = 120 + 40 * static_cast<int>(drawn);
  for (const std::size_t solution : {0U, 1U}) {
    report::Series dots;
    for (std::size_t g = 0; g < drawn; ++g) {
      const double row = -static_cast<double>(g) - 0.25 * static_cast<double>(solution);
      if (solution == 0) plot.y.ticks.push_back({row, groups[g].name});
      if (const std::optional<study::Spread>& spread = groups[g].horizontal_rms[solution])
        for (const double value : {spread->median, spread->p68, spread->p95, spread->max}) {
          dots.x.push_back(value);
          dots.y.push_back(row);
        }
    }
    if (!dots.x.empty())
      report::add_points(plot, solution == 0 ? "forward" : "smoothed", std::move(dots),
                         solution == 0 ? report::Tone::kForward : report::Tone::kSmoothed)
          .radius_px = 3.0;
  }
  return panel;
}

report::Tile tile(const char* label, std::size_t count, Verdict verdict, const char* explanation, const char* section) {
  return {label, fmt::format("{}", count), "", verdict, explanation, {}, section};
}

void add_tiles(const CampaignCollection& all, report::Page& page) {
  page.tiles.push_back(tile("units", all.units, Verdict::kNone, "Missions times error models, outages and effects.", "groups"));
  page.tiles.push_back(
      tile("done", all.done, all.done == all.units ? Verdict::kGood : Verdict::kNone, "With a result.", "groups"));
  page.tiles.push_back(tile("failed", all.failed, all.failed > 0 ? Verdict::kBad : Verdict::kGood,
                            "Their input is wrong, or the numbers failed.", all.failed > 0 ? "failures" : ""));
  page.tiles.push_back(tile("missing", all.missing, all.missing > 0 ? Verdict::kWarn : Verdict::kGood,
                            "Not computed yet: coast campaign run does what is left.", "groups"));
}

}  // namespace

GroupSummary summary_of(const GroupStatistics& group) {
  GroupSummary summary;
  summary.name = group.mission;
  for (const std::string& factor : {group.error_model, group.outages, group.effects})
    if (!factor.empty()) summary.name += ", " + factor;
  summary.units = group.units;
  summary.done = group.done;
  summary.failed = group.failed;
  summary.missing = group.missing;
  const auto verdicts = [&group](const char* name) {
    const auto found = group.verdicts.find(name);
    return found == group.verdicts.end() ? 0 : found->second;
  };
  summary.good = verdicts("good");
  summary.doubtful = verdicts("doubtful");
  summary.unusable = verdicts("unusable");
  const auto spread = [](const std::vector<double>& values) {
    return values.empty() ? std::optional<study::Spread>() : study::spread_of(values);
  };
  summary.nis_ratio = spread(group.nis_ratio);
  for (const std::size_t solution : {0U, 1U}) {
    summary.horizontal_rms[solution] = spread(group.horizontal_rms[solution]);
    summary.down_rms[solution] = spread(group.down_rms[solution]);
  }
  for (const auto& [seconds, sums] : group.durations) {
    GroupSummary::Duration duration{seconds, sums.forward.outages(), {}, {}};
    if (sums.forward.outages() > 0) duration.forward = sums.forward.drift();
    if (sums.smoothed.outages() > 0) duration.smoothed = sums.smoothed.drift();
    summary.durations.push_back(std::move(duration));
  }
  return summary;
}

report::Page campaign_page(const CampaignConfig& config, const CampaignCollection& all, const std::vector<GroupSummary>& groups,
                           const std::vector<CampaignFailure>& failures) {
  report::Page page;
  page.title = "Campaign";
  page.subtitle = config.file.filename().string();
  page.footer = fmt::format("coast {}, coast campaign, job {}", COAST_VERSION, name(config.job));
  add_tiles(all, page);
  report::Section section;
  section.id = "groups";
  section.title = "Missions";
  section.lead = "Every unit is a line of missions.csv, every outage one of outages.csv, every estimate one of estimates.csv.";
  section.tables.push_back(group_table(groups));
  const auto has_reference = [](const GroupSummary& g) { return g.horizontal_rms[0] || g.horizontal_rms[1]; };
  if (std::ranges::any_of(groups, has_reference)) section.panels.push_back(reference_panel(groups));
  page.sections.push_back(std::move(section));
  if (std::ranges::any_of(groups, [](const GroupSummary& g) { return !g.durations.empty(); })) {
    report::Section outages;
    outages.id = "outages";
    outages.title = "Outages";
    outages.tables.push_back(duration_table(groups));
    outages.panels.push_back(drift_panel(groups));
    page.sections.push_back(std::move(outages));
  }
  if (!failures.empty()) {
    report::Section failed;
    failed.id = "failures";
    failed.title = "Failed";
    failed.tables.push_back(failure_table(failures));
    page.sections.push_back(std::move(failed));
  }
  return page;
}

}  // namespace coast::jobs
