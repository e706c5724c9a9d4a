// Section: velocity in body axes.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coast/study/paired.hpp"
#include "process/page/curves.hpp"
#include "process/page/parts.hpp"

namespace coast::jobs {

namespace {

report::Panel body_velocity(const ProcessPage& page) {
  report::Panel panel =
      report::stacked_time_panel("body-velocity", "Velocity in body axes", {"forward", "right", "down"}, "m/s",
                                 "A car neither slides nor jumps: right and down stay near zero; a share of the forward speed "
                                 "in them is a mounting angle.");
  for (std::size_t i = 0; i < 3; ++i)
    report::add_line(panel.plots[i], delivered(page), page.result.curves->curves().body_velocity[i].finish(),
                     delivered_tone(page));
  report::shade(panel, outage_intervals(page));
  show_bulk(panel);
  return panel;
}

/// For a vehicle moving along one of its axes this is its yaw relative to the IMU; not for one that drifts or flies sideways.
report::Panel course_minus_heading(const ProcessPage& page, report::Series slip) {
  constexpr double kAlongOneAxis = 10.0;  // deg between the 5 % and the 95 % quantile
  const double median = study::quantile(slip.y, 0.5);
  const bool steady = study::quantile(slip.y, 0.95) - study::quantile(slip.y, 0.05) < kAlongOneAxis;
  report::Panel panel = report::time_panel(
      "course-minus-heading", "Course minus heading", "deg",
      steady
          ? fmt::format("Above 2 m/s. Constant is good: the median, {} deg, is the yaw of the vehicle against the IMU.",
                        decimals(median, 2))
          : "Above 2 m/s. The vehicle does not keep to one of its axes: drift angle of a boat or an aircraft, sideways flight "
            "of a drone; on a car the heading is wrong.");
  panel.plot().y.label = "course - heading";
  report::add_line(panel.plot(), delivered(page), std::move(slip), delivered_tone(page));
  if (steady) report::add_bound(panel.plot(), median, "median");
  report::shade(panel, outage_intervals(page));
  if (steady) show_bulk(panel);
  return panel;
}

}  // namespace

report::Section body_section(const ProcessPage& page) {
  report::Section section;
  section.id = "body";
  section.title = "Body frame";
  section.panels.push_back(body_velocity(page));
  report::Series slip = page.result.curves->curves().slip.finish();
  if (!slip.y.empty()) section.panels.push_back(course_minus_heading(page, std::move(slip)));
  return section;
}

}  // namespace coast::jobs
