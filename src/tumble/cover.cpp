#include "coast/tumble/cover.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coast::tumble {

namespace {

using Row = Eigen::Matrix<double, 1, 9>;

// A rest measures |f|, so of its errors only the part along f: u.(gain f + bias), f = g u.
Row sensitivity(const Eigen::Vector3d& u, double gravity) {
  Row h;
  h << u.transpose(), gravity * u.x() * u.x(), gravity * u.y() * u.y(), gravity * u.z() * u.z(), 2.0 * gravity * u.x() * u.y(),
      2.0 * gravity * u.x() * u.z(), 2.0 * gravity * u.y() * u.z();
  return h;
}

// A rest as long as the usual one.
double variance_of(const Result& result, const Eigen::Vector3d& u) {
  std::vector<double> white;
  for (const RestFit& rest : result.rests) white.push_back(u.cwiseAbs2().dot(rest.rest.accel_variance));
  std::ranges::nth_element(white, white.begin() + static_cast<std::ptrdiff_t>(white.size() / 2));
  return white[white.size() / 2] + result.levels.accel * result.levels.accel;
}

double gain_of(const Eigen::Matrix<double, 9, 9>& covariance, const Row& h, double variance) {
  return 0.5 * std::log1p((h * covariance * h.transpose()).value() / variance);
}

}  // namespace

double information(const Result& result, const Eigen::Vector3d& up) {
  return gain_of(result.accel_covariance, sensitivity(up, result.gravity), variance_of(result, up));
}

std::vector<Eigen::Vector3d> directions(std::size_t count) {
  std::vector<Eigen::Vector3d> all;
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(count);
    const double r = std::sqrt(1.0 - z * z);
    const double angle = golden * static_cast<double>(i);
    all.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
  }
  return all;
}

std::vector<Proposal> proposals(const Result& result, std::size_t count) {
  const std::vector<Eigen::Vector3d> candidates = directions(1000);
  Eigen::Matrix<double, 9, 9> P = result.accel_covariance;
  std::vector<Proposal> found;
  for (std::size_t n = 0; n < count; ++n) {
    Proposal best;
    for (const Eigen::Vector3d& up : candidates)
      if (const double gain = gain_of(P, sensitivity(up, result.gravity), variance_of(result, up)); gain > best.information)
        best = {up, gain, 0.0};
    if (best.information == 0.0) break;
    const Row h = sensitivity(best.up, result.gravity);
    const Eigen::Matrix<double, 9, 1> P_h = P * h.transpose();
    P -= P_h * P_h.transpose() / ((h * P_h).value() + variance_of(result, best.up));
    best.largest_gain_sd = std::sqrt(P.diagonal().tail<6>().maxCoeff());
    found.push_back(best);
  }
  return found;
}

}  // namespace coast::tumble
