#include "coast/array/remaining.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "coast/array/channel.hpp"
#include "coast/noise/estimators.hpp"
#include "coast/noise/gauss_markov.hpp"

namespace coast::array {

namespace {

constexpr std::size_t kFewestAverages = 50;

/// Offsets from the mean of all in one channel, averaged: one record per sensor.
std::vector<noise::StaticSignal> averaged_residuals(const Signals& signals, int channel, std::size_t block) {
  const Eigen::MatrixXd y = residuals(signals, channel);
  std::vector<noise::StaticSignal> records(signals.sensors.size());
  for (noise::StaticSignal& record : records) record.interval = static_cast<double>(block) * signals.dt;
  bool open = false;
  for (std::size_t b = 0; (b + 1) * block <= signals.samples(); ++b) {
    bool whole = true;
    for (std::size_t n = b * block; n < (b + 1) * block; ++n)
      for (const SensorSignals& sensor : signals.sensors) whole = whole && sensor.may_use(channel, n);
    if (whole) {
      for (std::size_t k = 0; k < records.size(); ++k) {
        noise::StaticSignal& record = records[k];
        if (!open) record.runs.push_back({b, record.values.size(), 0});
        ++record.runs.back().count;
        record.values.push_back(y.row(static_cast<Eigen::Index>(k))
                                    .segment(static_cast<Eigen::Index>(b * block), static_cast<Eigen::Index>(block))
                                    .mean());
      }
    }
    open = whole;
  }
  for (noise::StaticSignal& record : records)  // the grid begins with the first value
    if (!record.runs.empty())
      for (std::size_t r = record.runs.size(); r-- > 0;) record.runs[r].start -= record.runs.front().start;
  return records;
}

struct FittedSum {
  noise::SumModel model;
  noise::Fit fit;
  double bic = 0.0;
};

FittedSum fit_sum(const std::vector<noise::StaticSignal>& records, const std::vector<const char*>& names) {
  std::vector<const noise::Estimable*> processes;
  for (const char* name : names) processes.push_back(&noise::estimable(name));
  const noise::Likelihood likelihood(records, noise::SumModel(processes, noise::Mean::kLevel));
  const std::vector<double> start = noise::fit_curve(noise::allan_curve(noise::detrend(records.front()).signal),
                                                     likelihood.model(), likelihood.scale(), noise::CurveFit::kWaveletMoments);
  FittedSum sum{likelihood.model(), noise::fit_maximum_likelihood(likelihood, start), 0.0};
  const auto K = static_cast<double>(records.size());
  const double independent = (K - 1.0) / K;
  sum.bic = -2.0 * independent * sum.fit.log_likelihood +
            static_cast<double>(sum.model.parameters()) * std::log(independent * likelihood.samples());
  return sum;
}

/// The sum's parameters for the mean of K sensors instead of one sensor's residual.
std::vector<double> of_the_mean(const FittedSum& sum, double sensors, double white_factor) {
  std::vector<double> u = sum.fit.u;
  for (const noise::SumModel::Term& term : sum.model.terms()) {
    const double factor = (term.process->name() == "white_noise" ? white_factor : 1.0) / (sensors - 1.0);
    for (std::size_t i = term.parameter; i < term.parameter + term.parameters; ++i)
      if (sum.model.parameter(i).kind == noise::ParameterInfo::Kind::kVariance) u[i] += std::log(factor);
  }
  return u;
}

double level_sd_of_mean(const std::vector<noise::StaticSignal>& records) {
  double squares = 0.0;  // the levels are offsets from their mean
  for (const noise::StaticSignal& record : records) {
    const double level = noise::detrend(record).level;
    squares += level * level;
  }
  const auto K = static_cast<double>(records.size());
  return std::sqrt(squares / (K - 1.0) / K);
}

}  // namespace

RemainingErrors remaining_errors(const Signals& signals, int channel, double average_s, double white_factor) {
  if (signals.sensors.size() < 2) throw std::invalid_argument("remaining_errors: fewer than 2 sensors");
  constexpr double kShortestAverage = 0.1;  // s: below it the sensors' filters have an effect
  auto block = static_cast<std::size_t>(std::max(1.0, std::round(average_s / signals.dt)));
  std::vector<noise::StaticSignal> records = averaged_residuals(signals, channel, block);
  const auto shortest = static_cast<std::size_t>(std::ceil(kShortestAverage / signals.dt));
  while (records.front().values.size() < kFewestAverages && block / 2 >= shortest) {
    block /= 2;  // a short record, or one with much left out
    records = averaged_residuals(signals, channel, block);
  }
  if (records.front().values.size() < kFewestAverages)
    throw std::invalid_argument(fmt::format("remaining_errors: {} averages over {} s with all sensors, at least {}",
                                            records.front().values.size(), records.front().interval, kFewestAverages));
  const FittedSum white = fit_sum(records, {"white_noise"});
  const FittedSum both = fit_sum(records, {"white_noise", "gauss_markov"});
  const FittedSum& best = both.bic < white.bic ? both : white;
  const auto sensors = static_cast<double>(records.size());
  RemainingErrors remaining;
  const noise::Sensor sensor = channel < 3 ? noise::Sensor::kGyro : noise::Sensor::kAccel;
  remaining.processes = best.model.processes(of_the_mean(best, sensors, white_factor), {sensor, records.front().interval});
  if (const double sd = level_sd_of_mean(records); sd > 0.0)
    remaining.processes.push_back(
        noise::make_gauss_markov({.name = "random_constant", .sigma = sd, .unit = channel < 3 ? "rad/s" : "m/s^2"}));
  remaining.in_words = fmt::format("{}, 2 log-likelihood {:.1f} above white noise alone; {} sensors", best.model.name(),
                                   2.0 * (both.fit.log_likelihood - white.fit.log_likelihood), records.size());
  return remaining;
}

noise::ProcessPtr white_noise_of(double density, int channel) {
  const noise::Sensor sensor = channel < 3 ? noise::Sensor::kGyro : noise::Sensor::kAccel;
  return noise::estimable("white_noise").process(std::array{std::log(density)}, {sensor, 1.0});
}

noise::ImuErrorModel error_model_of(const std::string& name, double rate_hz, const std::vector<RemainingErrors>& channels) {
  noise::ImuErrorModel::Axes gyro;
  noise::ImuErrorModel::Axes accel;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    gyro[axis] = channels.at(axis).processes;
    accel[axis] = channels.at(axis + 3).processes;
  }
  return noise::ImuErrorModel::of(name, rate_hz, std::move(gyro), std::move(accel));
}

std::string error_model_yaml(const std::string& name, double rate_hz, const std::vector<RemainingErrors>& channels) {
  std::string text = fmt::format("schema: coast.imu_error_model/1\nsensor: '{}'\nrate_hz: {:.10g}\n", name, rate_hz);
  for (int c = 0; c < kChannels; ++c) {
    if (c % 3 == 0) text += c == 0 ? "gyro:\n" : "accel:\n";
    const RemainingErrors& errors = channels.at(static_cast<std::size_t>(c));
    text += fmt::format("  {}:\n    # {}\n", "xyz"[c % 3], errors.in_words);
    for (const noise::ProcessPtr& process : errors.processes) text += fmt::format("    - {}\n", process->yaml());
  }
  return text;
}

}  // namespace coast::array
