#include "coast/array/merge_study.hpp"

#include <fmt/format.h>

#include <cmath>
#include <mutex>
#include <numbers>
#include <numeric>
#include <random>
#include <stdexcept>

#include "coast/noise/arma_garch_filter.hpp"
#include "coast/parallel.hpp"

namespace coast::array {

namespace {

constexpr int kStudiedChannel = 0;

/// A model's prediction of a series before each sample.
struct Predicted {
  Eigen::VectorXd mean;
  Eigen::VectorXd variance;
};

Predicted predicted_by(const noise::ArmaGarch& model, const Eigen::Ref<const Eigen::RowVectorXd>& y) {
  noise::ArmaGarchFilter filter(model);
  Predicted predicted{Eigen::VectorXd(y.size()), Eigen::VectorXd(y.size())};
  for (Eigen::Index n = 0; n < y.size(); ++n) {
    predicted.mean(n) = filter.prediction().mean;
    predicted.variance(n) = filter.prediction().variance;
    filter.observe(y(n));
  }
  return predicted;
}

double lag_one(const noise::ArmaGarch& model) {
  const std::vector<double> psi = model.psi_weights(400);
  return std::inner_product(psi.begin() + 1, psi.end(), psi.begin(), 0.0) /
         std::inner_product(psi.begin(), psi.end(), psi.begin(), 0.0);
}

/// One simulated array.
struct DrawnArray {
  Eigen::RowVectorXd motion;
  Eigen::MatrixXd errors;  // K x N
  Signals signals;
};

DrawnArray draw(const MergeStudyOptions& options, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  const auto samples = static_cast<Eigen::Index>(options.samples);
  DrawnArray drawn;
  drawn.motion.resize(samples);
  for (Eigen::Index n = 0; n < samples; ++n) {
    const double t = 2.0 * std::numbers::pi * options.dt * static_cast<double>(n);
    drawn.motion(n) = options.motion_rms * (std::sin(0.13 * t) + std::sin(1.7 * t));  // each has half of the power
  }
  drawn.errors.resize(static_cast<Eigen::Index>(options.sensors.size()), samples);
  drawn.signals.dt = options.dt;
  for (std::size_t k = 0; k < options.sensors.size(); ++k) {
    const std::vector<double> y = noise::simulate_arma_garch(options.sensors[k], options.samples, generator);
    auto row = drawn.errors.row(static_cast<Eigen::Index>(k));
    row = Eigen::Map<const Eigen::RowVectorXd>(y.data(), samples) + options.scale_sd * normal(generator) * drawn.motion;
    SensorSignals& sensor = drawn.signals.sensors.emplace_back();
    sensor.values = Eigen::Matrix<double, kChannels, Eigen::Dynamic>::Zero(kChannels, samples);
    sensor.values.row(kStudiedChannel) = drawn.motion + row;
    sensor.usable.assign(options.samples, kAllUsable);
  }
  return drawn;
}

double mean_square_of(const Eigen::Ref<const Eigen::RowVectorXd>& errors) {
  return errors.squaredNorm() / static_cast<double>(errors.size());
}

/// Weighted by variances, predictions subtracted.
Eigen::RowVectorXd merged_errors(const Eigen::MatrixXd& errors, const std::vector<Predicted>& predicted, bool subtract) {
  Eigen::RowVectorXd merged(errors.cols());
  for (Eigen::Index n = 0; n < errors.cols(); ++n) {
    double sum = 0.0;
    double weights = 0.0;
    for (Eigen::Index k = 0; k < errors.rows(); ++k) {
      const Predicted& p = predicted[static_cast<std::size_t>(k)];
      const double weight = 1.0 / p.variance(n);
      sum += weight * (errors(k, n) - (subtract ? p.mean(n) : 0.0));
      weights += weight;
    }
    merged(n) = sum / weights;
  }
  return merged;
}

struct StudiedRun {
  std::vector<double> mse;  // in the order of merge_names()
  std::vector<ResidualModel> models;
  std::vector<std::vector<double>> errors;
  std::vector<double> residuals, sd, predicted_sd;
};

std::vector<std::string> merge_names(std::size_t sensors) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < sensors; ++k) names.push_back(fmt::format("single {}", k + 1));
  for (const char* name : {"mean", "weighted", "garch", "corrected", "corrected by errors", "oracle weights", "oracle"})
    names.emplace_back(name);
  return names;
}

ResidualModel compare_models(const DrawnArray& drawn, std::size_t k, const noise::ArmaGarch& truth,
                             const MergedChannel& residual, const MergedChannel& errors) {
  const auto row = static_cast<Eigen::Index>(k);
  const noise::ArmaGarch& model = residual.models[k].model;
  const Eigen::MatrixXd y = residuals(drawn.signals, kStudiedChannel);
  const double variance = mean_square_of(drawn.errors.row(row));
  const auto removed = [&](const noise::ArmaGarch& by, const Eigen::Ref<const Eigen::RowVectorXd>& series) {
    return 1.0 - mean_square_of(drawn.errors.row(row) - predicted_by(by, series).mean.transpose()) / variance;
  };
  ResidualModel found;
  found.own_sd_ratio = std::sqrt(residual.predicted.row(row).mean() / truth.innovation_variance());
  found.autocorrelation = lag_one(model);
  found.persistence = model.persistence();
  found.true_autocorrelation = lag_one(truth);
  found.true_persistence = truth.persistence();
  found.removed = removed(model, y.row(row));
  found.removed_by_errors = removed(errors.models[k].model, drawn.errors.row(row));
  return found;
}

StudiedRun study_run(const MergeStudyOptions& options, std::uint64_t seed) {
  const DrawnArray drawn = draw(options, seed);
  StudiedRun run;
  for (Eigen::Index k = 0; k < drawn.errors.rows(); ++k) run.mse.push_back(mean_square_of(drawn.errors.row(k)));
  MergeOptions merge{.orders = options.orders};
  const auto merged = [&](Merge which, const std::optional<Eigen::VectorXd>& reference) {
    merge.merge = which;
    MergedChannel channel = merge_channel(drawn.signals, kStudiedChannel, merge, reference);
    channel.value -= drawn.motion.transpose();
    run.mse.push_back(mean_square_of(channel.value.transpose()));
    return channel;
  };
  const MergedChannel mean = merged(Merge::kMean, {});
  static_cast<void>(merged(Merge::kWeighted, {}));
  static_cast<void>(merged(Merge::kGarch, {}));
  const MergedChannel by_residuals = merged(Merge::kCorrected, {});
  const MergedChannel by_errors = merged(Merge::kCorrected, Eigen::VectorXd(drawn.motion.transpose()));
  std::vector<Predicted> truth;
  for (std::size_t k = 0; k < options.sensors.size(); ++k)
    truth.push_back(predicted_by(options.sensors[k], drawn.errors.row(static_cast<Eigen::Index>(k))));
  run.mse.push_back(mean_square_of(merged_errors(drawn.errors, truth, false)));
  run.mse.push_back(mean_square_of(merged_errors(drawn.errors, truth, true)));
  for (std::size_t k = 0; k < options.sensors.size(); ++k)
    run.models.push_back(compare_models(drawn, k, options.sensors[k], by_residuals, by_errors));
  const auto keep = [&](const auto& row) { run.errors.emplace_back(row.begin(), row.end()); };
  for (Eigen::Index k = 0; k < drawn.errors.rows(); ++k) keep(drawn.errors.row(k));
  keep(mean.value);
  keep(by_residuals.value);
  keep(by_errors.value);
  const Predicted found = predicted_by(by_errors.models.front().model, drawn.errors.row(0));
  for (Eigen::Index n = 0; n < drawn.errors.cols(); ++n) {
    run.residuals.push_back(drawn.errors(0, n) - found.mean(n));
    run.sd.push_back(std::sqrt(truth.front().variance(n)));
    run.predicted_sd.push_back(std::sqrt(found.variance(n)));
  }
  return run;
}

void add_to_mean(ResidualModel& mean, const ResidualModel& one, double share) {
  for (double ResidualModel::*member :
       {&ResidualModel::own_sd_ratio, &ResidualModel::autocorrelation, &ResidualModel::persistence,
        &ResidualModel::true_autocorrelation, &ResidualModel::true_persistence, &ResidualModel::removed,
        &ResidualModel::removed_by_errors})
    mean.*member += share * one.*member;
}

}  // namespace

double MergeResult::mean() const {
  return std::accumulate(mse.begin(), mse.end(), 0.0) / static_cast<double>(mse.size());
}

MergeStudy run_merge_study(const MergeStudyOptions& options, const std::function<void(double)>& progress) {
  if (options.sensors.size() < 2 || options.runs < 1)
    throw std::invalid_argument(
        fmt::format("run_merge_study: {} sensors and {} runs, at least 2 and 1", options.sensors.size(), options.runs));
  std::vector<StudiedRun> runs(options.runs);
  std::mutex mutex;
  double done = 0.0;
  coast::parallel_for(std::size_t{0}, options.runs, [&](std::size_t r) {
    runs[r] = study_run(options, options.first_seed + r);
    if (r > 0) runs[r].errors.clear();
    const std::scoped_lock lock(mutex);
    done += 1.0 / static_cast<double>(options.runs);
    if (progress) progress(done);
  });
  MergeStudy study;
  for (const std::string& name : merge_names(options.sensors.size())) study.merges.push_back({name, {}});
  study.residual_models.resize(options.sensors.size());
  for (const StudiedRun& run : runs) {
    for (std::size_t i = 0; i < study.merges.size(); ++i) study.merges[i].mse.push_back(run.mse[i]);
    for (std::size_t k = 0; k < run.models.size(); ++k)
      add_to_mean(study.residual_models[k], run.models[k], 1.0 / static_cast<double>(options.runs));
  }
  study.first_errors = std::move(runs.front().errors);
  study.first_residuals = std::move(runs.front().residuals);
  study.first_sd = std::move(runs.front().sd);
  study.first_predicted_sd = std::move(runs.front().predicted_sd);
  return study;
}

}  // namespace coast::array
