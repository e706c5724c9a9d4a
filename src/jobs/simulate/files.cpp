// Output files and messages of `coast simulate`.

#include <fmt/format.h>

#include "coast/io/results_folder.hpp"
#include "coast/io/rinex.hpp"
#include "coast/io/writers.hpp"
#include "coast/jobs/simulate.hpp"

namespace coast::jobs {

namespace {

std::string list(const Eigen::Vector3d& v) {
  return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v.x(), v.y(), v.z());
}

std::string axis_name(const Eigen::Vector3d& row) {
  Eigen::Index axis = 0;
  row.cwiseAbs().maxCoeff(&axis);
  return fmt::format("{}{}", row(axis) < 0.0 ? "-" : "", "xyz"[axis]);
}

std::string aid_file(const simulate::Scenario& scenario, std::size_t index) {
  return scenario.aids.size() == 1 ? scenario.aids[index].name() + ".csv"
                                   : fmt::format("{}_{}.csv", scenario.aids[index].name(), index + 1);
}

// The run.yaml that processes the recording, in the same folder.
std::string run_yaml(const simulate::Scenario& scenario, const simulate::SimulatedMission& mission, const std::string& gnss) {
  const Eigen::Matrix3d& axes = scenario.mounting.axes;
  std::string text = fmt::format(
      "schema: coast.run/1\n"
      "imu:\n"
      "  file: imu.csv\n"
      "  format: csv\n"
      "  gps_week: {}\n"
      "  error_model: error_model.yaml\n"
      "  lever_arm_m: {}\n"
      "  axes: [{}, {}, {}]\n"
      "  mounting_deg: {}\n"
      "gnss: {}\n"
      "reference: {{file: truth.nav, format: nav}}\n",
      scenario.start.week(), list(scenario.gnss.lever_arm_b), axis_name(axes.row(0)), axis_name(axes.row(1)),
      axis_name(axes.row(2)), list(scenario.mounting.mounting / geo::kDegree), gnss);
  if (!scenario.aids.empty()) text += "aids:\n";
  for (std::size_t k = 0; k < scenario.aids.size(); ++k)
    text += fmt::format("  - {{kind: {}, file: {}, {}}}\n", scenario.aids[k].name(), aid_file(scenario, k),
                        scenario.aids[k].run_keys());
  if (mission.outages.empty()) return text;
  text += "outages:\n";
  for (const simulate::StudiedOutage& outage : mission.outages)
    text += fmt::format("  - {{start_s: {:.9f}, duration_s: {:.17g}}}\n", outage.start.sow(), outage.duration);
  return text;
}

std::string positions_yaml(const simulate::Scenario& scenario) {
  return fmt::format("{{file: gnss.pos, format: rtklib-pos, time_offset_s: {:.17g}}}", scenario.gnss.time_offset);
}

// RINEX of rover and base, and the run file that first solves them: run-rinex.yaml.
void write_observations(const simulate::Scenario& scenario, const simulate::SimulatedMission& mission,
                        const simulate::SimulatedObservations& observed, const std::filesystem::path& out) {
  io::write_observations(out / "rover.obs", observed.rover);
  io::write_observations(out / "base.obs", observed.base);
  io::write_navigation(out / "brdc.nav", observed.navigation);
  io::write_text(
      out / "run-rinex.yaml",
      run_yaml(scenario, mission,
               fmt::format("{{ppk: {{rover: rover.obs, base: base.obs, nav: [brdc.nav], base_position: {{ecef_m: {}}}}}}}",
                           list(observed.r_base_e))));
}

// The recordings of an array, each in its own axes and with its own clock, and the array.yaml that merges them. The true
// mounting is stated; clocks are to be estimated.
void write_array(const simulate::Scenario& scenario, const std::vector<record::ImuRecording>& recordings,
                 const std::filesystem::path& out) {
  if (scenario.array.empty()) return;
  std::string text = "schema: coast.array/1\nimus:\n";
  for (std::size_t k = 0; k < scenario.array.size(); ++k) {
    const simulate::Scenario::ArrayImu& imu = scenario.array[k];
    const std::string file = fmt::format("imu_{}.csv", imu.name);
    io::write_imu_csv(out / file, recordings[k]);
    const std::string model = fmt::format("error_model_{}.yaml", imu.name);
    io::write_text(out / model, imu.error_model.yaml());
    const Eigen::Matrix3d& axes = imu.mounting.axes;
    text += fmt::format(
        "  - {{name: {}, file: {}, gps_week: {}, axes: [{}, {}, {}], mounting_deg: {}, position_m: {}, error_model: {}}}\n",
        imu.name, file, scenario.start.week(), axis_name(axes.row(0)), axis_name(axes.row(1)), axis_name(axes.row(2)),
        list(imu.mounting.mounting / geo::kDegree), list(imu.position_b), model);
  }
  io::write_text(out / "array.yaml", text);
}

}  // namespace

std::vector<std::string> files_of(const SimulationConfig& config) {
  const simulate::Scenario& scenario = config.scenario;
  std::vector<std::string> files{"imu.csv", "gnss.pos", "truth.nav", "error_model.yaml", "run.yaml"};
  if (scenario.observations) files.insert(files.end(), {"rover.obs", "base.obs", "brdc.nav", "run-rinex.yaml"});
  for (std::size_t k = 0; k < scenario.aids.size(); ++k) files.push_back(aid_file(scenario, k));
  if (scenario.array.empty()) return files;
  for (const simulate::Scenario::ArrayImu& imu : scenario.array)
    files.insert(files.end(), {fmt::format("imu_{}.csv", imu.name), fmt::format("error_model_{}.yaml", imu.name)});
  files.emplace_back("array.yaml");
  return files;
}

void write(const SimulationConfig& config, const SimulationResult& result, const std::filesystem::path& folder) {
  const simulate::Scenario& scenario = config.scenario;
  const simulate::SimulatedMission& mission = result.mission;
  io::begin_results(folder / "run.yaml");
  io::write_imu_csv(folder / "imu.csv", mission.imu);
  io::write_gnss_pos(folder / "gnss.pos", mission.gnss);
  const auto truth = io::trajectory_format("nav").make(folder / "truth.nav", {});
  for (const record::NavState& nav : mission.truth.states) truth->write({nav, {}});
  truth->close();
  io::write_text(folder / "error_model.yaml", scenario.error_model->yaml());
  if (result.observations) write_observations(scenario, mission, *result.observations, folder);
  write_array(scenario, result.array, folder);
  for (std::size_t k = 0; k < scenario.aids.size(); ++k)
    io::write_aid_csv(folder / aid_file(scenario, k), result.aids[k], scenario.aids[k].column());
  io::write_text(folder / "run.yaml", run_yaml(scenario, mission, positions_yaml(scenario)));
}

std::string told(const SimulationConfig&, const SimulationResult& result, const std::filesystem::path& folder) {
  return fmt::format("{} IMU samples, {} fixes; process them with\n  coast process {}\n", result.mission.imu.samples.size(),
                     result.mission.gnss.fixes.size(), (folder / "run.yaml").string());
}

}  // namespace coast::jobs
