// Section: positions of the rover, and differences of forward and backward.

#include <array>
#include <map>

#include "coast/geo/earth.hpp"
#include "coast/report/panels.hpp"
#include "common/page_parts.hpp"
#include "ppk/page/page.hpp"

namespace coast::jobs {

namespace {

using carrier::PpkEpoch;
using record::FixQuality;

constexpr std::array kQualities{FixQuality::kSingle, FixQuality::kFloat, FixQuality::kFixed};  // the best on top

/// Positions from the first fix, or from the first position of any kind.
geo::LocalFrame frame_of(const std::vector<PpkEpoch>& epochs) {
  for (const FixQuality quality : {FixQuality::kFixed, FixQuality::kFloat, FixQuality::kSingle})
    for (const PpkEpoch& epoch : epochs)
      if (epoch.quality == quality) return geo::LocalFrame(geo::geodetic_from_ecef(epoch.r_e));
  return geo::LocalFrame({});
}

report::Panel plan(const PpkResult& result, const geo::LocalFrame& frame) {
  report::Panel panel =
      report::plan_panel("plan", "Positions", "Green fixed, amber float, red single point; metres from the first fix.");
  for (const FixQuality quality : kQualities) {
    report::Decimator track;
    bool any = false;
    for (const PpkEpoch& epoch : result.solution.epochs) {
      if (epoch.quality != quality) continue;
      const Eigen::Vector3d ned = frame.to_ned(epoch.r_e);
      track.add_track(seconds(result, epoch), ned.y(), ned.x());
      any = true;
    }
    if (any) report::add_points(panel.plot(), report::name_of(quality), track.finish(), report::tone_of(quality));
  }
  return panel;
}

report::Panel components(const PpkResult& result, const geo::LocalFrame& frame) {
  report::Panel panel = report::stacked_time_panel("ned", "North, east, down", {"N", "E", "D"}, "m",
                                                   "From the first fix; gaps where there is no position.");
  for (Eigen::Index i = 0; i < 3; ++i)
    for (const FixQuality quality : kQualities) {
      report::Decimator line;
      bool any = false;
      for (const PpkEpoch& epoch : result.solution.epochs) {
        if (epoch.quality != quality) continue;
        line.add(seconds(result, epoch), frame.to_ned(epoch.r_e)(i));
        any = true;
      }
      if (any)
        report::add_points(panel.plots[static_cast<std::size_t>(i)], report::name_of(quality), line.finish(),
                           report::tone_of(quality));
    }
  return panel;
}

std::optional<report::Panel> separation(const PpkResult& result) {
  report::Panel panel = report::stacked_time_panel("separation", "Forward less backward", {"N", "E", "D"}, "m",
                                                   "Zero where both ways have the same integers; centimetres where they fix "
                                                   "different satellites; decimetres: one is wrong.");
  std::array<report::Decimator, 3> lines;
  bool any = false;
  for (const PpkEpoch& epoch : result.solution.epochs) {
    if (!epoch.separation_n) continue;
    any = true;
    for (std::size_t i = 0; i < 3; ++i)
      lines[i].add(seconds(result, epoch), (*epoch.separation_n)(static_cast<Eigen::Index>(i)));
  }
  if (!any) return {};
  for (std::size_t i = 0; i < 3; ++i)
    report::add_line(panel.plots[i], "forward less backward", lines[i].finish(), kComponentTones[i]);
  show_bulk(panel, kErrors);
  return panel;
}

}  // namespace

report::Section ppk_position_section(const PpkResult& result) {
  report::Section section;
  section.id = "positions";
  section.title = "Positions";
  const geo::LocalFrame frame = frame_of(result.solution.epochs);
  section.panels = {plan(result, frame), components(result, frame)};
  if (auto panel = separation(result)) section.panels.push_back(std::move(*panel));
  return section;
}

}  // namespace coast::jobs
