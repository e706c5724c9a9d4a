#include "profile_search.hpp"

#include <algorithm>
#include <cmath>

namespace coast::noise {

namespace {

/// Distance where the root is 1.96, from the roots at up to two distances: the root is linear if the log-likelihood is a
/// parabola, and slightly curved if it is not: r = a d + b d^2.
class RootCurve {
 public:
  double next(double distance, double root) {
    const double slope = std::max(root, 0.1) / distance;
    const double bend = last_ > 0.0 && last_ != distance ? (slope - slope_) / (distance - last_) : 0.0;
    const double start = slope - bend * distance;
    last_ = distance;
    slope_ = slope;
    const double square = start * start + 4.0 * bend * kProfileRoot95;
    const double bent = square >= 0.0 ? 2.0 * kProfileRoot95 / (start + std::sqrt(square)) : -1.0;
    return bent > 0.0 && std::isfinite(bent) ? bent : kProfileRoot95 / slope;
  }

 private:
  double last_ = 0.0;
  double slope_ = 0.0;  ///< r/d there
};

}  // namespace

std::optional<double> crossing(const std::function<double(double)>& root_at, double guess, double farthest) {
  constexpr int kSteps = 25;
  constexpr int kPatience = 5;  // then the root bends away from 1.96, and may never reach it
  constexpr double kClose = 0.01;
  RootCurve curve;
  double near = 0.0;
  std::optional<double> far;
  double distance = std::min(guess, farthest);
  for (int step = 0; step < kSteps; ++step) {
    const double root = root_at(distance);
    if (std::abs(root - kProfileRoot95) < kClose) return distance;
    if (root < kProfileRoot95) {
      if (distance >= farthest) return {};
      near = distance;
    } else {
      far = distance;
    }
    const double expected = curve.next(distance, root);
    if (!far)
      distance = step < kPatience ? std::min({std::max(expected, 1.1 * distance), 3.0 * distance, farthest})
                                  : std::min(3.0 * distance, farthest);
    else
      distance = expected > near && expected < *far ? expected : 0.5 * (near + *far);
    if (far && *far - near < 1e-3 * *far) return distance;
  }
  return far ? std::optional(distance) : std::nullopt;
}

}  // namespace coast::noise
