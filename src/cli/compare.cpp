#include "coast/study/comparison.hpp"

#include <fmt/format.h>

#include <string>

#include "coast/geo/units.hpp"
#include "coast/io/reference.hpp"
#include "coast/io/writers.hpp"
#include "coast/record/error.hpp"
#include "commands.hpp"
#include "error_json.hpp"
#include "load.hpp"

namespace coast::cli {

namespace {

std::string errors_csv(const study::Comparison& comparison) {
  std::string text = "gps_week,sow_s,north_m,east_m,down_m";
  if (comparison.has_velocity()) text += ",vn_mps,ve_mps,vd_mps";
  if (comparison.has_attitude()) text += ",roll_deg,pitch_deg,yaw_deg";
  text += '\n';
  const auto add = [&text](const Eigen::Vector3d& v) {
    fmt::format_to(std::back_inserter(text), ",{:.6f},{:.6f},{:.6f}", v.x(), v.y(), v.z());
  };
  for (const study::ErrorSample& e : comparison.errors()) {
    fmt::format_to(std::back_inserter(text), "{},{:.6f}", e.t.week(), e.t.sow());
    add(e.position_n);
    if (comparison.has_velocity()) add(e.velocity_n);
    if (comparison.has_attitude()) add(e.attitude / geo::kDegree);
    text += '\n';
  }
  return text;
}

}  // namespace

void compare(const std::filesystem::path& a, const std::filesystem::path& b, const Eigen::Vector3d& lever_arm_b,
             const CommonOptions& options) {
  const record::Trajectory first = io::read_reference(io::ReferenceFileOptions::of_file(a));
  const record::Trajectory second = io::read_reference(io::ReferenceFileOptions::of_file(b), first.states.front().t);
  record::Trajectory reference = second;
  reference.has_velocity = first.has_velocity && second.has_velocity;
  reference.has_attitude = first.has_attitude && second.has_attitude;
  study::Comparison comparison(reference, lever_arm_b);
  for (const record::NavState& nav : first.states) comparison.add({nav, {}});
  const study::ErrorSummary s = comparison.summary();
  if (s.epochs == 0)
    throw InputError({b.string(), 0, "no epoch within the time of " + a.string(), "trajectories that overlap",
                      "Check the GPS weeks of both files."});
  if (!options.out.empty()) {
    const std::filesystem::path out = output_folder(a, options.out);
    io::write_text(out / "differences.csv", errors_csv(comparison));
    io::write_text(out / "comparison.json", error_json(s).dump(1) + "\n");
  }
  if (options.quiet) return;
  fmt::print("{} epochs of {} compared, {} minus it, N E D\n", s.epochs, b.string(), a.string());
  fmt::print("position rms {:.4f} {:.4f} {:.4f} m, largest {:.4f} {:.4f} {:.4f} m\n", s.position_rms_m.x(),
             s.position_rms_m.y(), s.position_rms_m.z(), s.position_max_m.x(), s.position_max_m.y(), s.position_max_m.z());
  if (s.velocity_rms_mps)
    fmt::print("velocity rms {:.4f} {:.4f} {:.4f} m/s\n", s.velocity_rms_mps->x(), s.velocity_rms_mps->y(),
               s.velocity_rms_mps->z());
  if (s.attitude_rms) {
    const Eigen::Vector3d deg = *s.attitude_rms / geo::kDegree;
    fmt::print("attitude rms {:.4f} {:.4f} {:.4f} deg roll pitch yaw\n", deg.x(), deg.y(), deg.z());
  }
}

}  // namespace coast::cli
