// Section: position, velocity and attitude over time with their sigmas, forward and smoothed.

#include "process/page/curves.hpp"
#include "process/page/parts.hpp"

namespace coast::jobs {

namespace {

std::vector<std::string> names(const std::array<std::string, 3>& of) {
  return {of.begin(), of.end()};
}

/// Forward below the delivered curve, which has a sigma band.
report::Panel solution_panel(const ProcessPage& page, report::Panel panel, const Decimators& forward, const Decimators& best) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (page.config.smooth) {
      report::Series series = forward[i].finish();
      series.band.reset();
      report::add_line(panel.plots[i], "forward", std::move(series), report::Tone::kForward);
    }
    report::add_line(panel.plots[i], delivered(page), best[i].finish(), delivered_tone(page)).band_label = "1 sigma";
  }
  report::shade(panel, outage_intervals(page));
  show_bulk(panel);
  return panel;
}

/// Predicted sigmas on a logarithmic axis, forward and smoothed.
report::Panel accuracy_panel(const ProcessPage& page, report::Panel panel, const Decimators& forward, const Decimators& best) {
  for (std::size_t i = 0; i < 3; ++i) {
    panel.plots[i].y.scale = report::Axis::Scale::kLog;
    if (page.config.smooth) report::add_line(panel.plots[i], "forward", forward[i].finish(), report::Tone::kForward);
    report::add_line(panel.plots[i], delivered(page), best[i].finish(), delivered_tone(page));
  }
  report::shade(panel, outage_intervals(page));
  return panel;
}

}  // namespace

report::Section motion_section(const ProcessPage& page) {
  const TrajectoryCurves::Curves& c = page.result.curves->curves();
  const auto ned = names(kNed);
  const auto euler = names(kEuler);
  report::Section section;
  section.id = "motion";
  section.title = "Position, velocity, attitude";
  section.lead = "Of the IMU's point, in north, east and down; position relative to the start. All axes of time zoom together.";
  section.panels.push_back(solution_panel(
      page,
      report::stacked_time_panel("position", "Position", ned, "m", "Forward and smoothed lie on each other except in outages."),
      c.forward.position, c.smoothed.position));
  section.panels.push_back(
      solution_panel(page,
                     report::stacked_time_panel("velocity", "Velocity", ned, "m/s",
                                                "Without steps at updates, and zero where the vehicle stood."),
                     c.forward.velocity, c.smoothed.velocity));
  section.panels.push_back(
      solution_panel(page,
                     report::stacked_time_panel("attitude", "Attitude", euler, "deg",
                                                "Roll and pitch near zero on level ground; yaw is unwrapped. Forward joins "
                                                "smoothed once turns and accelerations have shown the heading."),
                     c.forward.attitude, c.smoothed.attitude));
  section.panels.push_back(accuracy_panel(
      page,
      report::stacked_time_panel("accuracy-position", "Estimated accuracy, position", {"sigma N", "sigma E", "sigma D"}, "m",
                                 "One sigma. Flat at the accuracy of the fixes, one hump per outage; smoothed below forward."),
      c.forward.sd_position, c.smoothed.sd_position));
  section.panels.push_back(accuracy_panel(
      page,
      report::stacked_time_panel("accuracy-velocity", "Estimated accuracy, velocity", {"sigma N", "sigma E", "sigma D"}, "m/s",
                                 "One sigma. Flat, with one hump per outage; smoothed below forward."),
      c.forward.sd_velocity, c.smoothed.sd_velocity));
  section.panels.push_back(
      accuracy_panel(page,
                     report::stacked_time_panel(
                         "accuracy-attitude", "Estimated accuracy, attitude", {"sigma roll", "sigma pitch", "sigma yaw"}, "deg",
                         "One sigma. Falls with the first accelerations and stays; yaw grows in long straight stretches."),
                     c.forward.sd_attitude, c.smoothed.sd_attitude));
  return section;
}

}  // namespace coast::jobs
