#include "arma_garch_climb.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace coast::noise {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kPromise = 1e-10;  // of log-likelihood: 1.4e-5 standard deviations; its rounding is near 1e-11

/// A point with the data of the quadratic model about it.
struct ClimbPoint {
  VectorXd u;
  double value = 0.0;
  VectorXd gradient;
  MatrixXd information;
};

ClimbPoint climb_point_at(ArmaGarchRecursion& recursion, const ArmaGarchCoordinates& coordinates, const VectorXd& u) {
  const ArmaGarchRecursion::Information at = recursion.information(coordinates.centred(u));
  const MatrixXd J = coordinates.centred_by_u(u);
  return {u, at.value, J.transpose() * at.gradient, J.transpose() * at.expected * J};
}

/// Coordinates at an end of the box with an outward gradient, or with lower = upper, are removed from the model.
void hold_at_ends(ClimbPoint& at, const std::vector<Interval>& box) {
  for (Index i = 0; i < at.u.size(); ++i) {
    const Interval& range = box[static_cast<std::size_t>(i)];
    const bool pressed = (at.u(i) <= range.lower && at.gradient(i) <= 0.0) || (at.u(i) >= range.upper && at.gradient(i) >= 0.0);
    if (!pressed && range.lower < range.upper) continue;
    at.gradient(i) = 0.0;
    at.information.row(i).setZero();
    at.information.col(i).setZero();
    at.information(i, i) = 1.0;
  }
}

/// (I + damping diag I)^-1 gradient, at most `kLongest` per coordinate and inside the box.
VectorXd damped_step(const ClimbPoint& at, double damping, const std::vector<Interval>& box) {
  constexpr double kLongest = 3.0;
  constexpr double kFlat = 1e-12;
  const VectorXd scale = at.information.diagonal().cwiseMax(kFlat).cwiseSqrt().cwiseInverse();
  MatrixXd normalised = scale.asDiagonal() * at.information * scale.asDiagonal();
  normalised.diagonal().array() += damping;
  VectorXd step = scale.cwiseProduct(normalised.ldlt().solve(scale.cwiseProduct(at.gradient)));
  for (Index i = 0; i < step.size(); ++i) {
    const Interval& range = box[static_cast<std::size_t>(i)];
    const double to = std::clamp(at.u(i) + std::clamp(step(i), -kLongest, kLongest), range.lower, range.upper);
    step(i) = to - at.u(i);
  }
  return step;
}

}  // namespace

ArmaGarchTop climb_arma_garch(ArmaGarchRecursion& recursion, const ArmaGarchCoordinates& coordinates, const VectorXd& u) {
  constexpr int kMostSteps = 100;
  constexpr double kLeastDamping = 1e-9;
  constexpr double kHopeless = 1e8;
  const std::vector<Interval> box = coordinates.box();
  ClimbPoint at = climb_point_at(recursion, coordinates, u);
  ArmaGarchTop top{u, at.value, false, 1};
  double damping = kLeastDamping;
  while (top.evaluations < kMostSteps && damping < kHopeless) {
    hold_at_ends(at, box);
    if (0.5 * at.gradient.dot(damped_step(at, kLeastDamping, box)) < kPromise) {
      top.converged = true;
      break;
    }
    const ClimbPoint next = climb_point_at(recursion, coordinates, at.u + damped_step(at, damping, box));
    ++top.evaluations;
    if (next.value > at.value) {
      at = next;
      damping = std::max(kLeastDamping, 0.1 * damping);
    } else {
      damping = std::max(1e-3, 10.0 * damping);
    }
  }
  top.u = at.u;
  top.value = at.value;
  return top;
}

}  // namespace coast::noise
