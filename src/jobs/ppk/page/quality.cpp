// Section: quality of each epoch, and its cause.

#include <fmt/format.h>

#include <cmath>

#include "coast/geo/earth.hpp"
#include "coast/report/panels.hpp"
#include "common/page_parts.hpp"
#include "ppk/page/page.hpp"

namespace coast::jobs {

namespace {

using carrier::PpkEpoch;
using record::FixQuality;

report::Table causes(const PpkSummary& s) {
  report::Table table;
  table.id = "causes";
  table.title = "Why epochs are not fixed";
  table.columns = {{"cause", "", false}, {"epochs", ""}, {"share", "%"}};
  for (const auto& [cause, epochs] : s.causes())
    table.rows.push_back(
        cells({cause, fmt::format("{}", epochs), percent(static_cast<double>(epochs) / static_cast<double>(s.expected))}));
  return table;
}

/// One value per epoch if available, coloured by quality.
report::Panel by_quality(const PpkResult& result, std::string id, std::string title, std::string unit, std::string caption,
                         const std::function<std::optional<double>(const PpkEpoch&)>& value) {
  report::Panel panel = report::time_panel(std::move(id), std::move(title), std::move(unit), std::move(caption));
  for (const FixQuality quality : {FixQuality::kSingle, FixQuality::kFloat, FixQuality::kFixed}) {
    report::Decimator points;
    bool any = false;
    for (const PpkEpoch& epoch : result.solution.epochs) {
      if (epoch.quality != quality) continue;
      const std::optional<double> v = value(epoch);
      if (!v) continue;
      points.add(seconds(result, epoch), *v);
      any = true;
    }
    if (any) report::add_points(panel.plot(), report::name_of(quality), points.finish(), report::tone_of(quality));
  }
  return panel;
}

report::Panel sigma(const PpkResult& result) {
  report::Panel panel =
      by_quality(result, "quality-sigma", "Sigma of the position", "m", "In space: the root of the sum of the three variances.",
                 [](const PpkEpoch& e) { return std::optional(std::sqrt(e.covariance_e.trace())); });
  panel.plot().y.scale = report::Axis::Scale::kLog;
  return panel;
}

report::Panel ratio(const PpkResult& result) {
  report::Panel panel =
      by_quality(result, "ratio", "Ratio of the second-best integers to the best", "",
                 "Above the bound the best integers stand out. With many ambiguities a right answer may have a ratio near it.",
                 [](const PpkEpoch& e) { return e.ratio > 0.0 ? std::optional(std::min(e.ratio, 1e4)) : std::nullopt; });
  panel.plot().y.scale = report::Axis::Scale::kLog;
  return panel;
}

}  // namespace

report::Section ppk_quality_section(const PpkResult& result) {
  report::Section section;
  section.id = "quality";
  section.title = "Quality";
  report::Table table = causes(summary_of(result));
  if (table.rows.empty())
    section.lead = "Every epoch has integer ambiguities.";
  else
    section.tables.push_back(std::move(table));
  section.panels = {
      sigma(result), ratio(result),
      by_quality(result, "satellites", "Satellites", "", "Of the double differences, or of the single point.",
                 [](const PpkEpoch& e) { return std::optional(static_cast<double>(e.satellites)); }),
      by_quality(result, "pdop", "PDOP", "", "Sigma of the position over that of a range; below 2 is good, above 6 poor.",
                 [](const PpkEpoch& e) { return e.pdop > 0.0 ? std::optional(e.pdop) : std::nullopt; }),
      by_quality(result, "age", "Time to the nearest epoch of the base", "s",
                 "Zero where both recorded at the same time; else the base is interpolated.",
                 [](const PpkEpoch& e) { return std::optional(e.age_s); })};
  return section;
}

}  // namespace coast::jobs
