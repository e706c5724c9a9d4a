#include "coast/noise/error_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coast/config/quoted.hpp"
#include "coast/noise/gauss_markov.hpp"
#include "coast/noise/share.hpp"
#include "processes/processes.hpp"

namespace coast::noise {

namespace {

constexpr std::array<std::string_view, 3> kAxisNames{"x", "y", "z"};

std::vector<ProcessPtr> read_list(const config::Node& list, const EntryContext& context) {
  std::vector<ProcessPtr> processes;
  for (const config::Node& entry : list.items())
    for (ProcessPtr& process : make_processes(entry, context)) processes.push_back(std::move(process));
  return processes;
}

// An entry for an axis replaces `all` for it.
ImuErrorModel::Axes read_sensor(const config::Node& node, const EntryContext& context) {
  ImuErrorModel::Axes axes;
  const auto all = node.find("all");
  for (std::size_t i = 0; i < 3; ++i) {
    const auto own = node.find(kAxisNames[i]);
    if (!own && !all) throw node.error(fmt::format("no processes for axis {}", kAxisNames[i]), "`all` or every one of x, y, z");
    axes[i] = read_list(own ? *own : *all, context);
  }
  return axes;
}

}  // namespace

ImuErrorModel ImuErrorModel::from(const config::Node& file) {
  const config::Node schema = file.at("schema");
  if (schema.text() != "coast.imu_error_model/1") throw schema.error("schema " + schema.text(), "coast.imu_error_model/1");
  ImuErrorModel model;
  model.sensor_name_ = file.text("sensor", "unnamed");
  if (const auto rate = file.find("rate_hz")) {
    model.rate_hz_ = rate->number();
    if (!(model.rate_hz_ > 0.0)) throw rate->error(rate->text(), "a rate above zero");
  }
  model.gyro_ = read_sensor(file.at("gyro"), {Sensor::kGyro, model.rate_hz_});
  model.accel_ = read_sensor(file.at("accel"), {Sensor::kAccel, model.rate_hz_});
  file.refuse_unasked();
  return model;
}

ImuErrorModel ImuErrorModel::of(std::string sensor_name, double rate_hz, Axes gyro, Axes accel) {
  ImuErrorModel model;
  model.sensor_name_ = std::move(sensor_name);
  model.rate_hz_ = rate_hz;
  model.gyro_ = std::move(gyro);
  model.accel_ = std::move(accel);
  return model;
}

namespace {

double white_for_filter(const Process& process) {
  return process.white_density().value + process.as_white().value_or(geo::Psd{}).value;
}

}  // namespace

geo::Psd ImuErrorModel::white_density(Sensor sensor, int axis) const {
  geo::Psd sum;
  for (const ProcessPtr& process : axes(sensor)[static_cast<std::size_t>(axis)])
    if (process->input() == Input::kOne) sum.value += white_for_filter(*process);
  return sum;
}

double ImuErrorModel::bias_sd(Sensor sensor, int axis) const {
  double variance = 0.0;
  for (const ProcessPtr& process : axes(sensor)[static_cast<std::size_t>(axis)]) {
    if (process->states() == 0 || process->input() != Input::kOne || process->as_white()) continue;
    Eigen::MatrixXd P = Eigen::MatrixXd::Zero(process->states(), process->states());
    Eigen::RowVectorXd h = Eigen::RowVectorXd::Zero(process->states());
    process->initial_covariance(P);
    process->output(h);
    variance += (h * P * h.transpose()).value();
  }
  return std::sqrt(variance);
}

std::vector<std::string> ImuErrorModel::members() const {
  std::vector<std::string> names;
  for (const Axes* sensor : {&gyro_, &accel_})
    for (const auto& axis : *sensor)
      for (const ProcessPtr& process : axis)
        if (const auto share = process->share(); share && !std::ranges::count(names, share->member))
          names.push_back(share->member);
  return names;
}

ImuErrorModel ImuErrorModel::with_white_noise_scaled(Sensor sensor, const Eigen::Vector3d& factors) const {
  ImuErrorModel scaled = *this;
  for (int axis = 0; axis < 3; ++axis) {
    if (factors(axis) == 1.0) continue;  // a process that rounds its samples is kept
    for (ProcessPtr& process : (sensor == Sensor::kGyro ? scaled.gyro_ : scaled.accel_)[static_cast<std::size_t>(axis)])
      if (const double density = white_for_filter(*process); density > 0.0) {
        const std::optional<Share> share = process->share();
        const double own = std::sqrt(density) / (share ? std::abs(share->weight) : 1.0);
        process = make_white_noise(own * factors(axis), sensor);
        if (share) process = make_share(process, share->member, share->weight, sensor);
      }
  }
  return scaled;
}

namespace {

// Standard deviation of the state of a constant gain error; nothing for any other process.
std::optional<double> constant_gain_sd(const Process& process) {
  if (process.input() == Input::kOne || process.states() != 1 || process.share()) return {};
  Eigen::MatrixXd Phi(1, 1), P(1, 1);
  process.transition(1.0, Phi);
  process.initial_covariance(P);
  if (Phi(0, 0) != 1.0) return {};
  return std::sqrt(P(0, 0));
}

}  // namespace

ImuErrorModel ImuErrorModel::with_gains_known(const record::ImuCalibration& calibration) const {
  constexpr double kRemains = 0.1;
  ImuErrorModel known = *this;
  for (const Sensor sensor : {Sensor::kGyro, Sensor::kAccel})
    for (int axis = 0; axis < 3; ++axis)
      for (ProcessPtr& process : (sensor == Sensor::kGyro ? known.gyro_ : known.accel_)[static_cast<std::size_t>(axis)]) {
        const std::optional<double> stated = constant_gain_sd(*process);
        if (!stated) continue;
        const Input input = process->input();
        const int other = input == Input::kOwnAxis ? axis : (axis + (input == Input::kNextAxis ? 1 : 2)) % 3;
        const int triad = sensor == Sensor::kGyro ? record::ImuCalibration::kGyro : record::ImuCalibration::kAccel;
        const double sd = std::min(*stated, std::hypot(calibration.gain_sd(triad, axis, other), kRemains * *stated));
        process = make_gauss_markov({.name = input == Input::kOwnAxis ? "scale_factor" : "misalignment",
                                     .input = input,
                                     .sigma = sd,
                                     .beta = 0.0,
                                     .unit = input == Input::kOwnAxis ? "ppm" : "rad"});
      }
  return known;
}

std::string ImuErrorModel::yaml() const {
  std::string text = fmt::format("schema: coast.imu_error_model/1\nsensor: {}\n", config::quoted(sensor_name_));
  if (rate_hz_ > 0.0) text += fmt::format("rate_hz: {:.17g}\n", rate_hz_);
  for (const Sensor sensor : {Sensor::kGyro, Sensor::kAccel}) {
    text += sensor == Sensor::kGyro ? "gyro:\n" : "accel:\n";
    for (std::size_t i = 0; i < 3; ++i) {
      text += fmt::format("  {}:\n", kAxisNames[i]);
      const Process* last_misalignment = nullptr;
      for (const ProcessPtr& process : axes(sensor)[i]) {
        // A misalignment entry creates both of its angles.
        if (process->input() == Input::kPrevAxis && last_misalignment != nullptr) continue;
        last_misalignment = process->input() == Input::kNextAxis ? process.get() : nullptr;
        text += fmt::format("    - {}\n", process->yaml());
      }
      if (axes(sensor)[i].empty()) text.insert(text.size() - 1, " []");
    }
  }
  return text;
}

}  // namespace coast::noise
