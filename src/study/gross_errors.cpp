#include "gross_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace coast::study {
namespace {

constexpr double kAcceleration = 30.0;  // m/s^2
constexpr double kErrorSigmas = 6.0;
constexpr double kLeastError = 5.0;   // m: smaller errors are left to the gate
constexpr double kLongestGap = 60.0;  // s to a neighbour; beyond it there is no information

double possible(double seconds_squared, double variance) {
  return std::max(kLeastError, 0.5 * kAcceleration * seconds_squared + kErrorSigmas * std::sqrt(variance));
}

// Whether a fix continues the line of the two on one side of it: if positions jump permanently the fix is not wrong.
bool continues(const record::GnssFix& far, const record::GnssFix& near, const record::GnssFix& fix) {
  const double a = near.t - far.t, b = fix.t - near.t;  // both negative after the fix
  const Eigen::Vector3d led_to = near.r_ea_e + (b / a) * (near.r_ea_e - far.r_ea_e);
  const double variance = fix.position_cov_n.trace() + far.position_cov_n.trace() + near.position_cov_n.trace();
  return (fix.r_ea_e - led_to).norm() < possible(b * (a + b), variance);
}

bool continues_a_side(const std::vector<record::GnssFix>& fixes, std::size_t i) {
  return (i >= 2 && continues(fixes[i - 2], fixes[i - 1], fixes[i])) ||
         (i + 2 < fixes.size() && continues(fixes[i + 2], fixes[i + 1], fixes[i]));
}

// Excess of the distance from the line over the possible one, m; at most zero for a possible fix.
double excess(const record::GnssFix& before, const record::GnssFix& fix, const record::GnssFix& after) {
  const double a = fix.t - before.t, b = after.t - fix.t;
  if (a > kLongestGap || b > kLongestGap) return 0.0;
  const Eigen::Vector3d line = (b * before.r_ea_e + a * after.r_ea_e) / (a + b);
  const double variance = fix.position_cov_n.trace() + before.position_cov_n.trace() + after.position_cov_n.trace();
  return (fix.r_ea_e - line).norm() - possible(a * b, variance);
}

}  // namespace

void leave_out_gross_errors(record::GnssRecording& gnss, record::Events& events) {
  std::vector<record::GnssFix>& fixes = gnss.fixes;
  long count = 0;
  std::optional<geo::GpsTime> first;
  // A gross error moves the lines of its neighbours by half: it is the one with the largest excess of the three.
  for (bool found = true; found;) {
    std::vector<double> out(fixes.size(), 0.0);
    for (std::size_t i = 1; i + 1 < fixes.size(); ++i) out[i] = excess(fixes[i - 1], fixes[i], fixes[i + 1]);
    std::vector<record::GnssFix> kept;
    kept.reserve(fixes.size());
    for (std::size_t i = 0; i < fixes.size(); ++i) {
      const bool gross = out[i] > 0.0 && out[i] >= out[i - 1] && out[i] >= out[i + 1] && !continues_a_side(fixes, i);
      if (!gross) {
        kept.push_back(std::move(fixes[i]));
        continue;
      }
      if (!first || fixes[i].t < *first) first = fixes[i].t;
      ++count;
    }
    found = kept.size() < fixes.size();
    fixes = std::move(kept);
  }
  if (count == 0) return;
  events.push_back(
      {record::Event::Severity::kWarning, "gross_errors_left_out",
       fmt::format("{} GNSS fix{} farther from the line between {} neighbours than a vehicle can move, and {} left out", count,
                   count == 1 ? " lies" : "es lie", count == 1 ? "its" : "their", count == 1 ? "was" : "were"),
       first, count});
}

}  // namespace coast::study
