#include "process/gnss_course.hpp"

#include <algorithm>
#include <cmath>

namespace coast::jobs {

GnssCourse::GnssCourse(const estimate::Mission& mission) : mission_(mission) {
  constexpr double kUsualSteps = 1.5;
  constexpr double kLongest = 2.0;  // s: farther from a fix the position depends on the IMU
  const std::vector<record::GnssFix>& fixes = mission.gnss.fixes;
  std::vector<double> steps;
  for (std::size_t i = 1; i < fixes.size(); ++i) steps.push_back(fixes[i].t - fixes[i - 1].t);
  if (steps.empty()) return;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  reach_s_ = std::min(kLongest, kUsualSteps * *middle);
}

void GnssCourse::add(const estimate::Measurement& measurement, bool used) {
  if (used && measurement.kind == estimate::UpdateKind::kGnssPosition) used_.push_back(measurement.index);
}

void GnssCourse::add_all_but(const std::vector<estimate::Withheld>& withheld) {
  const std::vector<record::GnssFix>& fixes = mission_.gnss.fixes;
  for (std::size_t i = 0; i < fixes.size(); ++i)
    if (std::ranges::none_of(withheld,
                             [&](const auto& span) { return span.satellites_left == 0 && span.contains(fixes[i].t); }))
      used_.push_back(i);
}

geo::GpsTime GnssCourse::time_of(std::size_t fix) const {
  return mission_.gnss.fixes[fix].t - mission_.time_offset_s;
}

std::optional<record::GnssSupport> GnssCourse::at(geo::GpsTime t) const {
  const auto after = std::ranges::lower_bound(used_, t, {}, [this](std::size_t fix) { return time_of(fix); });
  auto nearest = after;
  if (after == used_.end() || (after != used_.begin() && t - time_of(*(after - 1)) < time_of(*after) - t)) {
    if (after == used_.begin()) return std::nullopt;
    nearest = after - 1;
  }
  if (std::abs(time_of(*nearest) - t) > reach_s_) return std::nullopt;
  const record::GnssFix& fix = mission_.gnss.fixes[*nearest];
  return record::GnssSupport{fix.quality, fix.satellites, fix.age_s, fix.ratio};
}

}  // namespace coast::jobs
