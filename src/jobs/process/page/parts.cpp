#include "process/page/parts.hpp"

#include <algorithm>

namespace coast::jobs {

double seconds_since_start(const ProcessPage& page, geo::GpsTime t) {
  return t - page.result.start;
}

std::vector<report::Interval> outage_intervals(const ProcessPage& page) {
  std::vector<report::Interval> intervals;
  for (const study::OutageResult& o : page.result.outages) {
    const double from = seconds_since_start(page, o.outage.start);
    intervals.push_back({from, from + o.outage.duration_s, fmt::format("outage {}", intervals.size() + 1), report::Tone::kBad});
  }
  return intervals;
}

std::vector<geo::GpsTime> withheld_fixes(const ProcessPage& page) {
  std::vector<geo::GpsTime> times;
  for (const record::GnssFix& fix : page.result.fixes)
    if (std::ranges::any_of(page.result.outages, [&](const auto& o) { return o.outage.span().contains(fix.t); }))
      times.push_back(fix.t);
  return times;
}

std::string delivered(const ProcessPage& page) {
  return page.config.smooth ? "smoothed" : "forward";
}

report::Tone delivered_tone(const ProcessPage& page) {
  return page.config.smooth ? report::Tone::kSmoothed : report::Tone::kForward;
}

}  // namespace coast::jobs
