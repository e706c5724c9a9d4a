#include "velocity_lag.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "coast/geo/earth.hpp"

namespace coast::study {
namespace {

constexpr double kLongestStep = 1.1;  // s: between fixes farther apart velocities are not linear
constexpr double kLargestLag = 0.6;   // s
constexpr double kGrid = 0.01;        // s

// Velocity at t, between the fixes around it; the search begins at `near`.
std::optional<Eigen::Vector3d> velocity_at(const std::vector<record::GnssFix>& fixes, std::size_t near, geo::GpsTime t) {
  std::size_t i = near;
  while (i > 0 && fixes[i].t > t) --i;
  while (i + 1 < fixes.size() && fixes[i + 1].t <= t) ++i;
  if (fixes[i].t > t || i + 1 == fixes.size()) return std::nullopt;
  const record::GnssFix &a = fixes[i], &b = fixes[i + 1];
  if (!a.velocity || !b.velocity || b.t - a.t > kLongestStep) return std::nullopt;
  const double w = (t - a.t) / (b.t - a.t);
  return (1.0 - w) * a.velocity->v_ea_n + w * b.velocity->v_ea_n;
}

struct Displacement {
  std::size_t fix = 0;
  geo::GpsTime middle;
  double dt = 0.0;
  Eigen::Vector3d v_n;  ///< mean velocity from the positions
};

std::vector<Displacement> displacements(const std::vector<record::GnssFix>& fixes) {
  std::vector<Displacement> all;
  for (std::size_t i = 1; i < fixes.size(); ++i) {
    const double dt = fixes[i].t - fixes[i - 1].t;
    if (dt > kLongestStep || !fixes[i].velocity) continue;
    const Eigen::Matrix3d C_e_n = geo::C_n_e(geo::geodetic_from_ecef(fixes[i].r_ea_e)).transpose();
    all.push_back({i, fixes[i - 1].t + 0.5 * dt, dt, C_e_n * (fixes[i].r_ea_e - fixes[i - 1].r_ea_e) / dt});
  }
  return all;
}

}  // namespace

std::optional<double> velocity_lag(const record::GnssRecording& gnss) {
  constexpr std::size_t kFewest = 200;
  constexpr double kLeast = 0.03, kLeft = 0.7;
  const std::vector<Displacement> moves = displacements(gnss.fixes);
  if (moves.size() < kFewest) return std::nullopt;
  const auto residual = [&](double lag) {
    double sum = 0.0;
    std::size_t n = 0;
    for (const Displacement& move : moves) {
      if (const auto v = velocity_at(gnss.fixes, move.fix, move.middle + lag)) {
        // Bounded: a wrong fix is no lag.
        sum += std::min((*v - move.v_n).head<2>().squaredNorm(), 1.0);
        ++n;
      }
    }
    return n > moves.size() / 2 ? sum / static_cast<double>(n) : std::numeric_limits<double>::infinity();
  };
  double best = 0.0, least = residual(0.0);
  const double at_none = least;
  for (double lag = -kLargestLag; lag <= kLargestLag; lag += kGrid)
    if (const double r = residual(lag); r < least) {
      least = r;
      best = lag;
    }
  if (std::abs(best) < kLeast || !(least < kLeft * at_none)) return std::nullopt;
  return best;
}

void advance_velocities(record::GnssRecording& gnss, double lag_s) {
  const std::vector<record::GnssFix> as_read = gnss.fixes;
  for (std::size_t i = 0; i < as_read.size(); ++i) {
    record::GnssFix& fix = gnss.fixes[i];
    if (!fix.velocity) continue;
    if (const auto v = velocity_at(as_read, i, as_read[i].t + lag_s))
      fix.velocity->v_ea_n = *v;
    else
      fix.velocity.reset();
  }
}

}  // namespace coast::study
