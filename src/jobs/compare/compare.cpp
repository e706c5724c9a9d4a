#include "coast/jobs/compare.hpp"

#include <fmt/format.h>

#include <iterator>

#include "coast/geo/units.hpp"
#include "coast/io/reference.hpp"
#include "coast/io/results_folder.hpp"
#include "coast/io/writers.hpp"
#include "common/error_json.hpp"

namespace coast::jobs {

namespace {

void add(const Eigen::Vector3d& v, std::string& text) {
  fmt::format_to(std::back_inserter(text), ",{:.6f},{:.6f},{:.6f}", v.x(), v.y(), v.z());
}

std::string differences_csv(const ComparisonResult& result) {
  std::string text = "gps_week,sow_s,north_m,east_m,down_m";
  if (result.has_velocity) text += ",vn_mps,ve_mps,vd_mps";
  if (result.has_attitude) text += ",roll_deg,pitch_deg,yaw_deg";
  text += '\n';
  for (const study::ErrorSample& e : result.differences) {
    fmt::format_to(std::back_inserter(text), "{},{:.6f}", e.t.week(), e.t.sow());
    add(e.position_n, text);
    if (result.has_velocity) add(e.velocity_n, text);
    if (result.has_attitude) add(e.attitude / geo::kDegree, text);
    text += '\n';
  }
  return text;
}

void warn_of_interrupted_run(const std::filesystem::path& file, const Progress& progress) {
  const auto awaited = io::awaited_result(file.parent_path());
  if (awaited && progress.warn)
    progress.warn(fmt::format("{}: the run was interrupted before it wrote {}; other files of its folder may be of another run",
                              file.string(), *awaited));
}

}  // namespace

ComparisonResult compare(const record::Trajectory& first, const record::Trajectory& second,
                         const Eigen::Vector3d& lever_arm_b) {
  ComparisonResult result;
  record::Trajectory reference = second;
  result.has_velocity = reference.has_velocity = first.has_velocity && second.has_velocity;
  result.has_attitude = reference.has_attitude = first.has_attitude && second.has_attitude;
  study::Comparison comparison(reference, lever_arm_b, [&](const study::ErrorSample& e) { result.differences.push_back(e); });
  for (const record::NavState& nav : first.states) comparison.add({nav, {}});
  result.summary = comparison.summary();
  return result;
}

ComparisonResult compare(const ComparisonConfig& config, const Progress& progress) {
  for (const auto& file : {config.first, config.second}) warn_of_interrupted_run(file, progress);
  const record::Trajectory first = io::read_reference(io::ReferenceFileOptions::of_file(config.first));
  const record::Trajectory second =
      io::read_reference(io::ReferenceFileOptions::of_file(config.second), first.states.front().t);
  ComparisonResult result = compare(first, second, config.lever_arm_b);
  if (result.summary.epochs == 0)
    throw InputError({config.second.string(), 0, "no epoch within the time of " + config.first.string(),
                      "trajectories that overlap", "Check the GPS weeks of both files."});
  return result;
}

std::vector<std::string> files_of(const ComparisonConfig&) {
  return {"differences.csv", "comparison.json"};
}

void write(const ComparisonConfig&, const ComparisonResult& result, const std::filesystem::path& folder) {
  io::begin_results(folder / "comparison.json");
  io::write_text(folder / "differences.csv", differences_csv(result));
  io::write_text(folder / "comparison.json", error_json(result.summary).dump(1) + "\n");
}

std::string told(const ComparisonConfig& config, const ComparisonResult& result, const std::filesystem::path&) {
  const study::ErrorSummary& s = result.summary;
  const auto three = [](const Eigen::Vector3d& v) { return fmt::format("{:.4f} {:.4f} {:.4f}", v.x(), v.y(), v.z()); };
  std::string text =
      fmt::format("{} epochs of {} compared, {} minus it, N E D\n", s.epochs, config.second.string(), config.first.string());
  text += fmt::format("position rms {} m, largest {} m\n", three(s.position.rms), three(s.position.max));
  if (s.velocity) text += fmt::format("velocity rms {} m/s\n", three(s.velocity->rms));
  if (s.attitude) text += fmt::format("attitude rms {} deg roll pitch yaw\n", three(s.attitude->rms / geo::kDegree));
  return text;
}

}  // namespace coast::jobs
