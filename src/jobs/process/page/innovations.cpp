// Section: innovations compared with the filter's prediction.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "coast/noise/chi_square.hpp"
#include "process/page/parts.hpp"

namespace coast::jobs {

namespace {

using estimate::InnovationRecord;
using estimate::UpdateKind;
using Records = std::vector<const InnovationRecord*>;

constexpr double kBoundSigmas = 3.0;
constexpr std::size_t kMostDots = 8000;

Records of_kind(const ProcessPage& page, UpdateKind kind) {
  Records records;
  for (const InnovationRecord& r : page.result.innovations)
    if (r.kind == kind) records.push_back(&r);
  return records;
}

/// Fixes, or carrier phases used instead.
Records positions_of(const ProcessPage& page) {
  Records fixes = of_kind(page, UpdateKind::kGnssPosition);
  return fixes.empty() ? of_kind(page, UpdateKind::kCarrierPhase) : fixes;
}

/// For three degrees of freedom, for comparison with the bounds of positions.
double nis_of_three(const InnovationRecord& r) {
  return 3.0 * r.nis / r.dof;
}

/// N, E, D of one kind of update with the filter's own bounds.
report::Panel innovation_panel(const ProcessPage& page, const Records& records, const std::string& what,
                               const std::string& unit) {
  report::Panel panel =
      report::stacked_time_panel("innovations-" + what, "Innovations, GNSS " + what, {kNed.begin(), kNed.end()}, unit,
                                 "Measured minus predicted; 99.7 % inside the bounds, no trend and no waves, is good.");
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    report::Decimator used({kMostDots});
    report::Decimator refused({kMostDots});
    report::Decimator bound({kMostDots, 30.0});
    bool any_refused = false;
    for (const InnovationRecord* r : records) {
      const double t = seconds_since_start(page, r->t);
      bound.add(t, 0.0, -kBoundSigmas * r->sd(k), kBoundSigmas * r->sd(k));
      (r->used ? used : refused).add(t, r->nu(k));
      any_refused = any_refused || !r->used;
    }
    report::Line& line = report::add_line(panel.plots[i], "bound", bound.finish(), report::Tone::kMuted);
    line.band_label = "3 sigma";
    line.width_px = 0.6;
    report::add_points(panel.plots[i], "used", used.finish(), report::Tone::kSmoothed);
    if (any_refused) report::add_points(panel.plots[i], "refused", refused.finish(), report::Tone::kBad).radius_px = 2.4;
  }
  report::shade(panel, outage_intervals(page));
  show_bulk(panel, kErrors);
  return panel;
}

/// Mean of the NIS over the last minute: a constant deviation from the expected one means a wrong sigma, a wave a wrong model.
report::Series minute_mean(const ProcessPage& page, const Records& records) {
  constexpr double kWindow = 60.0;  // s
  report::Decimator mean({4000, kWindow});
  std::size_t first = 0;
  double sum = 0.0;
  for (std::size_t i = 0; i < records.size(); ++i) {
    sum += nis_of_three(*records[i]);
    for (; records[i]->t - records[first]->t > kWindow; ++first) sum -= nis_of_three(*records[first]);
    mean.add(seconds_since_start(page, records[i]->t), sum / static_cast<double>(i - first + 1));
  }
  return mean.finish();
}

report::Panel nis_panel(const ProcessPage& page, const Records& positions, const Records& velocities) {
  report::Panel panel =
      report::time_panel("nis", "Normalised innovations squared", "",
                         "One in a thousand above its bound and a mean at 3, the degrees of freedom, is good.");
  report::Plot& plot = panel.plot();
  plot.y.label = "NIS";
  plot.y.scale = report::Axis::Scale::kLog;
  double highest = 0.0;
  const auto add = [&](const Records& records, const std::string& name, report::Tone dots, report::Tone mean) {
    if (records.empty()) return;
    report::Decimator nis({kMostDots});
    for (const InnovationRecord* r : records) {
      nis.add(seconds_since_start(page, r->t), nis_of_three(*r));
      highest = std::max(highest, nis_of_three(*r));
    }
    report::add_points(plot, name, nis.finish(), dots).radius_px = 1.2;
    report::add_line(plot, name + ", mean over 60 s", minute_mean(page, records), mean).width_px = 2.0;
  };
  add(velocities, "velocity", report::Tone::kForward, report::Tone::kY);
  add(positions, "position", report::Tone::kMuted, report::Tone::kSmoothed);
  plot.bounds.push_back({3.0, "expected 3", report::Tone::kGood});
  plot.bounds.push_back({noise::chi2_upper_quantile(3, 1e-3), "99.9 %", report::Tone::kWarn});
  const double gate = page.result.used.filter.gate_probability;
  if (gate > 0.0) plot.bounds.push_back({noise::chi2_upper_quantile(3, gate), "gate", report::Tone::kBad});
  plot.y.range = {0.03, std::max(100.0, 2.0 * highest)};
  report::shade(panel, outage_intervals(page));
  return panel;
}

/// Density of nu / sigma over all components, with the standard normal.
report::Plot histogram(const Records& records, const std::string& what) {
  constexpr double kEdge = 5.0;
  constexpr int kBins = 50;
  report::Plot plot;
  plot.title = what;
  plot.x = {"innovation / sigma", "", report::Axis::Scale::kLinear, {}, {}};
  plot.y = {"density", "", report::Axis::Scale::kLinear, {}, {}};
  plot.height_px = 220;
  report::Bars bars{what, {}, std::vector<double>(kBins, 0.0), report::Tone::kSmoothed};
  const double width = 2.0 * kEdge / kBins;
  for (int i = 0; i <= kBins; ++i) bars.edges.push_back(-kEdge + width * i);
  const double each = 1.0 / (3.0 * static_cast<double>(records.size()) * width);
  for (const InnovationRecord* r : records) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      if (!(r->sd(k) > 0.0)) continue;
      const double bin = std::clamp(std::floor((r->nu(k) / r->sd(k) + kEdge) / width), 0.0, kBins - 1.0);
      bars.heights[static_cast<std::size_t>(bin)] += each;
    }
  }
  plot.bars.push_back(std::move(bars));
  report::Series normal;
  for (double x = -kEdge; x <= kEdge + 1e-9; x += 0.1) {
    normal.x.push_back(x);
    normal.y.push_back(std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi));
  }
  report::add_line(plot, "unit normal", std::move(normal), report::Tone::kReference).width_px = 1.8;
  return plot;
}

report::Panel histogram_panel(const Records& positions, const Records& velocities) {
  const bool both = !positions.empty() && !velocities.empty();
  report::Panel panel =
      report::grid_panel("innovation-histogram", "Normalised innovations", both ? 2 : 1,
                         "As broad as the unit normal is good; narrower: stated sigmas too large, broader: too "
                         "small; what lies beyond five sigma stands in the outermost bins.");
  if (!positions.empty()) panel.plots.push_back(histogram(positions, "GNSS position"));
  if (!velocities.empty()) panel.plots.push_back(histogram(velocities, "GNSS velocity"));
  return panel;
}

/// Uninterrupted stretches of one kind of update on a row: two points per stretch, at any rate.
report::Series stretches(const ProcessPage& page, const std::vector<geo::GpsTime>& times, double row) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < times.size(); ++i) steps.push_back(times[i] - times[i - 1]);
  double usual = 0.0;
  if (!steps.empty()) {
    std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
    usual = steps[steps.size() / 2];
  }
  report::Series series;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const bool begins = i == 0 || times[i] - times[i - 1] > 1.5 * usual;
    const bool ends = i + 1 == times.size() || times[i + 1] - times[i] > 1.5 * usual;
    if (!begins && !ends) continue;
    if (begins && i > 0) series.breaks.push_back(static_cast<std::uint32_t>(series.x.size()));
    series.x.push_back(seconds_since_start(page, times[i]));
    series.y.push_back(row);
  }
  return series;
}

std::vector<geo::GpsTime> aid_times(const ProcessPage& page, std::size_t aid, bool used) {
  std::vector<geo::GpsTime> times;
  for (const InnovationRecord& r : page.result.innovations)
    if (r.kind == UpdateKind::kAid && r.aid == aid && r.used == used) times.push_back(r.t);
  return times;
}

report::Panel update_panel(const ProcessPage& page) {
  report::Panel panel = report::time_panel("updates", "Updates by epoch", "",
                                           "GNSS throughout, zero velocity at stops; refused fixes are single and rare.");
  report::Plot& plot = panel.plot();
  const auto add = [&](const std::string& name, report::Tone tone, bool refusals, const std::vector<geo::GpsTime>& times) {
    if (times.empty()) return;
    const auto row = static_cast<double>(plot.y.ticks.size());
    plot.y.ticks.push_back({row, name});
    report::add_line(plot, name, stretches(page, times, row), tone).width_px = 4.0;
    if (refusals) report::add_points(plot, name, stretches(page, times, row), tone).radius_px = 3.0;  // a single one is visible
  };
  const auto times_of = [&](UpdateKind kind, bool used) {
    std::vector<geo::GpsTime> times;
    for (const InnovationRecord& r : page.result.innovations)
      if (r.kind == kind && r.used == used) times.push_back(r.t);
    return times;
  };
  add("withheld", report::Tone::kMuted, false, withheld_fixes(page));
  add("velocity refused", report::Tone::kWarn, true, times_of(UpdateKind::kGnssVelocity, false));
  add("position refused", report::Tone::kBad, true, times_of(UpdateKind::kGnssPosition, false));
  for (std::size_t a = 0; a < page.result.aids.size(); ++a) {
    add(page.result.aids[a].name + " refused", report::Tone::kWarn, true, aid_times(page, a, false));
    add(page.result.aids[a].name, report::Tone::kY, false, aid_times(page, a, true));
  }
  add("heading held", report::Tone::kSbas, false, times_of(UpdateKind::kHeadingHold, true));
  add("non-holonomic", report::Tone::kDgps, false, times_of(UpdateKind::kNonHolonomic, true));
  add("zero velocity", report::Tone::kSbas, false, times_of(UpdateKind::kZeroVelocity, true));
  add("GNSS velocity", report::Tone::kPpp, false, times_of(UpdateKind::kGnssVelocity, true));
  add("GNSS position", report::Tone::kFixed, false, times_of(UpdateKind::kGnssPosition, true));
  add("members refused", report::Tone::kWarn, true, times_of(UpdateKind::kMemberDifference, false));
  add("members of the IMU", report::Tone::kMuted, false, times_of(UpdateKind::kMemberDifference, true));
  add("carrier phases", report::Tone::kFixed, false, times_of(UpdateKind::kCarrierPhase, true));
  plot.height_px = 70 + 26 * static_cast<int>(plot.y.ticks.size());
  report::shade(panel, outage_intervals(page));
  return panel;
}

/// Correlation of successive normalised innovations of used fixes; white ones have 0.
double correlation(const Records& records, Eigen::Index component) {
  double product = 0.0;
  double square = 0.0;
  const InnovationRecord* last = nullptr;
  for (const InnovationRecord* r : records) {
    if (!r->used || !(r->sd(component) > 0.0)) continue;
    const double x = r->nu(component) / r->sd(component);
    square += x * x;
    if (last != nullptr) product += x * last->nu(component) / last->sd(component);
    last = r;
  }
  return square > 0.0 ? product / square : 0.0;
}

std::string lead_of(const ProcessPage& page, const Records& positions) {
  const ProcessResult& r = page.result;
  std::string text;
  if (r.nis.epochs > 0)
    text += fmt::format("Mean NIS {} over {} epochs, expected {}. ", number(r.nis.mean), r.nis.epochs, number(r.nis.expected));
  const double gate = page.result.used.filter.gate_probability;
  text += fmt::format("{} of {} positions were refused. ", r.gnss_rejected, r.gnss_used + r.gnss_rejected);
  if (gate > 0.0 && r.smallest_refusable_m > 0.0)
    text += fmt::format("Smallest error of a fix that the gate can refuse: {} m (median). ", number(r.smallest_refusable_m, 2));
  if (gate == 0.0) text += "The gate is open: nothing is refused. ";
  if (positions.size() > 10)
    text += fmt::format(
        "Successive position innovations correlate by {:.2f} / {:.2f} / {:.2f} (N / E / D; white: 0 within {:.2f}).",
        correlation(positions, 0), correlation(positions, 1), correlation(positions, 2),
        2.0 / std::sqrt(static_cast<double>(positions.size())));
  return text;
}

}  // namespace

std::optional<report::Section> innovation_section(const ProcessPage& page) {
  const Records positions = positions_of(page);
  const Records velocities = of_kind(page, UpdateKind::kGnssVelocity);
  if (page.result.innovations.empty()) return std::nullopt;
  report::Section section;
  section.id = "innovations";
  section.title = "Innovations";
  section.lead = lead_of(page, positions);
  add_noise_fit(page, section);
  if (!positions.empty()) section.panels.push_back(innovation_panel(page, positions, "position", "m"));
  if (!velocities.empty()) section.panels.push_back(innovation_panel(page, velocities, "velocity", "m/s"));
  if (!positions.empty() || !velocities.empty()) {
    section.panels.push_back(nis_panel(page, positions, velocities));
    section.panels.push_back(histogram_panel(positions, velocities));
  }
  add_aids(page, section);
  section.panels.push_back(update_panel(page));
  return section;
}

}  // namespace coast::jobs
