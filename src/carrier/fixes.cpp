#include <fmt/format.h>

#include <Eigen/Eigenvalues>

#include "coast/carrier/ppk.hpp"
#include "coast/geo/earth.hpp"

namespace coast::carrier {

namespace {

/// Symmetric, and positive definite in spite of rounding.
Eigen::Matrix3d in_n(const Eigen::Matrix3d& covariance_e, const Eigen::Matrix3d& C_n_e) {
  constexpr double kLeast = 1e-8;  // m^2: a tenth of a millimetre, resolution of files
  const Eigen::Matrix3d P = C_n_e.transpose() * covariance_e * C_n_e;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(0.5 * (P + P.transpose()));
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(kLeast).asDiagonal() * eigen.eigenvectors().transpose();
}

}  // namespace

record::GnssRecording to_fixes(const PpkSolution& solution, const std::string& source) {
  record::GnssRecording recording;
  recording.source = source;
  long crossed = 0;
  for (const PpkEpoch& epoch : solution.epochs) {
    if (epoch.quality == record::FixQuality::kUnknown) continue;
    if (!recording.fixes.empty() && epoch.t <= recording.fixes.back().t) {
      ++crossed;
      continue;
    }
    const Eigen::Matrix3d C_n_e = geo::C_n_e(geo::geodetic_from_ecef(epoch.r_e));
    record::GnssFix& fix = recording.fixes.emplace_back();
    fix.t = epoch.t;
    fix.r_ea_e = epoch.r_e;
    fix.position_cov_n = in_n(epoch.covariance_e, C_n_e);
    if (epoch.velocity) fix.velocity = {C_n_e.transpose() * epoch.velocity->v_e, in_n(epoch.velocity->covariance_e, C_n_e)};
    fix.quality = epoch.quality;
    fix.satellites = epoch.satellites;
    fix.age_s = epoch.age_s;
    fix.ratio = epoch.ratio;
  }
  if (crossed > 0)
    recording.events.push_back({record::Event::Severity::kWarning, "epoch_order",
                                fmt::format("{}: {} epoch{} that the receiver's clock puts before the one before left out",
                                            source, crossed, crossed == 1 ? "" : "s"),
                                std::nullopt, crossed});
  return recording;
}

}  // namespace coast::carrier
