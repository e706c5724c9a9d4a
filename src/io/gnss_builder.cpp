#include "gnss_builder.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace coast::io {

namespace {

constexpr double kGnssNanShare = 0.2;  // receivers write empty rows without a fix
// Rounding of digits may give correlations beyond 1, most if a standard deviation has one digit; a factor of two is an error.
constexpr double kLeastShrink = 0.5;
constexpr double kLeastEigenvalue = 1e-3;

}  // namespace

record::FixQuality quality_from(double number) {
  const long n = std::isfinite(number) ? std::lround(std::clamp(number, -1.0, 100.0)) : -1;
  return n >= 1 && n <= 6 ? static_cast<record::FixQuality>(n) : record::FixQuality::kUnknown;
}

Eigen::Matrix3d neu_to_ned(const Eigen::Matrix3d& cov) {
  const Eigen::DiagonalMatrix<double, 3> flip(1.0, 1.0, -1.0);
  return flip * cov * flip;
}

GnssBuilder::GnssBuilder(TableReader& table) : table_(table), order_(table, repairs_) {
  recording_.source = table.name();
  recording_.fixes.reserve(table.expected_rows());
}

Eigen::Matrix3d GnssBuilder::covariance(const SignedRoots& roots, std::string_view what, std::string_view key) {
  for (int i = 0; i < 3; ++i) {
    if (roots.sd[i] > 0.0 && roots.sd[i] < 1e6) continue;
    throw table_.error(fmt::format("{} standard deviation {} (N, E, D or column {})", what, roots.sd[i], i + 1), "> 0",
                       fmt::format("A fix without uncertainty has no weight; give `{}: [n, e, d]` beside the file.", key));
  }
  Eigen::Matrix3d off = Eigen::Matrix3d::Zero();  // correlations without the unit diagonal
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const double covariance = std::copysign(roots.cross[i] * roots.cross[i], roots.cross[i]);
    off(i, j) = off(j, i) = covariance / (roots.sd[i] * roots.sd[j]);
  }
  if (!off.isZero(0.0)) {
    const double lowest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(off, Eigen::EigenvaluesOnly).eigenvalues()[0];
    if (1.0 + lowest < kLeastEigenvalue) {
      const double shrink = (1.0 - kLeastEigenvalue) / -lowest;
      const InputError as_error = table_.error(
          fmt::format("{} covariance that is not positive definite (smallest eigenvalue of the correlations {:.3f})", what,
                      1.0 + lowest),
          "signed roots sign(c) sqrt|c| of covariances, as RTKLIB writes them");
      if (shrink < kLeastShrink) throw as_error;
      repairs_.add("covariance_pulled_back", "with correlations beyond 1 by rounding pulled back", 1.0, as_error, std::nullopt);
      off *= shrink;
    }
  }
  return roots.sd.asDiagonal() * (Eigen::Matrix3d::Identity() + off) * roots.sd.asDiagonal();
}

void GnssBuilder::leave_out_nan() {
  repairs_.add("nan_row", "with a field that is empty or not finite left out", kGnssNanShare,
               table_.error("a field that is empty or not finite", "numbers", "Are the columns mapped right?"), std::nullopt);
}

void GnssBuilder::add(const record::GnssFix& fix) {
  auto& fixes = recording_.fixes;
  if (order_.accept(fix.t, !fixes.empty() && fixes.back().r_ea_e == fix.r_ea_e)) fixes.push_back(fix);
}

record::GnssRecording GnssBuilder::finish(const record::Events& more) {
  for (const auto& event : table_.events()) recording_.events.push_back(event);
  recording_.events.insert(recording_.events.end(), more.begin(), more.end());
  repairs_.finish(table_.rows(), recording_.events);
  if (recording_.fixes.empty()) throw InputError({table_.name(), 0, "no GNSS fix", "at least one", ""});
  return std::move(recording_);
}

}  // namespace coast::io
