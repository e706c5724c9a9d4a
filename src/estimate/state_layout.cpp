#include "coast/estimate/state_layout.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "coast/noise/gauss_markov.hpp"

namespace coast::estimate {

namespace {

constexpr std::array<char, 3> kAxis{'x', 'y', 'z'};

std::optional<int> signal_axis(noise::Input input, int axis) {
  switch (input) {
    case noise::Input::kOne:
      return std::nullopt;
    case noise::Input::kOwnAxis:
      return axis;
    case noise::Input::kNextAxis:
      return (axis + 1) % 3;
    case noise::Input::kPrevAxis:
      return (axis + 2) % 3;
  }
  return std::nullopt;
}

// Time constants of states: 1/beta of a Gauss-Markov process, 1/omega of an oscillation; infinity for constants, walks and
// ramps, whose transitions have no eigenvalue but 1.
double correlation_time(const noise::Process& process) {
  Eigen::MatrixXd Phi = Eigen::MatrixXd::Zero(process.states(), process.states());
  const double interval = std::max(1e-3, process.sample_interval().value_or(0.0));
  process.transition(interval, Phi);
  const double farthest = process.states() == 1 ? 1.0 - Phi(0, 0) : (Phi.eigenvalues().array() - 1.0).abs().maxCoeff();
  return farthest > 0.0 ? interval / farthest : std::numeric_limits<double>::infinity();
}

void add_white_noise(const noise::Process& process, const noise::Share& share, noise::Sensor sensor, int axis,
                     StateLayout::Member& member) {
  if (process.input() != noise::Input::kOne) return;
  const double density = process.white_density().value + process.as_white().value_or(geo::Psd{}).value;
  (sensor == noise::Sensor::kGyro ? member.gyro_density : member.accel_density)(axis) +=
      density / (share.weight * share.weight);
}

}  // namespace

StateLayout::StateLayout(const noise::ImuErrorModel& model, const Eigen::Matrix3d& C_s_b, const AuxiliaryStates& auxiliary)
    : shortest_time_(std::numeric_limits<double>::infinity()) {
  for (const std::string& name : model.members()) members_.push_back({.name = name});
  add_sensor(model, noise::Sensor::kGyro, C_s_b);
  add_sensor(model, noise::Sensor::kAccel, C_s_b);
  sensor_end_ = size_;
  if (auxiliary.lever_arm_sd_m > 0.0) lever_arm_ = add_auxiliary("lever_arm", auxiliary.lever_arm_sd_m, 0.0, 3);
  if (auxiliary.time_offset_sd_s > 0.0) time_offset_ = add_auxiliary("gnss_time_offset", auxiliary.time_offset_sd_s, 0.0, 1);
  if (auxiliary.mounting_sd > 0.0) mounting_ = add_auxiliary("vehicle_mounting", auxiliary.mounting_sd, 0.0, 2);
  if (auxiliary.base_offset_sd_m > 0.0) base_offset_ = add_auxiliary("base_offset", auxiliary.base_offset_sd_m, 0.0, 3);
  const CorrelatedGnss& gnss = auxiliary.correlated_gnss;
  if (gnss.horizontal_m > 0.0 || gnss.vertical_m > 0.0) {
    gnss_error_ = add_auxiliary("gnss_error_horizontal", gnss.horizontal_m, 1.0 / gnss.time_s, 2);
    add_auxiliary("gnss_error_vertical", gnss.vertical_m, 1.0 / gnss.time_s, 1);
  }
  for (const AuxiliaryStates::Aid& aid : auxiliary.aids) {
    aids_.push_back(size_);
    for (const AidState& state : aid.states)
      add_auxiliary(aid.name + "_" + state.name, state.sd, state.time_s > 0.0 ? 1.0 / state.time_s : 0.0, 1);
  }
  carrier_slots_ = size_;
  size_ += auxiliary.carrier_slots;
}

std::size_t StateLayout::member(const std::string& name) const {
  return static_cast<std::size_t>(std::ranges::find(members_, name, &Member::name) - members_.begin());
}

void StateLayout::add_sensor(const noise::ImuErrorModel& model, noise::Sensor sensor, const Eigen::Matrix3d& C_s_b) {
  const bool gyro = sensor == noise::Sensor::kGyro;
  Eigen::Vector3d density_s;
  for (int axis = 0; axis < 3; ++axis) {
    density_s(axis) = model.white_density(sensor, axis).value;
    for (const noise::ProcessPtr& process : model.axes(sensor)[static_cast<std::size_t>(axis)]) {
      const std::optional<noise::Share> share = process->share();
      if (share) add_white_noise(*process, *share, sensor, axis, members_[member(share->member)]);
      if (process->states() == 0 || process->as_white()) continue;
      SensorBlock block;
      block.process = process;
      block.offset = size_;
      block.size = process->states();
      block.name = fmt::format("{}_{} {}", gyro ? "gyro" : "accel", kAxis[static_cast<std::size_t>(axis)], process->name());
      block.output = Eigen::RowVectorXd::Zero(block.size);
      process->output(block.output);
      block.sensor = sensor;
      block.response_b = C_s_b.col(axis);
      block.axis = axis;
      block.signal_axis = signal_axis(process->input(), axis);
      if (block.signal_axis) block.signal_b = C_s_b.col(*block.signal_axis);
      if (share) {
        block.name += " of " + share->member;
        block.member = member(share->member);
        block.own_output = block.output / std::abs(share->weight);
      }
      size_ += block.size;
      shortest_time_ = std::min(shortest_time_, correlation_time(*process));
      sensors_.push_back(std::move(block));
    }
  }
  (gyro ? gyro_noise_b_ : accel_noise_b_) = C_s_b * density_s.cwiseSqrt().asDiagonal();
}

int StateLayout::add_auxiliary(const std::string& name, double sigma, double beta, int count) {
  const int first = size_;
  for (int i = 0; i < count; ++i) {
    Block block;
    block.process = noise::make_gauss_markov({.name = "auxiliary", .sigma = sigma, .beta = beta, .unit = ""});
    block.offset = size_++;
    block.size = 1;
    block.output = Eigen::RowVectorXd::Ones(1);
    block.name = count > 1 ? fmt::format("{}_{}", name, i) : name;
    auxiliaries_.push_back(std::move(block));
  }
  return first;
}

Eigen::MatrixXd StateLayout::initial_covariance() const {
  Eigen::MatrixXd P = Eigen::MatrixXd::Zero(size_, size_);
  for_each_block([&](const Block& b) { b.process->initial_covariance(P.block(b.offset, b.offset, b.size, b.size)); });
  return P;
}

Eigen::VectorXd StateLayout::mean(double elapsed) const {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(size_);
  for_each_block([&](const Block& b) { b.process->initial_mean(x.segment(b.offset, b.size)); });
  if (elapsed > 0.0) BlockTransitions(*this).over(elapsed).apply(x.tail(size_ - kNav));
  return x;
}

BlockTransitions::BlockTransitions(const StateLayout& layout)
    : layout_(layout), diagonal_(Eigen::VectorXd::Ones(layout.size() - kNav)) {
  int widest = 1;
  layout.for_each_block([&](const StateLayout::Block& b) {
    if (b.size > 1) dense_.push_back({b.offset - kNav, Eigen::MatrixXd::Zero(b.size, b.size)});
    widest = std::max(widest, b.size);
  });
  Q_d_ = Eigen::MatrixXd::Zero(diagonal_.size(), widest);
}

const BlockTransitions& BlockTransitions::over(double dt, bool renews_gnss_error) {
  // Time tags are rounded to a nanosecond.
  if (std::abs(dt - dt_) < 1e-9 && renews_gnss_error == renews_gnss_error_) return *this;
  dt_ = dt;
  renews_gnss_error_ = renews_gnss_error;
  auto dense = dense_.begin();
  layout_.for_each_block([&](const StateLayout::Block& b) {
    const int row = b.offset - kNav;
    if (b.size > 1)
      b.process->transition(dt, (dense++)->Phi);
    else
      b.process->transition(dt, diagonal_.segment<1>(row));
    b.process->driving_noise(dt, Q_d_.block(row, 0, b.size, b.size));
    if (!renews_gnss_error || !layout_.is_gnss_error(b.offset)) return;
    diagonal_(row) = 0.0;
    b.process->initial_covariance(Q_d_.block(row, 0, 1, 1));  // stationary
  });
  return *this;
}

void BlockTransitions::apply(Eigen::Ref<Eigen::MatrixXd> M) const {
  M.array().colwise() *= diagonal_.array();
  for (const Dense& d : dense_) M.middleRows(d.row, d.Phi.rows()) = (d.Phi * M.middleRows(d.row, d.Phi.rows())).eval();
}

void BlockTransitions::apply_transposed(Eigen::Ref<Eigen::MatrixXd> M) const {
  M.array().colwise() *= diagonal_.array();
  for (const Dense& d : dense_)
    M.middleRows(d.row, d.Phi.rows()) = (d.Phi.transpose() * M.middleRows(d.row, d.Phi.rows())).eval();
}

void BlockTransitions::apply_to_row(Eigen::Ref<Eigen::RowVectorXd> row) const {
  row.array() *= diagonal_.head(row.size()).transpose().array();
  for (const Dense& d : dense_)
    if (d.row < row.size()) row.segment(d.row, d.Phi.rows()) = (row.segment(d.row, d.Phi.rows()) * d.Phi).eval();
}

void BlockTransitions::propagate(Eigen::Ref<Eigen::MatrixXd> P) const {
  P.array().colwise() *= diagonal_.array();
  P.array().rowwise() *= diagonal_.transpose().array();
  for (const Dense& d : dense_) {
    const auto size = d.Phi.rows();
    P.middleRows(d.row, size) = (d.Phi * P.middleRows(d.row, size)).eval();
    P.middleCols(d.row, size) = (P.middleCols(d.row, size) * d.Phi.transpose()).eval();
  }
  layout_.for_each_block(
      [&](const StateLayout::Block& b) { P.block(b.offset - kNav, b.offset - kNav, b.size, b.size) += driving_noise(b); });
}

}  // namespace coast::estimate
