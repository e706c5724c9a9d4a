#include <algorithm>
#include <cmath>

#include "sample_effects/sample_effects.hpp"

namespace coast::diagnose {

const std::vector<SampleEffect>& sample_catalogue() {
  static const std::vector<SampleEffect> effects{
      saturation(Site::kGyro),
      saturation(Site::kAccel),
      quantisation(Site::kGyro),
      quantisation(Site::kAccel),
  };
  return effects;
}

AxisSeries axis_series(const MissionInput& input, Site site, int axis) {
  AxisSeries series;
  const std::vector<record::ImuSample>& samples = input.imu.samples;
  const Eigen::RowVector3d row = input.setup.C_s_b.transpose().row(axis);
  series.values.resize(static_cast<Eigen::Index>(samples.size()));
  for (std::size_t i = 0; i < samples.size(); ++i)
    series.values(static_cast<Eigen::Index>(i)) =
        row.dot(site == Site::kGyro ? samples[i].dtheta : samples[i].dv) / samples[i].dt;
  series.white_sd = std::sqrt(input.setup.model.white_density(sensor_of(site), axis).value * input.imu.rate_hz);
  for (const noise::ProcessPtr& process : input.setup.model.axes(sensor_of(site))[static_cast<std::size_t>(axis)])
    series.rounding_stated = series.rounding_stated || process->rounding().has_value();
  return series;
}

void raise_noise(MissionInput& input, Site site, int axis, const std::vector<RaisedNoise>& stretches) {
  const double stated = input.setup.model.white_density(sensor_of(site), axis).value;
  if (!(stated > 0.0)) return;
  // Begins and ends of levels: the existing and the new ones.
  std::vector<geo::GpsTime> edges{input.imu.samples.front().t - input.imu.samples.front().dt, input.imu.samples.back().t};
  for (const record::NoiseLevel& level : input.imu.noise) edges.insert(edges.end(), {level.from, level.to});
  for (const RaisedNoise& one : stretches) edges.insert(edges.end(), {one.from, one.to});
  std::ranges::sort(edges);
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  const std::vector<record::NoiseLevel> before = std::move(input.imu.noise);
  input.imu.noise.clear();
  auto old = before.begin();
  auto raised = stretches.begin();
  for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
    record::NoiseLevel level{.from = edges[k], .to = edges[k + 1]};
    while (old != before.end() && old->to <= level.from) ++old;
    while (raised != stretches.end() && raised->to <= level.from) ++raised;
    if (old != before.end() && old->from <= level.from) {
      level.gyro = old->gyro;
      level.accel = old->accel;
    }
    if (raised != stretches.end() && raised->from <= level.from)
      (site == Site::kGyro ? level.gyro : level.accel)(axis) += raised->density / stated;
    input.imu.noise.push_back(level);
  }
}

}  // namespace coast::diagnose
