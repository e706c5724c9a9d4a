#include "synth/result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/page_parts.hpp"
#include "synth/config.hpp"

namespace coast::jobs {

namespace {

double ratio_to_best(const array::MergedChannel& channel) {
  const std::vector<double> own = own_sds(channel);
  return merged_sd(channel) / *std::ranges::min_element(own);
}

/// Mean over three channels.
double mean_of(const SynthResult& result, int first, double (*value)(const array::MergedChannel&)) {
  double sum = 0.0;
  for (int c = first; c < first + 3; ++c) sum += value(result.channels[static_cast<std::size_t>(c)]) / 3.0;
  return sum;
}

}  // namespace

std::string channel_name(int channel) {
  return fmt::format("{}_{}", channel < 3 ? "gyro" : "accel", "xyz"[channel % 3]);
}

std::vector<double> own_sds(const array::MergedChannel& channel) {
  const Eigen::VectorXd sd = channel.noise.variance.rowwise().mean().cwiseSqrt();
  return {sd.begin(), sd.end()};
}

double plain_sd(const array::MergedChannel& channel) {
  const std::vector<double> own = own_sds(channel);
  return std::sqrt(std::inner_product(own.begin(), own.end(), own.begin(), 0.0)) / static_cast<double>(own.size());
}

double merged_sd(const array::MergedChannel& channel) {
  return std::sqrt(channel.variance.mean());
}

record::ImuRecording synthetic_imu(const SynthResult& result) {
  const array::Signals& signals = result.assembly.levelled;
  record::ImuRecording imu;
  imu.source = "synthetic";
  imu.rate_hz = 1.0 / signals.dt;
  imu.samples.resize(signals.samples());
  for (std::size_t n = 0; n < imu.samples.size(); ++n) {
    const auto column = static_cast<Eigen::Index>(n);
    record::ImuSample& sample = imu.samples[n];
    sample.t = signals.start + static_cast<double>(n + 1) * signals.dt;
    sample.dt = signals.dt;
    for (int c = 0; c < 3; ++c) {
      const auto axis = static_cast<std::size_t>(c);
      sample.dtheta(c) = signals.dt * result.channels[axis].value(column);
      sample.dv(c) = signals.dt * result.channels[axis + 3].value(column);
    }
  }
  return imu;
}

std::string noise_csv(const SynthResult& result) {
  constexpr double kQuietest = 1e-9;  // filters do not accept a density of zero
  const array::Signals& signals = result.assembly.levelled;
  const std::size_t block = result.channels.front().noise.block;
  const std::size_t blocks = static_cast<std::size_t>(result.channels.front().noise.variance.cols());
  std::string text =
      "gps_week,sow_s,gyro_x_radps_rthz,gyro_y_radps_rthz,gyro_z_radps_rthz,"
      "accel_x_mps2_rthz,accel_y_mps2_rthz,accel_z_mps2_rthz\n";
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::size_t first = b * block;
    const std::size_t count = b + 1 == blocks ? signals.samples() - first : block;
    const geo::GpsTime t = signals.start + static_cast<double>(first) * signals.dt;
    text += fmt::format("{},{:.6f}", t.week(), t.sow());
    for (const array::MergedChannel& channel : result.channels) {
      const double variance =
          channel.variance.segment(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(count)).mean();
      text += fmt::format(",{:.6g}", std::max(std::sqrt(variance * signals.dt), kQuietest));
    }
    text += '\n';
  }
  return text;
}

std::vector<std::string> synth_sentences(const ArrayConfig& config, const SynthResult& result) {
  const array::Assembly& assembly = result.assembly;
  std::vector<std::string> text;
  text.push_back(fmt::format("{} IMUs, {:.1f} s in common, on a grid of {:.4g} Hz; merged: {}.", config.imus.size(),
                             static_cast<double>(assembly.signals.samples()) * assembly.signals.dt, 1.0 / assembly.signals.dt,
                             merge_name(config.merge.merge)));
  for (std::size_t k = 0; k < assembly.lags.size(); ++k)
    if (assembly.lags[k])
      text.push_back(fmt::format("{}: {:+.2f} +- {:.2f} ms and {:+.1f} ppm against {}.", config.imus[k].name,
                                 1e3 * assembly.lags[k]->offset_s, 1e3 * assembly.lags[k]->offset_sigma_s,
                                 assembly.lags[k]->drift_ppm, config.imus.front().name));
  text.push_back(fmt::format("Noise against the best single IMU: rates {:.2f}, specific forces {:.2f} (1/sqrt({}) = {:.2f}).",
                             mean_of(result, 0, ratio_to_best), mean_of(result, 3, ratio_to_best), config.imus.size(),
                             1.0 / std::sqrt(static_cast<double>(config.imus.size()))));
  for (const array::Defect& defect : assembly.defects.defects) {
    const auto at = [&](std::size_t n) { return static_cast<double>(n) * assembly.signals.dt; };
    text.push_back(fmt::format("{}: {} from {:.1f} to {:.1f} s, left out.", config.imus.at(defect.sensor).name,
                               array::name_of(defect.kind), at(defect.from), at(defect.to)));
  }
  return text;
}

}  // namespace coast::jobs
