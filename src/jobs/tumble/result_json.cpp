// tumble.json: what a multi-position calibration found. SI.

#include <cmath>
#include <nlohmann/json.hpp>

#include "common/error_json.hpp"
#include "tumble/result.hpp"

namespace coast::jobs {

namespace {

using Json = nlohmann::ordered_json;
using record::ImuCalibration;

Json matrix_json(const Eigen::Matrix3d& m) {
  Json rows = Json::array();
  for (Eigen::Index row = 0; row < 3; ++row) rows.push_back(array_json(m.row(row).transpose()));
  return rows;
}

Json triad_json(const ImuCalibration& calibration, const record::TriadErrors& triad, int at) {
  Eigen::Matrix3d gain_sd;
  Eigen::Vector3d bias_sd;
  for (int row = 0; row < 3; ++row) {
    bias_sd[row] = calibration.bias_sd(at, row);
    for (int column = 0; column < 3; ++column) gain_sd(row, column) = calibration.gain_sd(at, row, column);
  }
  return {{"bias", array_json(triad.bias)},
          {"bias_sd", array_json(bias_sd)},
          {"gain", matrix_json(triad.gain)},
          {"gain_sd", matrix_json(gain_sd)}};
}

}  // namespace

std::string tumble_json(const TumbleConfig& config, const TumbleResult& result) {
  const tumble::Result& found = result.calibration;
  Json j = {{"schema", "coast.tumble_result/1"},
            {"sensor", config.sensor},
            {"source", result.source},
            {"rate_hz", result.rate_hz},
            {"duration_s", result.duration},
            {"events", events_json(result.events)},
            {"gravity_mps2", found.gravity},
            {"gravity_sd_mps2", found.gravity_sd},
            {"accel", triad_json(found.calibration, found.calibration.accel, ImuCalibration::kAccel)},
            {"gyro", triad_json(found.calibration, found.calibration.gyro, ImuCalibration::kGyro)}};
  j["levels"] = {{"accel_mps2", found.levels.accel},
                 {"turn_rad_per_rad", found.levels.turn},
                 {"gyro_walk_radps_per_sqrt_s", found.levels.gyro_walk}};
  j["redundancy"] = found.redundancy;
  if (found.heading_sd) j["heading_sd_rad"] = *found.heading_sd;
  j["rests"] = Json::array();
  for (const tumble::RestFit& rest : found.rests)
    j["rests"].push_back({{"from_s", rest.rest.from},
                          {"to_s", rest.rest.to},
                          {"up", array_json(rest.up)},
                          {"accel_residual_mps2", array_json(rest.accel_residual)},
                          {"gyro_bias_radps", array_json(rest.gyro_bias)},
                          {"chi_square", rest.chi_square},
                          {"used", rest.used}});
  j["turns"] = Json::array();
  for (const tumble::TurnFit& turn : found.turns)
    j["turns"].push_back({{"after_rest", turn.rest},
                          {"duration_s", turn.duration},
                          {"turned_rad", turn.turned},
                          {"residual_rad", array_json(turn.residual)},
                          {"chi_square", turn.chi_square},
                          {"used", turn.used}});
  j["next_poses"] = Json::array();
  for (const tumble::Proposal& proposal : result.next)
    j["next_poses"].push_back({{"up", array_json(proposal.up)},
                               {"in_words", direction_text(proposal.up)},
                               {"information_nats", proposal.information},
                               {"largest_gain_sd", proposal.largest_gain_sd}});
  j["files"] = {{"calibration", "imu_calibration.yaml"}, {"report", "report.html"}};
  return j.dump(1) + "\n";
}

}  // namespace coast::jobs
