// Panels of aiding sensors in the section of innovations.

#include "process/page/parts.hpp"

namespace coast::jobs {

namespace {

/// Innovations over their sigmas, one plot for each aid: units differ from aid to aid and within one.
report::Panel aid_panel(const ProcessPage& page) {
  constexpr std::size_t kMostDots = 8000;
  constexpr double kBound = 3.0;
  std::vector<std::string> names;
  for (const AidUse& aid : page.result.aids) names.push_back(aid.name);
  report::Panel panel =
      report::stacked_time_panel("innovations-aids", "Innovations of aiding sensors over their sigmas", names, "",
                                 "Measured minus predicted; 99.7 % within 3, no trend and no waves, is good.");
  for (std::size_t a = 0; a < page.result.aids.size(); ++a) {
    report::Decimator used({kMostDots}), refused({kMostDots});
    for (const estimate::InnovationRecord& r : page.result.innovations) {
      if (r.kind != estimate::UpdateKind::kAid || r.aid != a) continue;
      for (Eigen::Index i = 0; i < r.dof; ++i) (r.used ? used : refused).add(seconds_since_start(page, r.t), r.nu(i) / r.sd(i));
    }
    report::Plot& plot = panel.plots[a];
    plot.bounds.push_back({kBound, "3 sigma", report::Tone::kMuted});
    plot.bounds.push_back({-kBound, "", report::Tone::kMuted});
    report::add_points(plot, "used", used.finish(), report::Tone::kSmoothed);
    if (page.result.aids[a].refused > 0)
      report::add_points(plot, "refused", refused.finish(), report::Tone::kBad).radius_px = 2.4;
  }
  report::shade(panel, outage_intervals(page));
  show_bulk(panel, kErrors);
  return panel;
}

report::Table aid_table(const ProcessPage& page) {
  report::Table table;
  table.id = "aids";
  table.title = "Aiding sensors";
  table.caption = "NIS near its expected value: the stated standard deviation is that of the recording; far above: too small.";
  table.columns = {{"sensor", "", false}, {"used", ""}, {"refused", ""}, {"NIS", ""}, {"expected", ""}};
  for (const AidUse& aid : page.result.aids)
    table.rows.push_back(cells(
        {aid.name, std::to_string(aid.used), std::to_string(aid.refused), number(aid.nis.mean), number(aid.nis.expected)}));
  return table;
}

}  // namespace

void add_aids(const ProcessPage& page, report::Section& section) {
  if (page.result.aids.empty()) return;
  section.tables.push_back(aid_table(page));
  section.panels.push_back(aid_panel(page));
}

}  // namespace coast::jobs
