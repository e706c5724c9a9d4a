#include "coast/study/bias_drift.hpp"

#include <algorithm>
#include <cmath>

#include "coast/noise/gauss_markov.hpp"

namespace coast::study {
namespace {

bool drifts(const noise::Process& process) {
  return process.name() == "gauss_markov" && process.input() == noise::Input::kOne && process.states() == 1 && !process.share();
}

double stationary_sd(const noise::Process& process) {
  Eigen::MatrixXd P(1, 1);
  process.initial_covariance(P);
  return std::sqrt(P(0, 0));
}

noise::ProcessPtr scaled(const noise::Process& process, noise::Sensor sensor, double factor) {
  Eigen::MatrixXd Phi(1, 1);
  process.transition(1.0, Phi);
  return noise::make_gauss_markov({.name = "gauss_markov",
                                   .sigma = factor * stationary_sd(process),
                                   .beta = -std::log(Phi(0, 0)),
                                   .unit = sensor == noise::Sensor::kGyro ? "rad/s" : "m/s^2"});
}

}  // namespace

DriftFactors drift_seen(const estimate::StateLayout& layout, const std::vector<estimate::SmoothedKnot>& knots, double least) {
  DriftFactors factors;
  for (const auto& block : layout.sensors()) {
    if (!drifts(*block.process) || stationary_sd(*block.process) == 0.0) continue;
    double squares = 0.0, n = 0.0;
    for (const estimate::SmoothedKnot& knot : knots) {
      if (knot.x.size() == 0) continue;
      squares += knot.x(block.offset) * knot.x(block.offset) + knot.sd(block.offset) * knot.sd(block.offset);
      n += 1.0;
    }
    const double factor = n > 0.0 ? std::sqrt(squares / n) / stationary_sd(*block.process) : 1.0;
    double& of_axis = (block.sensor == noise::Sensor::kGyro ? factors.gyro : factors.accel)(block.axis);
    if (factor > least) of_axis = std::max(of_axis, factor);
  }
  return factors;
}

noise::ImuErrorModel with_drift_scaled(const noise::ImuErrorModel& model, double rate_hz, const DriftFactors& factors) {
  const auto of = [&](noise::Sensor sensor) {
    auto axes = model.axes(sensor);
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
      const double factor = (sensor == noise::Sensor::kGyro ? factors.gyro : factors.accel)(static_cast<Eigen::Index>(axis));
      if (factor == 1.0) continue;
      for (noise::ProcessPtr& process : axes[axis])
        if (drifts(*process)) process = scaled(*process, sensor, factor);
    }
    return axes;
  };
  return noise::ImuErrorModel::of(model.sensor_name(), rate_hz, of(noise::Sensor::kGyro), of(noise::Sensor::kAccel));
}

}  // namespace coast::study
