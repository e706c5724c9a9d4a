#include "coast/array/synthetic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "coast/noise/arma_garch_filter.hpp"
#include "residuals.hpp"

namespace coast::array {

namespace {

/// Prediction of every sensor's noise before a sample: its expectation and its own variance. K x N.
struct Expectation {
  Eigen::MatrixXd mean;
  Eigen::MatrixXd variance;
};

Eigen::MatrixXd errors_of(const Signals& signals, int channel, const std::optional<Eigen::VectorXd>& reference) {
  if (!reference) return residuals(signals, channel);
  Eigen::MatrixXd y(static_cast<Eigen::Index>(signals.sensors.size()), static_cast<Eigen::Index>(signals.samples()));
  for (std::size_t k = 0; k < signals.sensors.size(); ++k)
    y.row(static_cast<Eigen::Index>(k)) = signals.sensors[k].values.row(channel) - reference->transpose();
  return y;
}

/// One sensor's residuals as the series for the fit of its model.
struct OwnSeries {
  std::vector<double> y;
  std::vector<std::uint8_t> is_missing;
  [[nodiscard]] noise::ArmaGarchSeries view() const { return {y, is_missing}; }
};

OwnSeries series_of(const SensorSignals& sensor, const Eigen::MatrixXd& y, Eigen::Index k, int channel) {
  OwnSeries series;
  for (Eigen::Index n = 0; n < y.cols(); ++n) {
    series.y.push_back(y(k, n));
    series.is_missing.push_back(sensor.may_use(channel, static_cast<std::size_t>(n)) ? 0 : 1);
  }
  return series;
}

noise::ArmaGarchOrders best_orders(const std::vector<OwnSeries>& series) {
  const std::vector<noise::ArmaGarchOrders> grid = noise::arma_garch_grid();
  std::vector<double> aicc(grid.size(), 0.0);
  for (const OwnSeries& own : series) {
    const noise::ArmaGarchChoice choice = noise::choose_arma_garch(own.view(), grid, {.constant = false});
    for (std::size_t i = 0; i < grid.size(); ++i) aicc[i] += choice.fits[i].aicc();
  }
  return grid[static_cast<std::size_t>(std::ranges::min_element(aicc) - aicc.begin())];
}

ModelTests test_model(const noise::ArmaGarchFit& fit, const OwnSeries& series) {
  constexpr int kWhiteLags = 20;
  constexpr int kArchLags = 10;
  const noise::ArmaGarchResiduals left = noise::arma_garch_residuals(fit.model, series.view());
  std::vector<double> standardised;
  for (std::size_t n = 0; n < left.residual.size(); ++n)
    if (series.is_missing[n] == 0) standardised.push_back(left.residual[n] / std::sqrt(left.variance[n]));
  const noise::ArmaGarchOrders orders = fit.model.orders();
  return {noise::ljung_box(standardised, kWhiteLags, orders.ar + orders.ma), noise::arch_lm(standardised, kArchLags),
          noise::jarque_bera(standardised)};
}

/// Predictions of one sensor's residuals along the record.
void predict(const noise::ArmaGarch& model, const OwnSeries& series, Eigen::Index k, Expectation& expected) {
  noise::ArmaGarchFilter filter(model);
  for (std::size_t n = 0; n < series.y.size(); ++n) {
    const auto column = static_cast<Eigen::Index>(n);
    expected.mean(k, column) = filter.prediction().mean;
    expected.variance(k, column) = filter.prediction().variance;
    if (series.is_missing[n] != 0)
      filter.miss();
    else
      filter.observe(series.y[n]);
  }
}

/// From the variances of residuals to those of the sensors, sample by sample.
void solve_own(const Signals& signals, int channel, Eigen::MatrixXd& variance) {
  std::vector<double> present;
  std::vector<Eigen::Index> who;
  for (Eigen::Index n = 0; n < variance.cols(); ++n) {
    present.clear();
    who.clear();
    for (Eigen::Index k = 0; k < variance.rows(); ++k) {
      if (!signals.sensors[static_cast<std::size_t>(k)].may_use(channel, static_cast<std::size_t>(n))) continue;
      present.push_back(variance(k, n));
      who.push_back(k);
    }
    if (present.size() < 2) continue;
    solve_own_variances(present);
    for (std::size_t i = 0; i < who.size(); ++i) variance(who[i], n) = present[i];
  }
}

Expectation garch_expectation(const Signals& signals, int channel, const MergeOptions& options, const Eigen::MatrixXd& y,
                              bool own_errors, MergedChannel& merged) {
  std::vector<OwnSeries> series;
  for (Eigen::Index k = 0; k < y.rows(); ++k)
    series.push_back(series_of(signals.sensors[static_cast<std::size_t>(k)], y, k, channel));
  const noise::ArmaGarchOrders orders = options.choose_orders ? best_orders(series) : options.orders;
  Expectation expected{Eigen::MatrixXd::Zero(y.rows(), y.cols()), Eigen::MatrixXd::Zero(y.rows(), y.cols())};
  for (Eigen::Index k = 0; k < y.rows(); ++k) {
    const OwnSeries& own = series[static_cast<std::size_t>(k)];
    merged.models.push_back(noise::fit_arma_garch(own.view(), orders, {.constant = false}));
    merged.tests.push_back(test_model(merged.models.back(), own));
    predict(merged.models.back().model, own, k, expected);
  }
  if (!own_errors) solve_own(signals, channel, expected.variance);
  if (options.merge != Merge::kCorrected) expected.mean.setZero();
  return expected;
}

/// The measured noise, constant within a block.
Expectation measured_expectation(const NoiseOverTime& noise, Eigen::Index samples) {
  Expectation expected{Eigen::MatrixXd::Zero(noise.variance.rows(), samples), Eigen::MatrixXd(noise.variance.rows(), samples)};
  for (Eigen::Index n = 0; n < samples; ++n)
    expected.variance.col(n) =
        noise.variance.col(std::min<Eigen::Index>(n / static_cast<Eigen::Index>(noise.block), noise.variance.cols() - 1));
  return expected;
}

/// Variances used for the weights: equal, constant or predicted for the sample.
Eigen::VectorXd variances_for_weights(const MergeOptions& options, int channel, const Eigen::VectorXd& mean_variance,
                                      const Eigen::Ref<const Eigen::VectorXd>& expected) {
  switch (options.merge) {
    case Merge::kMean:
      return Eigen::VectorXd::Ones(expected.size());
    case Merge::kWeighted:
      return mean_variance;
    case Merge::kExtended:
      return options.weights.row(channel).transpose().cwiseInverse();
    case Merge::kGarch:
    case Merge::kCorrected:
      break;
  }
  return expected;
}

void merge_samples(const Signals& signals, int channel, const MergeOptions& options, const Expectation& expected,
                   MergedChannel& merged) {
  const Eigen::Index samples = expected.mean.cols();
  const Eigen::Index sensors = expected.mean.rows();
  const Eigen::VectorXd mean_variance = merged.noise.variance.rowwise().mean().cwiseMax(std::numeric_limits<double>::min());
  merged.value.resize(samples);
  merged.variance.resize(samples);
  merged.weight = Eigen::VectorXd::Zero(sensors);
  Eigen::VectorXd weight(sensors);
  for (Eigen::Index n = 0; n < samples; ++n) {
    weight = variances_for_weights(options, channel, mean_variance, expected.variance.col(n)).cwiseInverse();
    for (Eigen::Index k = 0; k < sensors; ++k)
      if (!signals.sensors[static_cast<std::size_t>(k)].may_use(channel, static_cast<std::size_t>(n))) weight(k) = 0.0;
    if (!(weight.sum() > 0.0) || !std::isfinite(weight.sum())) {  // no sensor, or no noise at all: equal weights
      merged.value(n) = plain_mean(signals, channel, static_cast<std::size_t>(n));
      merged.variance(n) = expected.variance.col(n).mean();
      continue;
    }
    weight /= weight.sum();
    double value = 0.0;
    for (Eigen::Index k = 0; k < sensors; ++k)
      value += weight(k) * (signals.sensors[static_cast<std::size_t>(k)].values(channel, n) - expected.mean(k, n));
    merged.value(n) = value;
    merged.variance(n) = weight.cwiseAbs2().dot(expected.variance.col(n));
    merged.weight += weight / static_cast<double>(samples);
  }
}

/// Means over the blocks of the noise measurement.
Eigen::MatrixXd block_means_of(const Eigen::MatrixXd& values, const NoiseOverTime& noise) {
  Eigen::MatrixXd means(values.rows(), noise.variance.cols());
  const auto block = static_cast<Eigen::Index>(noise.block);
  for (Eigen::Index b = 0; b < means.cols(); ++b) {
    const Eigen::Index first = b * block;
    const Eigen::Index count = b + 1 == means.cols() ? values.cols() - first : block;
    means.col(b) = values.middleCols(first, count).rowwise().mean();
  }
  return means;
}

}  // namespace

MergedChannel merge_channel(const Signals& signals, int channel, const MergeOptions& options,
                            const std::optional<Eigen::VectorXd>& reference) {
  if (signals.sensors.size() < 2)
    throw std::invalid_argument(fmt::format("merge_channel: {} sensors, at least 2", signals.sensors.size()));
  if (reference && static_cast<std::size_t>(reference->size()) != signals.samples())
    throw std::invalid_argument(
        fmt::format("merge_channel: {} reference values for {} samples", reference->size(), signals.samples()));
  MergedChannel merged;
  merged.noise = noise_over_time(signals, channel, options.window_s);
  const auto samples = static_cast<Eigen::Index>(signals.samples());
  const bool wanted = options.merge == Merge::kGarch || options.merge == Merge::kCorrected;
  const Eigen::MatrixXd y = wanted ? errors_of(signals, channel, reference) : Eigen::MatrixXd();
  const bool models = wanted && (y.rowwise().squaredNorm().array() > 0.0).all();  // without noise no model can be fitted
  const Expectation expected = models ? garch_expectation(signals, channel, options, y, reference.has_value(), merged)
                                      : measured_expectation(merged.noise, samples);
  merge_samples(signals, channel, options, expected, merged);
  if (models) merged.predicted = block_means_of(expected.variance, merged.noise);
  return merged;
}

double white_share(const MergedChannel& merged) {
  const auto K = static_cast<double>(merged.noise.variance.rows());
  const double measured = merged.noise.variance.mean();
  const double plain = measured / K;
  const double whole = merged.predicted.size() > 0 ? measured / merged.predicted.mean() : 1.0;
  return plain > 0.0 ? whole * merged.variance.mean() / plain : 1.0;
}

}  // namespace coast::array
