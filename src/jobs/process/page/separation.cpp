#include "process/page/separation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coast/geo/units.hpp"
#include "coast/study/paired.hpp"
#include "process/page/parts.hpp"

namespace coast::jobs {

namespace {

constexpr double kSettled = 3.0;  // combined sigma over its median

/// The values of converged knots, by compared quantity.
struct Settled {
  std::vector<double> horizontal;
  std::vector<double> vertical;
  std::array<std::vector<double>, 3> attitude;
  std::vector<double> position_ratio;
  std::vector<double> attitude_ratio;
};

double median_of(const std::vector<Separation>& separations, double (*sigma)(const Separation&)) {
  std::vector<double> values;
  for (const Separation& s : separations) values.push_back(sigma(s));
  return study::quantile(std::move(values), 0.5);
}

Settled settled(const std::vector<Separation>& separations) {
  const auto position_sigma = [](const Separation& s) { return s.sd_position.norm(); };
  const auto attitude_sigma = [](const Separation& s) { return s.sd_attitude.norm(); };
  const double position_limit = kSettled * median_of(separations, position_sigma);
  const double attitude_limit = kSettled * median_of(separations, attitude_sigma);
  Settled all;
  for (const Separation& s : separations) {
    if (position_sigma(s) <= position_limit) {
      all.horizontal.push_back(s.position_n.head<2>().norm());
      all.vertical.push_back(std::abs(s.position_n.z()));
      for (Eigen::Index i = 0; i < 3; ++i)
        if (s.sd_position(i) > 0.0) all.position_ratio.push_back(s.position_n(i) / s.sd_position(i));
    }
    if (attitude_sigma(s) <= attitude_limit) {
      for (Eigen::Index i = 0; i < 3; ++i) {
        all.attitude[static_cast<std::size_t>(i)].push_back(std::abs(s.attitude(i)));
        if (s.sd_attitude(i) > 0.0) all.attitude_ratio.push_back(s.attitude(i) / s.sd_attitude(i));
      }
    }
  }
  return all;
}

double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return values.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(values.size()));
}

report::Panel panel_of(const ProcessPage& page, bool position) {
  const std::vector<std::string> names =
      position ? std::vector<std::string>(kNed.begin(), kNed.end()) : std::vector<std::string>(kEuler.begin(), kEuler.end());
  report::Panel panel = report::stacked_time_panel(
      position ? "separation-position" : "separation-attitude", position ? "Separation in position" : "Separation in attitude",
      names, position ? "m" : "arcmin",
      "Forward minus backward filter; two thirds inside the combined one-sigma band and no plateau is good.");
  const auto& separations = page.result.separations;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    report::Decimator difference({8000});
    report::Decimator band({8000});
    for (const Separation& s : separations) {
      const double t = seconds_since_start(page, s.t);
      const double unit = position ? 1.0 : geo::kArcMinute;
      const double sd = (position ? s.sd_position(k) : s.sd_attitude(k)) / unit;
      difference.add(t, (position ? s.position_n(k) : s.attitude(k)) / unit);
      band.add(t, 0.0, -sd, sd);
    }
    report::Line& sigma = report::add_line(panel.plots[i], "combined sigma", band.finish(), report::Tone::kMuted);
    sigma.band_label = "1 sigma";
    sigma.width_px = 0.8;
    report::add_line(panel.plots[i], "forward - backward", difference.finish(), report::Tone::kSmoothed);
  }
  report::shade(panel, outage_intervals(page));
  show_bulk(panel, kErrors);
  return panel;
}

report::Table table_of(const SeparationSummary& s) {
  report::Table table;
  table.id = "separation-table";
  table.title = "Separation, both filters settled";
  table.caption = fmt::format(
      "{} % of {} epochs; left out are those whose combined sigma exceeds three times its median (ends, outages). Over its "
      "sigma: position {}, attitude {}; near 1 is consistent.",
      percent(s.settled), s.epochs, number(s.position_over_sigma, 2), number(s.attitude_over_sigma, 2));
  table.columns = {{"component", "", false}, {"rms", ""}, {"95 %", ""}, {"unit", "", false}};
  table.rows = {cells({"horizontal", number(s.horizontal_rms_m), number(s.horizontal_95_m), "m"}),
                cells({"vertical", number(s.vertical_rms_m), number(s.vertical_95_m), "m"})};
  for (const auto& [name, i] : {std::pair{"heading", 2}, {"pitch", 1}, {"roll", 0}})
    table.rows.push_back(
        cells({name, number(s.attitude_rms(i) / geo::kArcMinute), number(s.attitude_95(i) / geo::kArcMinute), "arcmin"}));
  return table;
}

}  // namespace

std::optional<SeparationSummary> summarise(const std::vector<Separation>& separations) {
  if (separations.empty()) return std::nullopt;
  const Settled all = settled(separations);
  if (all.horizontal.empty() || all.attitude[0].empty()) return std::nullopt;
  SeparationSummary s;
  s.epochs = separations.size();
  s.settled = static_cast<double>(all.horizontal.size()) / static_cast<double>(separations.size());
  s.horizontal_rms_m = rms(all.horizontal);
  s.horizontal_95_m = study::quantile(all.horizontal, 0.95);
  s.vertical_rms_m = rms(all.vertical);
  s.vertical_95_m = study::quantile(all.vertical, 0.95);
  for (std::size_t i = 0; i < 3; ++i) {
    s.attitude_rms(static_cast<Eigen::Index>(i)) = rms(all.attitude[i]);
    s.attitude_95(static_cast<Eigen::Index>(i)) = study::quantile(all.attitude[i], 0.95);
  }
  s.position_over_sigma = rms(all.position_ratio);
  s.attitude_over_sigma = rms(all.attitude_ratio);
  return s;
}

std::optional<report::Section> separation_section(const ProcessPage& page) {
  const auto summary = summarise(page.result.separations);
  if (!summary) return std::nullopt;
  report::Section section;
  section.id = "separation";
  section.title = "Forward/backward separation";
  section.lead =
      "Two filters, one from either end, before each has seen the fix at hand: what they agree on has been found twice. Both "
      "share the error model and the GNSS antenna, so a wrong lever arm is not seen here.";
  section.tables.push_back(table_of(*summary));
  section.panels = {panel_of(page, true), panel_of(page, false)};
  return section;
}

}  // namespace coast::jobs
