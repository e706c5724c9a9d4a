// baselines.csv: from a moving base to the rover, as the aid `baseline` reads it: two antennas of one vehicle give its heading.

#include <fmt/format.h>

#include <iterator>

#include "coast/geo/earth.hpp"
#include "ppk/summary.hpp"

namespace coast::jobs {

std::string baselines_csv(const PpkResult& result) {
  std::string text = "gps_week,sow_s,north_m,east_m,down_m,sdn_m,sde_m,sdd_m,length_m,quality\n";
  for (const carrier::PpkEpoch& epoch : result.solution.epochs) {
    if (epoch.quality != record::FixQuality::kFixed && epoch.quality != record::FixQuality::kFloat) continue;
    const Eigen::Matrix3d C_e_n = geo::C_n_e(geo::geodetic_from_ecef(epoch.r_e)).transpose();
    const Eigen::Vector3d baseline_n = C_e_n * (epoch.r_e - epoch.r_base_e);
    constexpr double kLeast = 1e-6;  // m, the last digit: a sigma of zero could not be read back
    const Eigen::Vector3d sd = (C_e_n * epoch.covariance_e * C_e_n.transpose()).diagonal().cwiseSqrt().cwiseMax(kLeast);
    fmt::format_to(std::back_inserter(text), "{},{:.6f},{:.4f},{:.4f},{:.4f},{:.6f},{:.6f},{:.6f},{:.4f},{}\n", epoch.t.week(),
                   epoch.t.sow(), baseline_n.x(), baseline_n.y(), baseline_n.z(), sd.x(), sd.y(), sd.z(), baseline_n.norm(),
                   static_cast<int>(epoch.quality));
  }
  return text;
}

}  // namespace coast::jobs
