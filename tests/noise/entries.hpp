#pragma once
// How the tests of this room make processes and models from text.

#include <string>
#include <vector>

#include "coast/io/yaml.hpp"
#include "coast/noise/error_model.hpp"
#include "coast/noise/process.hpp"

namespace coast::test {

inline std::vector<noise::ProcessPtr> processes_of(const std::string& entry, noise::Sensor sensor, double rate_hz = 0.0) {
  const config::Node file = io::parse_yaml("entry: " + entry + "\n", "entry.yaml");
  return noise::make_processes(file.at("entry"), {sensor, rate_hz});
}

inline noise::ProcessPtr process_of(const std::string& entry, noise::Sensor sensor, double rate_hz = 0.0) {
  return processes_of(entry, sensor, rate_hz).front();
}

inline noise::ImuErrorModel model_of(const std::string& text) {
  return noise::ImuErrorModel::from(io::parse_yaml(text, "model.yaml"));
}

/// Phi and Q_d over dt, the output and the start of a process, as plain matrices.
struct Block {
  Eigen::MatrixXd Phi, Q_d, P;
  Eigen::RowVectorXd h;
  Eigen::VectorXd mean;
};
inline Block block_of(const noise::Process& process, double dt) {
  const int n = process.states();
  Block block{Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(n, n),
              Eigen::RowVectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
  process.transition(dt, block.Phi);
  process.driving_noise(dt, block.Q_d);
  process.initial_covariance(block.P);
  process.output(block.h);
  process.initial_mean(block.mean);
  return block;
}

}  // namespace coast::test
