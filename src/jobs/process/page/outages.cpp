// Section: drift of the trajectory while GNSS is withheld.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coast/geo/units.hpp"
#include "process/page/curves.hpp"
#include "process/page/parts.hpp"

namespace coast::jobs {

namespace {

using study::OutageErrors;
using study::OutageResult;

constexpr std::size_t kMostPanels = 12;
constexpr double kBandSigmas = 2.0;

struct Listed {
  std::size_t number;  ///< in the tables, from 1
  const OutageResult* outage;
};

std::vector<Listed> all_outages(const ProcessPage& page) {
  std::vector<Listed> all;
  for (const auto* list : {&page.result.outages, &page.result.sweep})
    for (const OutageResult& outage : *list) all.push_back({all.size() + 1, &outage});
  return all;
}

const OutageErrors& best(const OutageResult& outage) {
  return outage.smoothed ? *outage.smoothed : outage.forward;
}

/// Those with a panel: all withheld from the delivered trajectory, then the worst of each swept duration.
std::vector<Listed> shown(const ProcessPage& page, std::vector<Listed> all) {
  const std::size_t delivered_count = page.result.outages.size();
  if (all.size() <= kMostPanels) return all;
  std::vector<Listed> swept(all.begin() + static_cast<std::ptrdiff_t>(delivered_count), all.end());
  all.resize(std::min(delivered_count, kMostPanels));
  std::vector<double> durations;
  for (const Listed& l : swept)
    if (std::ranges::find(durations, l.outage->outage.duration_s) == durations.end())
      durations.push_back(l.outage->outage.duration_s);
  if (durations.empty() || all.size() == kMostPanels) return all;
  const std::size_t each = std::max<std::size_t>(1, (kMostPanels - all.size()) / durations.size());
  std::ranges::stable_sort(swept, [](const Listed& a, const Listed& b) {
    return best(*a.outage).horizontal_max_m > best(*b.outage).horizontal_max_m;
  });
  for (const double duration : durations) {
    std::size_t taken = 0;
    for (const Listed& l : swept) {
      if (l.outage->outage.duration_s != duration || taken == each || all.size() == kMostPanels) continue;
      all.push_back(l);
      ++taken;
    }
  }
  return all;
}

/// Distance travelled between two times by the delivered trajectory, m.
double travelled(const report::Series& distance, double from, double to) {
  const auto at = [&](double t) {
    const auto after = std::ranges::lower_bound(distance.x, t);
    if (after == distance.x.begin()) return distance.y.front();
    if (after == distance.x.end()) return distance.y.back();
    const auto i = static_cast<std::size_t>(after - distance.x.begin());
    const double step = distance.x[i] - distance.x[i - 1];
    const double weight = step > 0.0 ? (t - distance.x[i - 1]) / step : 1.0;
    return distance.y[i - 1] + weight * (distance.y[i] - distance.y[i - 1]);
  };
  return distance.x.empty() ? 0.0 : at(to) - at(from);
}

std::string share_inside(const OutageErrors& e) {
  return e.tested > 0 ? percent(static_cast<double>(e.inside_95) / static_cast<double>(e.tested)) : "";
}

report::Verdict verdict_of(const OutageErrors& e) {
  if (e.tested == 0) return report::Verdict::kNone;
  return verdict_of_share(static_cast<double>(e.inside_95) / static_cast<double>(e.tested), 1);
}

report::Table overview(const ProcessPage& page, const std::vector<Listed>& all) {
  constexpr double kLeastDistance = 5.0;  // m: a percentage of less is meaningless
  const report::Series distance = page.result.curves->curves().distance.finish();
  const bool gnss =
      std::ranges::any_of(all, [](const Listed& l) { return l.outage->forward.gnss_horizontal_max_m.has_value(); });
  report::Table table;
  table.id = "outage-table";
  table.title = "Outages";
  table.caption = fmt::format(
      "Largest horizontal error against {}{}, and as a share of the distance travelled. Inside: share of the errors, axis by "
      "axis, "
      "within their predicted 95 %; one outage has few independent errors, so only a gross miss is marked.",
      page.result.compared_with == "reference" ? "the reference" : "the run without gaps",
      gnss ? ", against the withheld fixes (GNSS)" : "");
  table.columns = {{"outage", ""},
                   {"start", "s of week"},
                   {"duration", "s"},
                   {"distance", "m"},
                   {"forward", "m"},
                   {"smoothed", "m"},
                   {"forward", "% of distance"},
                   {"smoothed", "% of distance"},
                   {"forward inside", "%"},
                   {"smoothed inside", "%"}};
  if (gnss) table.columns.insert(table.columns.end(), {{"forward, GNSS", "m"}, {"smoothed, GNSS", "m"}});
  for (const auto& [index, o] : all) {
    const double from = seconds_since_start(page, o->outage.start);
    const double distance_m = travelled(distance, from, from + o->outage.duration_s);
    const OutageErrors* s = o->smoothed ? &*o->smoothed : nullptr;
    const auto of_distance = [&](const OutageErrors* e) {
      return e != nullptr && distance_m >= kLeastDistance ? number(100.0 * e->horizontal_max_m / distance_m, 2) : "";
    };
    auto row = cells({fmt::format("{}", index), fmt::format("{:.1f}", o->outage.start.sow()),
                      fmt::format("{:g}", o->outage.duration_s), fmt::format("{:.0f}", distance_m),
                      number(o->forward.horizontal_max_m), s ? number(s->horizontal_max_m) : "", of_distance(&o->forward),
                      of_distance(s), share_inside(o->forward), s ? share_inside(*s) : ""});
    row[8].verdict = verdict_of(o->forward);
    if (s) row[9].verdict = verdict_of(*s);
    if (gnss) {
      const auto against = [](const OutageErrors* e) {
        return report::Cell{e != nullptr && e->gnss_horizontal_max_m ? number(*e->gnss_horizontal_max_m) : ""};
      };
      row.push_back(against(&o->forward));
      row.push_back(against(s));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// Errors by component of one solution.
report::Table by_component(const std::vector<Listed>& all, bool smoothed) {
  report::Table table;
  table.id = smoothed ? "outage-components-smoothed" : "outage-components-forward";
  table.title = smoothed ? "Smoothed, by component" : "Forward, by component";
  table.caption = smoothed
                      ? "N, E, D: largest absolute error, root mean square, largest predicted sigma; metres."
                      : "N, E, D: largest absolute error, root mean square, error at the end, predicted sigma there; metres.";
  table.columns = {{"outage", ""}, {"duration", "s"}};
  std::vector<const char*> groups{"max", "rms"};
  if (!smoothed) groups.push_back("end");
  groups.push_back("sigma");
  for (const char* group : groups)
    for (const std::string& axis : kNed) table.columns.push_back({fmt::format("{} {}", group, axis), ""});
  for (const auto& [index, o] : all) {
    if (smoothed && !o->smoothed) continue;
    const OutageErrors& e = smoothed ? *o->smoothed : o->forward;
    auto row = cells({fmt::format("{}", index), fmt::format("{:g}", o->outage.duration_s)});
    const auto add = [&](const Eigen::Vector3d& v) {
      for (Eigen::Index i = 0; i < 3; ++i) row.push_back({number(v(i))});
    };
    add(e.max_m);
    add(e.rms_m);
    if (!smoothed) add(e.end_m);
    add(smoothed ? e.sigma_max_m : e.sigma_end_m);
    table.rows.push_back(std::move(row));
  }
  return table;
}

report::Series errors_of(const OutageResult& outage, const OutageErrors& errors, Eigen::Index axis, bool band) {
  std::vector<double> t;
  std::vector<double> value;
  std::vector<double> sd;
  for (const study::ErrorSample& s : errors.series) {
    t.push_back(s.t - outage.outage.start);
    value.push_back(s.position_n(axis));
    if (band) sd.push_back(s.sd_position(axis));
  }
  return curve(t, value, sd, kBandSigmas, 2000);
}

/// N, E, D in rows: forward on the left, smoothed separately on the right, with its own scale.
report::Panel outage_panel(const Listed& listed) {
  const OutageResult& o = *listed.outage;
  report::Panel panel = report::grid_panel(
      fmt::format("outage-{}", listed.number),
      fmt::format("Outage {}: {:g} s from {:.1f} s of week", listed.number, o.outage.duration_s, o.outage.start.sow()),
      o.smoothed ? 2 : 1,
      o.smoothed
          ? "Forward (left) drifts and comes back at the first fix; smoothed (right, scale of its own) is zero at both ends. "
            "Both inside their bands."
          : "Forward drifts and comes back at the first fix, inside its band.");
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const std::string& name = kNed[static_cast<std::size_t>(axis)];
    const auto finish = [&](report::Plot& plot) {
      plot.intervals.push_back({0.0, o.outage.duration_s, {}, report::Tone::kMuted});
      plot.height_px = 150;
    };
    report::Plot& forward = report::add_cell(panel, axis == 0 ? "forward" : "", "time in outage", name, "m");
    report::add_line(forward, "forward", errors_of(o, o.forward, axis, true), report::Tone::kForward).band_label = "2 sigma";
    if (o.smoothed) report::add_line(forward, "smoothed", errors_of(o, *o.smoothed, axis, false), report::Tone::kSmoothed);
    finish(forward);
    if (!o.smoothed) continue;
    report::Plot& smoothed = report::add_cell(panel, axis == 0 ? "smoothed" : "", "time in outage", name, "m");
    report::add_line(smoothed, "smoothed", errors_of(o, *o.smoothed, axis, true), report::Tone::kSmoothed).band_label =
        "2 sigma";
    finish(smoothed);
  }
  return panel;
}

}  // namespace

std::optional<report::Section> outage_section(const ProcessPage& page) {
  const std::vector<Listed> all = all_outages(page);
  if (all.empty()) return std::nullopt;
  report::Section section;
  section.id = "outages";
  section.title = "Outages";
  section.lead =
      fmt::format("GNSS was withheld here. Errors are taken against {}, between the last fix used and the next one.",
                  page.result.compared_with == "reference" ? "the reference"
                                                           : "the trajectory without the gap, whose own errors they contain");
  if (page.result.compared_with != "reference")
    section.lead += " Where the noise of that trajectory is comparable with the drift, the drift looks smaller than it is.";
  add_sweep(page, section);
  section.tables.push_back(overview(page, all));
  section.tables.push_back(by_component(all, false));
  if (page.config.smooth) section.tables.push_back(by_component(all, true));
  const std::vector<Listed> panels = shown(page, all);
  if (panels.size() < all.size())
    section.lead += fmt::format(" Of {} outages the {} worst are drawn.", all.size(), panels.size());
  for (const Listed& listed : panels)
    if (listed.outage->forward.series.size() > 1) section.panels.push_back(outage_panel(listed));
  return section;
}

}  // namespace coast::jobs
