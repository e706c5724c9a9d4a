#include "doppler_displacement.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "quantile.hpp"

namespace coast::carrier {

DopplerDisplacement doppler_displacement(const SinglePoint::Velocity& first, const SinglePoint::Velocity& second, double dt) {
  return {0.5 * dt * (first.v_e + second.v_e), 0.25 * dt * dt * (first.covariance_e + second.covariance_e)};
}

std::optional<double> displacement_noise(const std::vector<DifferenceEpoch>& epochs, const std::vector<PpkEpoch>& solved) {
  constexpr std::size_t kEnough = 30;
  constexpr double kShare = 0.9;
  constexpr double kChiSquare = 6.25;  // 90 % of three components
  constexpr double kLeast = 1.0, kMost = 100.0;
  std::vector<double> squares;
  for (std::size_t i = 1; i < solved.size(); ++i) {
    const std::optional<SinglePoint>&before = epochs[i - 1].alone, &now = epochs[i].alone;
    const bool fixed = solved[i - 1].quality == record::FixQuality::kFixed && solved[i].quality == record::FixQuality::kFixed;
    if (!fixed || !before || !now || !before->velocity || !now->velocity) continue;
    const DopplerDisplacement by_doppler =
        doppler_displacement(*before->velocity, *now->velocity, solved[i].t - solved[i - 1].t);
    const Eigen::Vector3d off = solved[i].r_e - solved[i - 1].r_e - by_doppler.d_e;
    squares.push_back(off.dot(by_doppler.covariance_e.ldlt().solve(off)));
  }
  if (squares.size() < kEnough) return std::nullopt;
  const double factor = std::sqrt(quantile(std::move(squares), kShare) / kChiSquare);
  return factor < kMost ? std::optional(std::max(factor, kLeast)) : std::nullopt;
}

}  // namespace coast::carrier
