#include "coast/study/comparison.hpp"

#include <fmt/format.h>

#include <string>

#include "coast/geo/units.hpp"
#include "coast/io/reference.hpp"
#include "coast/io/results_folder.hpp"
#include "coast/io/writers.hpp"
#include "coast/record/error.hpp"
#include "commands.hpp"
#include "error_json.hpp"
#include "load.hpp"

namespace coast::cli {

namespace {

/// differences.csv, row by row.
class DifferenceTable {
 public:
  DifferenceTable(bool velocity, bool attitude) : velocity_(velocity), attitude_(attitude) {
    text_ = "gps_week,sow_s,north_m,east_m,down_m";
    if (velocity) text_ += ",vn_mps,ve_mps,vd_mps";
    if (attitude) text_ += ",roll_deg,pitch_deg,yaw_deg";
    text_ += '\n';
  }
  void add(const study::ErrorSample& e) {
    fmt::format_to(std::back_inserter(text_), "{},{:.6f}", e.t.week(), e.t.sow());
    add(e.position_n);
    if (velocity_) add(e.velocity_n);
    if (attitude_) add(e.attitude / geo::kDegree);
    text_ += '\n';
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void add(const Eigen::Vector3d& v) {
    fmt::format_to(std::back_inserter(text_), ",{:.6f},{:.6f},{:.6f}", v.x(), v.y(), v.z());
  }
  bool velocity_;
  bool attitude_;
  std::string text_;
};

void warn_of_interrupted_run(const std::filesystem::path& file) {
  if (const auto awaited = io::awaited_result(file.parent_path()))
    fmt::print(stderr,
               "warning: {}: the run was interrupted before it wrote {}; other files of its folder may be of another run\n",
               file.string(), *awaited);
}

}  // namespace

void compare(const std::filesystem::path& a, const std::filesystem::path& b, const Eigen::Vector3d& lever_arm_b,
             const CommonOptions& options) {
  warn_of_interrupted_run(a);
  warn_of_interrupted_run(b);
  const record::Trajectory first = io::read_reference(io::ReferenceFileOptions::of_file(a));
  const record::Trajectory second = io::read_reference(io::ReferenceFileOptions::of_file(b), first.states.front().t);
  record::Trajectory reference = second;
  reference.has_velocity = first.has_velocity && second.has_velocity;
  reference.has_attitude = first.has_attitude && second.has_attitude;
  DifferenceTable table(reference.has_velocity, reference.has_attitude);
  study::Comparison comparison(reference, lever_arm_b, [&table](const study::ErrorSample& e) { table.add(e); });
  for (const record::NavState& nav : first.states) comparison.add({nav, {}});
  const study::ErrorSummary s = comparison.summary();
  if (s.epochs == 0)
    throw InputError({b.string(), 0, "no epoch within the time of " + a.string(), "trajectories that overlap",
                      "Check the GPS weeks of both files."});
  if (!options.out.empty()) {
    const std::filesystem::path out = output_folder(a, options.out, {"differences.csv", "comparison.json"});
    io::begin_results(out / "comparison.json");
    io::write_text(out / "differences.csv", table.text());
    io::write_text(out / "comparison.json", error_json(s).dump(1) + "\n");
  }
  if (options.quiet) return;
  fmt::print("{} epochs of {} compared, {} minus it, N E D\n", s.epochs, b.string(), a.string());
  const auto print = [](const char* format, const Eigen::Vector3d& v) {
    fmt::print(fmt::runtime(format), v.x(), v.y(), v.z());
  };
  print("position rms {:.4f} {:.4f} {:.4f} m", s.position.rms);
  print(", largest {:.4f} {:.4f} {:.4f} m\n", s.position.max);
  if (s.velocity) print("velocity rms {:.4f} {:.4f} {:.4f} m/s\n", s.velocity->rms);
  if (s.attitude) print("attitude rms {:.4f} {:.4f} {:.4f} deg roll pitch yaw\n", s.attitude->rms / geo::kDegree);
}

}  // namespace coast::cli
