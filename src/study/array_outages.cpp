#include "coast/study/array_outages.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <mutex>
#include <numeric>
#include <random>

#include "coast/array/extended.hpp"
#include "coast/array/remaining.hpp"
#include "coast/ins/mounting.hpp"
#include "coast/parallel.hpp"
#include "coast/record/error.hpp"
#include "coast/simulate/sensor_errors.hpp"
#include "seed_outage.hpp"

namespace coast::study {

namespace {

using array::kChannels;
using array::Signals;
using simulate::ErrorFreeMission;

const noise::ArmaGarch& noise_of(const ArrayOutagePlan& plan, std::size_t sensor, int channel) {
  return (channel < 3 ? plan.gyro : plan.accel)[sensor];
}

/// Density at zero frequency of a series sampled every dt: the one to be used by a navigation filter.
double density_of(const noise::ArmaGarch& model, double dt) {
  const std::vector<double> psi = model.psi_weights(400);
  const double gain = std::accumulate(psi.begin(), psi.end(), 0.0);
  return model.innovation_variance() * gain * gain * dt;
}

/// Rates and forces of every sensor: the truth, slow errors, noise.
Signals record_array(const ArrayOutagePlan& plan, const record::ImuRecording& truth, std::uint64_t seed) {
  constexpr std::uint64_t kBetweenSensors = 7919;
  Signals signals{truth.samples.front().t - truth.samples.front().dt, 1.0 / truth.rate_hz, {}};
  for (std::size_t k = 0; k < plan.gyro.size(); ++k) {
    const std::uint64_t own_seed = seed * 1000003 + kBetweenSensors * (k + 1);
    const record::ImuRecording slow = simulate::with_errors(truth, plan.slow, own_seed);
    array::SensorSignals& sensor = signals.sensors.emplace_back();
    sensor.name = fmt::format("imu{}", k + 1);
    sensor.usable.assign(slow.samples.size(), array::kAllUsable);
    sensor.values.resize(kChannels, static_cast<Eigen::Index>(slow.samples.size()));
    for (std::size_t n = 0; n < slow.samples.size(); ++n) {
      const record::ImuSample& sample = slow.samples[n];
      sensor.values.col(static_cast<Eigen::Index>(n)) << sample.dtheta / sample.dt, sample.dv / sample.dt;
    }
    std::mt19937_64 generator(own_seed + 1);
    for (int c = 0; c < kChannels; ++c) {
      const std::vector<double> y = noise::simulate_arma_garch(noise_of(plan, k, c), slow.samples.size(), generator);
      sensor.values.row(c) += Eigen::Map<const Eigen::RowVectorXd>(y.data(), static_cast<Eigen::Index>(y.size()));
    }
  }
  return signals;
}

/// A sensor's rows as increments at the times of the truth.
record::ImuRecording recording_of(const record::ImuRecording& truth,
                                  const Eigen::Matrix<double, kChannels, Eigen::Dynamic>& values) {
  record::ImuRecording imu = truth;
  for (std::size_t n = 0; n < imu.samples.size(); ++n) {
    record::ImuSample& sample = imu.samples[n];
    sample.dtheta = sample.dt * values.col(static_cast<Eigen::Index>(n)).head<3>();
    sample.dv = sample.dt * values.col(static_cast<Eigen::Index>(n)).tail<3>();
  }
  return imu;
}

/// Noise in blocks, relative to its mean, as in `imu.noise_levels`.
std::vector<record::NoiseLevel> levels_of(const Signals& signals, const std::vector<array::MergedChannel>& channels) {
  const auto block = static_cast<Eigen::Index>(channels.front().noise.block);
  const Eigen::Index blocks = channels.front().noise.variance.cols();
  std::vector<record::NoiseLevel> levels(static_cast<std::size_t>(blocks));
  for (Eigen::Index b = 0; b < blocks; ++b) {
    record::NoiseLevel& level = levels[static_cast<std::size_t>(b)];
    const auto samples = static_cast<Eigen::Index>(signals.samples());
    const Eigen::Index count = b + 1 == blocks ? samples - b * block : block;
    level.from = signals.start + static_cast<double>(b * block) * signals.dt;
    level.to = level.from + static_cast<double>(count) * signals.dt;
    for (int c = 0; c < kChannels; ++c) {
      const Eigen::VectorXd& variance = channels[static_cast<std::size_t>(c)].variance;
      (c < 3 ? level.gyro : level.accel)(c % 3) = variance.segment(b * block, count).mean() / variance.mean();
    }
  }
  return levels;
}

struct FilterInput {
  record::ImuRecording imu;
  noise::ImuErrorModel model;
};

/// Model of a single sensor: its slow errors, and the density of its noise at zero frequency.
noise::ImuErrorModel single_model(const ArrayOutagePlan& plan, double rate_hz, double dt, std::size_t k) {
  std::vector<array::RemainingErrors> channels(kChannels);
  for (int c = 0; c < kChannels; ++c) {
    array::RemainingErrors& errors = channels[static_cast<std::size_t>(c)];
    errors.processes = plan.slow.axes(c < 3 ? noise::Sensor::kGyro : noise::Sensor::kAccel)[static_cast<std::size_t>(c % 3)];
    errors.processes.push_back(array::white_noise_of(density_of(noise_of(plan, k, c), dt), c));
  }
  return array::error_model_of("single", rate_hz, channels);
}

FilterInput merged_input(const ArrayOutagePlan& plan, const record::ImuRecording& truth, const Signals& signals,
                         const Signals& levelled, array::Merge merge) {
  constexpr double kAverage = 1.0;  // s
  std::vector<array::MergedChannel> merged;
  std::vector<array::RemainingErrors> remaining;
  Eigen::Matrix<double, kChannels, Eigen::Dynamic> values(kChannels, static_cast<Eigen::Index>(signals.samples()));
  for (int c = 0; c < kChannels; ++c) {
    merged.push_back(array::merge_channel(levelled, c, {.merge = merge, .orders = plan.orders}));
    values.row(c) = merged.back().value.transpose();
    remaining.push_back(array::remaining_errors(signals, c, kAverage, array::white_share(merged.back())));
  }
  FilterInput input{recording_of(truth, values), array::error_model_of("merged", truth.rate_hz, remaining)};
  if (merge == array::Merge::kGarch || merge == array::Merge::kCorrected) input.imu.noise = levels_of(signals, merged);
  return input;
}

/// Every sensor with its own model and error states: weighted by its white noise, biases kept, and the
/// sensors' differences for the filter.
FilterInput extended_input(const ArrayOutagePlan& plan, const record::ImuRecording& truth, const Signals& signals) {
  std::vector<noise::ImuErrorModel> models;
  for (std::size_t k = 0; k < signals.sensors.size(); ++k) models.push_back(single_model(plan, truth.rate_hz, signals.dt, k));
  std::vector<array::ModelledSensor> sensors;
  for (std::size_t k = 0; k < models.size(); ++k) sensors.push_back({signals.sensors[k].name, &models[k]});
  const Eigen::MatrixXd weights = array::extended_weights(sensors);
  Eigen::Matrix<double, kChannels, Eigen::Dynamic> sum(kChannels, static_cast<Eigen::Index>(signals.samples()));
  sum.setZero();
  for (std::size_t k = 0; k < sensors.size(); ++k)
    sum += weights.col(static_cast<Eigen::Index>(k)).asDiagonal() * signals.sensors[k].values;
  FilterInput input{recording_of(truth, sum), array::extended_error_model("extended", truth.rate_hz, sensors)};
  input.imu.members = array::member_blocks(signals);
  return input;
}

struct NamedMerge {
  const char* name;
  array::Merge merge;
};
constexpr std::array kStudiedMerges{NamedMerge{"mean", array::Merge::kMean}, NamedMerge{"weighted", array::Merge::kWeighted},
                                    NamedMerge{"garch", array::Merge::kGarch},
                                    NamedMerge{"corrected", array::Merge::kCorrected}};

/// All methods with one seed, in the order of the runs.
std::vector<OutageResult> run_array_seed(const ArrayOutagePlan& plan, const ErrorFreeMission& mission, const Outage& outage,
                                         std::uint64_t seed) {
  constexpr double kOffsetWindow = 30.0;  // s, default of `coast synth`
  ErrorFreeMission::Recordings truth = mission.recorded({}, seed);
  ins::to_body(truth.imu, ins::C_s_b(plan.scenario.mounting));
  const Signals signals = record_array(plan, truth.imu, seed);
  Signals levelled = signals;
  static_cast<void>(array::take_off_relative_offsets(levelled, kOffsetWindow));
  std::vector<OutageResult> results;
  const auto process = [&](FilterInput input) {
    results.push_back(solve_outages(plan.scenario, mission.truth(), {std::move(input.imu), truth.gnss}, {"", input.model},
                                    outage.start, {outage})
                          .front());
    if (seed > plan.first_seed) results.back().forward.series = results.back().smoothed->series = {};
  };
  for (std::size_t k = 0; k < plan.gyro.size(); ++k)
    process({recording_of(truth.imu, signals.sensors[k].values), single_model(plan, truth.imu.rate_hz, signals.dt, k)});
  for (const NamedMerge& merge : kStudiedMerges) process(merged_input(plan, truth.imu, signals, levelled, merge.merge));
  process(extended_input(plan, truth.imu, signals));
  return results;
}

}  // namespace

std::vector<ArrayOutageRun> run_array_outages(const ArrayOutagePlan& plan, const std::function<void(double)>& progress) {
  if (plan.gyro.size() < 2 || plan.gyro.size() != plan.accel.size())
    throw InputError({"", 0, fmt::format("{} gyros and {} accelerometers", plan.gyro.size(), plan.accel.size()),
                      "the same number of both, two or more", ""});
  const ErrorFreeMission mission(
      plan.scenario, static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)));
  if (mission.outages().empty())
    throw InputError({"", 0, "a scenario without outages", "outages: [{manoeuvre: .., duration_s: ..}]", ""});
  const Outage outage{mission.outages().front().start, mission.outages().front().duration};
  std::vector<ArrayOutageRun> runs;
  for (std::size_t k = 0; k < plan.gyro.size(); ++k) runs.push_back({fmt::format("single {}", k + 1), {}});
  for (const NamedMerge& merge : kStudiedMerges) runs.push_back({merge.name, {}});
  runs.push_back({"extended", {}});
  for (ArrayOutageRun& run : runs) run.outages.resize(plan.seeds);
  std::mutex mutex;
  std::size_t done = 0;
  coast::parallel_for(std::size_t{0}, plan.seeds, [&](std::size_t s) {
    std::vector<OutageResult> of_seed;
    // A thread that waits inside one seed must not begin another: each needs its own memory.
    tbb::this_task_arena::isolate([&] { of_seed = run_array_seed(plan, mission, outage, plan.first_seed + s); });
    for (std::size_t i = 0; i < runs.size(); ++i) runs[i].outages[s] = std::move(of_seed[i]);
    const std::scoped_lock lock(mutex);
    if (progress) progress(static_cast<double>(++done) / static_cast<double>(plan.seeds));
  });
  return runs;
}

}  // namespace coast::study
