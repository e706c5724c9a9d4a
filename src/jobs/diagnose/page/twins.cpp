// The recording compared with its twins: every figure in units of their spread, before and after.

#include <fmt/format.h>

#include "common/page_parts.hpp"
#include "diagnose/result.hpp"

namespace coast::jobs {

namespace {

using diagnose::TwinStatistic;

/// Distance from the twins' median, in halves of the distance between their 5 % and 95 % quantiles.
double away(const TwinStatistic& t) {
  const double half = 0.5 * (t.q95 - t.q05);
  return half > 0.0 ? (t.real - t.q50) / half : 0.0;
}

void add_recording(const std::vector<TwinStatistic>& twins, const char* label, report::Tone tone, report::Plot& plot) {
  std::vector<double> x, y;
  for (std::size_t i = 0; i < twins.size(); ++i) {
    x.push_back(away(twins[i]));
    y.push_back(-static_cast<double>(i));
  }
  if (!x.empty()) plot.points.push_back({.label = label, .series = curve(x, y), .tone = tone, .radius_px = 4.0});
}

bool is_of_a_part(const TwinStatistic& t) {
  return t.stretch.has_value();
}

std::vector<TwinStatistic> of_the_whole(std::vector<TwinStatistic> twins) {
  std::erase_if(twins, is_of_a_part);
  return twins;
}

/// By parts of the mission.
report::Panel epoch_panel(const diagnose::Diagnosis& d) {
  report::Panel panel =
      report::time_panel("twin-epochs", "When: NIS by tenths of the mission", "",
                         "Squared innovations over their variance. Inside the band the model tells what the recording shows.");
  std::vector<double> x, middle, half;
  const auto line_of = [&](const std::vector<TwinStatistic>& twins) {
    std::vector<double> y;
    x.clear();
    for (const TwinStatistic& t : twins) {
      if (!is_of_a_part(t)) continue;
      for (const double at : {t.stretch->from_s, t.stretch->to_s}) {
        x.push_back(at);
        y.push_back(t.real);
      }
    }
    return y;
  };
  for (const TwinStatistic& t : d.twins)
    if (is_of_a_part(t))
      for (int end = 0; end < 2; ++end) {
        middle.push_back(0.5 * (t.q05 + t.q95));
        half.push_back(0.5 * (t.q95 - t.q05));
      }
  const std::vector<double> before = line_of(d.twins);
  report::Line& twins = report::add_line(panel.plot(), "twins", curve(x, middle, half), report::Tone::kMuted);
  twins.band_label = "5 to 95 %";
  report::add_line(panel.plot(), d.twins_after.empty() ? "recording" : "recording, configured model", curve(x, before),
                   report::Tone::kWarn);
  const std::vector<double> after = line_of(d.twins_after);
  if (!after.empty()) report::add_line(panel.plot(), "with what was found", curve(x, after), report::Tone::kGood);
  return panel;
}

report::Panel twin_panel(const std::vector<TwinStatistic>& before, const std::vector<TwinStatistic>& after) {
  report::Panel panel;
  panel.id = "twin-figures";
  panel.title = "Where: figures of the recording, from their twins' median";
  panel.caption =
      "In halves of the distance between the twins' 5 % and 95 %. Inside the boxes' whiskers the model tells what the "
      "recording shows.";
  panel.plots.resize(1);
  report::Plot& plot = panel.plot();
  plot.x.label = "distance";
  plot.x.unit = "spreads";
  constexpr double kQuartile = 0.41;  // relative to the 5 and 95 % points, for a normal distribution
  report::Boxes boxes{.label = "twins", .boxes = {}, .tone = report::Tone::kMuted};
  for (std::size_t i = 0; i < before.size(); ++i) {
    const double row = -static_cast<double>(i);
    plot.y.ticks.push_back({row, before[i].name});
    boxes.boxes.push_back({row, -1.0, -kQuartile, 0.0, kQuartile, 1.0});
  }
  plot.boxes.push_back(std::move(boxes));
  add_recording(before, after.empty() ? "recording" : "recording, configured model", report::Tone::kWarn, plot);
  add_recording(after, "with what was found", report::Tone::kGood, plot);
  plot.height_px = 90 + 24 * static_cast<int>(before.size());
  return panel;
}

report::Table twin_table(const char* id, const char* title, const std::vector<TwinStatistic>& twins) {
  report::Table table;
  table.id = id;
  table.title = title;
  table.columns = {{"figure", "", false}, {"recording", ""}, {"twins, 5 %", ""}, {"median", ""}, {"95 %", ""}, {"p", ""}};
  for (const TwinStatistic& t : twins)
    table.rows.push_back(cells({t.name, number(t.real), number(t.q05), number(t.q50), number(t.q95), number(t.p_adjusted, 2)}));
  return table;
}

}  // namespace

report::Section twin_section(const diagnose::Diagnosis& d, const std::optional<SimulationCheck>& simulation) {
  report::Section section;
  section.id = "twins";
  section.title = "The recording among its twins";
  section.lead =
      simulation
          ? fmt::format(
                "Figures of the recording beside those of {}. p: that any figure of a simulated recording lies as far out.",
                simulation->source)
          : std::string(
                "Recordings of the same motion, simulated as the model says and run through the same steps. p: that "
                "any figure of a twin lies as far out by chance.");
  if (simulation && !simulation->of_another_drive.empty())
    section.notes.push_back({report::Note::Kind::kWarning, "Another drive", simulation->of_another_drive});
  section.panels.push_back(epoch_panel(d));
  section.panels.push_back(twin_panel(of_the_whole(d.twins), of_the_whole(d.twins_after)));
  section.tables.push_back(twin_table("twins-before", "Of the configured model", d.twins));
  if (!d.twins_after.empty())
    section.tables.push_back(twin_table("twins-after", "Of the model with what was found", d.twins_after));
  return section;
}

}  // namespace coast::jobs
