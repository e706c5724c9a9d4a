// Signals of a recording that need more than one sample.

#include <algorithm>
#include <cmath>
#include <numeric>

#include "coast/diagnose/hypotheses.hpp"
#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"

namespace coast::diagnose {

namespace {

constexpr double kMeanOver = 0.1;       // s
constexpr double kVibrationOver = 1.0;  // s

Eigen::Vector3d force(const record::ImuSample& sample) {
  return sample.dv / sample.dt;
}

/// Variance about a mean over `half` samples on either side, applied twice, itself averaged over `long_half` on either side. Of
/// vibration at 15 Hz a mean over a tenth of a second leaves up to a fifth, of either sign, and the mean of means a
/// twentieth.
std::vector<Eigen::Vector3f> vibration_of(const record::ImuRecording& imu, std::size_t half, std::size_t long_half,
                                          const Eigen::Matrix3d& C_b_s) {
  const std::size_t n = imu.samples.size();
  const auto mean = [n](const std::vector<Eigen::Vector3d>& sums, std::size_t i, std::size_t reach) -> Eigen::Vector3d {
    const std::size_t from = i > reach ? i - reach : 0;
    const std::size_t to = std::min(n, i + reach + 1);
    return (sums[to] - sums[from]) / static_cast<double>(to - from);
  };
  std::vector<Eigen::Vector3d> sums(n + 1, Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < n; ++i) sums[i + 1] = sums[i] + C_b_s * force(imu.samples[i]);
  std::vector<Eigen::Vector3d> sums_of_means(n + 1, Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < n; ++i) sums_of_means[i + 1] = sums_of_means[i] + mean(sums, i, half);
  std::vector<Eigen::Vector3d> squares(n + 1, Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < n; ++i)
    squares[i + 1] = squares[i] + (C_b_s * force(imu.samples[i]) - mean(sums_of_means, i, half)).cwiseAbs2();
  std::vector<Eigen::Vector3f> vibration(n);
  for (std::size_t i = 0; i < n; ++i) vibration[i] = mean(squares, i, long_half).cast<float>();
  return vibration;
}

/// Slope of the line through the temperatures of a minute about each sample.
std::vector<float> temperature_rates(const record::ImuRecording& imu) {
  constexpr double kHalf = 30.0;  // s
  std::vector<float> rates(imu.temperature.size());
  std::size_t from = 0;
  std::size_t to = 0;
  for (std::size_t i = 0; i < rates.size(); ++i) {
    while (imu.samples[i].t - imu.samples[from].t > kHalf) ++from;
    while (to + 1 < rates.size() && imu.samples[to].t - imu.samples[i].t < kHalf) ++to;
    const double span = imu.samples[to].t - imu.samples[from].t;
    rates[i] = span > 0.0 ? static_cast<float>((imu.temperature[to] - imu.temperature[from]) / span) : 0.0F;
  }
  return rates;
}

}  // namespace

SignalTable::SignalTable(const record::ImuRecording& imu, const Eigen::Matrix3d& C_s_b)
    : imu_(imu),
      C_b_s_(C_s_b.transpose()),
      half_(std::max<std::size_t>(1, static_cast<std::size_t>(0.5 * kMeanOver * imu.rate_hz))),
      vibration_(vibration_of(imu, half_, static_cast<std::size_t>(0.5 * kVibrationOver * imu.rate_hz), C_b_s_)),
      temperature_rate_(temperature_rates(imu)) {
  if (has_temperature())
    mean_temperature_ =
        std::accumulate(imu.temperature.begin(), imu.temperature.end(), 0.0) / static_cast<double>(imu.temperature.size());
}

Signals SignalTable::at(std::size_t sample, const Eigen::Vector3d& omega_b, const Eigen::Vector3d& f_b,
                        const record::NavState& nav) const {
  const std::vector<record::ImuSample>& samples = imu_.samples;
  Signals s;
  s.omega = C_b_s_ * omega_b;
  s.f = C_b_s_ * f_b;
  const record::ImuSample& before = samples[sample > half_ ? sample - half_ : 0];
  const record::ImuSample& behind = samples[std::min(samples.size() - 1, sample + half_)];
  const double span = behind.t - before.t;
  s.omega_dot = Eigen::Vector3d::Zero();
  if (span > 0.0) s.omega_dot = C_b_s_ * (behind.dtheta / behind.dt - before.dtheta / before.dt) / span;
  s.vibration = vibration_[sample].cast<double>();
  s.coning = Eigen::Vector3d::Zero();
  if (sample > 0) s.coning = C_b_s_ * samples[sample - 1].dtheta.cross(samples[sample].dtheta) / (12.0 * samples[sample].dt);
  if (has_temperature()) {
    s.temperature = imu_.temperature[sample] - mean_temperature_;
    s.temperature_rate = temperature_rate_[sample];
  }
  s.elapsed = nav.t - samples.front().t;
  s.speed = nav.v_eb_e.norm();
  s.C_e_s = C_b_s_ * nav.q_b_e.toRotationMatrix().transpose();
  s.C_n_e = geo::C_n_e(geo::geodetic_from_ecef(nav.r_eb_e));
  return s;
}

SignalTable::Means SignalTable::means_about(std::size_t sample) const {
  const std::size_t from = sample > half_ ? sample - half_ : 0;
  const std::size_t to = std::min(imu_.samples.size(), sample + half_);
  Eigen::Vector3d turned = Eigen::Vector3d::Zero();
  Eigen::Vector3d gained = Eigen::Vector3d::Zero();
  double time = 0.0;
  for (std::size_t i = from; i < to; ++i) {
    turned += imu_.samples[i].dtheta;
    gained += imu_.samples[i].dv;
    time += imu_.samples[i].dt;
  }
  if (!(time > 0.0)) return {};
  return {turned / time, gained / time};
}

}  // namespace coast::diagnose
