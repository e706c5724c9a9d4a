#include "common/page_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "coast/study/paired.hpp"

namespace coast::jobs {

std::string number(double value, int significant) {
  if (!std::isfinite(value)) return "not determined";
  if (value == 0.0) return "0";
  const int power = static_cast<int>(std::floor(std::log10(std::abs(value))));
  if (power < -7) return fmt::format("{:.{}g}", value, significant);
  return fmt::format("{:.{}f}", value, std::max(significant - 1 - power, 0));
}

std::string triple(const Eigen::Vector3d& values, int significant) {
  return fmt::format("{} / {} / {}", number(values.x(), significant), number(values.y(), significant),
                     number(values.z(), significant));
}

std::string decimals(double value, int count) {
  const std::string text = fmt::format("{:.{}f}", value, count);
  return text.front() == '-' && text.find_first_of("123456789") == std::string::npos ? text.substr(1) : text;
}

std::string percent(double share) {
  return fmt::format("{:.1f}", 100.0 * share);
}

std::string joined(const std::vector<std::string>& words, std::string_view between) {
  std::string text;
  for (const std::string& word : words) {
    if (!text.empty()) text += between;
    text += word;
  }
  return text;
}

std::vector<report::Cell> cells(std::initializer_list<std::string> texts) {
  std::vector<report::Cell> row;
  for (const std::string& text : texts) row.push_back({text});
  return row;
}

report::Table event_table(const record::Events& events) {
  report::Table table;
  table.id = "events";
  table.title = "Events";
  table.caption = "Everything that was repaired, bridged, refused or doubted; nothing is repaired in silence.";
  table.columns = {{"", "", false}, {"kind", "", false}, {"what", "", false}, {"first at", "s of week"}, {"count", ""}};
  for (const record::Event& event : events) {
    const bool warning = event.severity == record::Event::Severity::kWarning;
    auto row = cells({warning ? "warning" : "note", event.kind, event.text,
                      event.time ? fmt::format("{:.3f}", event.time->sow()) : "", fmt::format("{}", event.count)});
    if (warning) row[0].verdict = report::Verdict::kWarn;
    table.rows.push_back(std::move(row));
  }
  return table;
}

report::Verdict verdict_of_share(double inside_95, std::size_t outages) {
  constexpr double kPromised = 0.95;
  if (outages == 0) return report::Verdict::kNone;
  const double sd = std::sqrt(kPromised * (1.0 - kPromised) / (3.0 * static_cast<double>(outages)));
  if (inside_95 >= kPromised - 3.0 * sd) return report::Verdict::kGood;
  return inside_95 >= kPromised - 6.0 * sd ? report::Verdict::kWarn : report::Verdict::kBad;
}

report::Series curve(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& sd, double factor,
                     std::size_t most_points) {
  report::Decimator decimator({most_points});
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (sd.empty())
      decimator.add(x[i], y[i]);
    else
      decimator.add(x[i], y[i], y[i] - factor * sd[i], y[i] + factor * sd[i]);
  }
  return decimator.finish();
}

namespace {

/// Drawn values of y from `from` on.
std::vector<double> drawn_values(const report::Plot& plot, double from) {
  std::vector<double> values;
  const auto take = [&](const std::vector<double>& x, const std::vector<double>& y) {
    for (std::size_t i = 0; i < y.size(); ++i)
      if (x[i] >= from && std::isfinite(y[i])) values.push_back(y[i]);
  };
  for (const report::Line& line : plot.lines) {
    if (line.hidden) continue;
    take(line.series.x, line.series.y);
    if (!line.series.band) continue;
    take(line.series.band->x, line.series.band->lower);
    take(line.series.band->x, line.series.band->upper);
  }
  for (const report::Points& points : plot.points) take(points.series.x, points.series.y);
  return values;
}

}  // namespace

void show_bulk(report::Panel& panel, const Bulk& bulk) {
  constexpr std::size_t kFewest = 20;  // fewer values have no useful quantiles
  constexpr double kFlattened = 1.5;
  bool clipped = false;
  for (report::Plot& plot : panel.plots) {
    const std::vector<double> values = drawn_values(plot, bulk.from_s);
    if (values.size() < kFewest) continue;
    const double low = study::quantile(values, bulk.tail);
    const double high = study::quantile(values, 1.0 - bulk.tail);
    const double height = (1.0 + 2.0 * bulk.air) * (high - low);
    const auto [least, greatest] = std::ranges::minmax(drawn_values(plot, -std::numeric_limits<double>::infinity()));
    if (!(high > low) || greatest - least < kFlattened * height) continue;
    plot.y.range = {low - bulk.air * (high - low), high + bulk.air * (high - low)};
    clipped = true;
  }
  if (clipped) panel.caption += " The first view leaves out peaks; Shift and the wheel show them.";
}

}  // namespace coast::jobs
