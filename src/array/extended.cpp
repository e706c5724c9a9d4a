#include "coast/array/extended.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "coast/geo/units.hpp"
#include "coast/noise/share.hpp"

namespace coast::array {

namespace {

constexpr noise::Sensor sensor_of(int channel) {
  return channel < 3 ? noise::Sensor::kGyro : noise::Sensor::kAccel;
}

/// The sensor's axis along an axis of the body.
struct Along {
  int axis = 0;
  double sign = 1.0;
};
Along along(const ModelledSensor& sensor, int body_axis) {
  Eigen::Index axis = 0;
  const double cosine = sensor.C_s_b.row(body_axis).cwiseAbs().maxCoeff(&axis);
  if (cosine < std::cos(kMostTilt))
    throw std::invalid_argument(
        fmt::format("{} is tilted against the body by {:.0f} deg or more; each sensor's own error states "
                    "need axes along the body's",
                    sensor.name, kMostTilt / geo::kDegree));
  return {static_cast<int>(axis), sensor.C_s_b(body_axis, axis) > 0.0 ? 1.0 : -1.0};
}

/// A scale factor keeps its sign: its input signal changes sign with the axis. The two misalignments of an axis have the same
/// distribution, symmetric in sign, so their order does not matter if axes are exchanged.
double sign_of(const noise::Process& process, const Along& own) {
  return process.input() == noise::Input::kOne ? own.sign : 1.0;
}

}  // namespace

Eigen::MatrixXd extended_weights(std::span<const ModelledSensor> sensors) {
  Eigen::MatrixXd weights(kChannels, static_cast<Eigen::Index>(sensors.size()));
  for (int c = 0; c < kChannels; ++c) {
    for (std::size_t k = 0; k < sensors.size(); ++k) {
      const double density = sensors[k].model->white_density(sensor_of(c), along(sensors[k], c % 3).axis).value;
      if (!(density > 0.0))
        throw std::invalid_argument(fmt::format("the error model of {} has an axis without white noise", sensors[k].name));
      weights(c, static_cast<Eigen::Index>(k)) = 1.0 / density;
    }
    weights.row(c) /= weights.row(c).sum();
  }
  return weights;
}

noise::ImuErrorModel extended_error_model(const std::string& name, double rate_hz, std::span<const ModelledSensor> sensors) {
  const Eigen::MatrixXd weights = extended_weights(sensors);
  std::array<noise::ImuErrorModel::Axes, 2> axes;
  for (int c = 0; c < kChannels; ++c)
    for (std::size_t k = 0; k < sensors.size(); ++k) {
      const Along own = along(sensors[k], c % 3);
      const double weight = weights(c, static_cast<Eigen::Index>(k));
      for (const noise::ProcessPtr& process : sensors[k].model->axes(sensor_of(c))[static_cast<std::size_t>(own.axis)])
        axes.at(c < 3 ? 0 : 1)
            .at(static_cast<std::size_t>(c % 3))
            .push_back(noise::make_share(process, sensors[k].name, weight * sign_of(*process, own), sensor_of(c)));
    }
  return noise::ImuErrorModel::of(name, rate_hz, std::move(axes[0]), std::move(axes[1]));
}

Eigen::VectorXd with_offsets(const Signals& signals, const Signals& levelled, int channel, const Eigen::VectorXd& levelled_sum,
                             const Eigen::Ref<const Eigen::VectorXd>& weights) {
  Eigen::VectorXd sum = levelled_sum;
  for (std::size_t k = 0; k < signals.sensors.size(); ++k)
    sum += weights(static_cast<Eigen::Index>(k)) *
           (signals.sensors[k].values.row(channel) - levelled.sensors[k].values.row(channel)).transpose();
  return sum;
}

record::MemberBlocks member_blocks(const Signals& signals, double block_s) {
  record::MemberBlocks members;
  for (const SensorSignals& sensor : signals.sensors) members.names.push_back(sensor.name);
  const auto block = static_cast<std::size_t>(std::max(1.0, std::round(block_s / signals.dt)));
  for (std::size_t first = 0; first + block <= signals.samples(); first += block) {
    const geo::GpsTime from = signals.start + static_cast<double>(first) * signals.dt;
    record::MemberBlocks::Block& next =
        members.blocks.emplace_back(record::MemberBlocks::Block{from, from + static_cast<double>(block) * signals.dt, {}});
    for (const SensorSignals& sensor : signals.sensors) {
      const auto begin = sensor.usable.begin() + static_cast<std::ptrdiff_t>(first);
      const bool whole = std::all_of(begin, begin + static_cast<std::ptrdiff_t>(block),
                                     [](std::uint8_t usable) { return usable == kAllUsable; });
      next.means.emplace_back();
      if (!whole) continue;
      const Channels mean =
          sensor.values.middleCols(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(block)).rowwise().mean();
      next.means.back() = record::MemberBlocks::Means{mean.head<3>(), mean.tail<3>()};
    }
  }
  return members;
}

}  // namespace coast::array
