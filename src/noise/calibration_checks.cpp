#include "calibration_checks.hpp"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "coast/noise/chi_square.hpp"
#include "coast/record/error.hpp"

namespace coast::noise {

namespace {

constexpr double kQuarter = 0.25;  // "known": a relative standard deviation of a quarter

/// Times of the samples, s.
std::vector<double> times_of(const StaticSignal& signal) {
  std::vector<double> times;
  times.reserve(signal.values.size());
  for (const StaticSignal::Run& run : signal.runs)
    for (std::size_t i = 0; i < run.count; ++i) times.push_back(static_cast<double>(run.start + i) * signal.interval);
  return times;
}

/// x with P(|z| > x) = p for standard normal z.
double normal_bound(double p) {
  return std::sqrt(chi2_upper_quantile(1.0, p));
}

}  // namespace

void check_record(const StaticSignal& record) {
  constexpr std::size_t kFewestSamples = 100;
  if (record.values.size() < kFewestSamples)
    throw NumericalError("too few samples", "",
                         fmt::format("{} has {}, at least {} are needed", record.source, record.values.size(), kFewestSamples));
  const auto [lowest, highest] = std::ranges::minmax(record.values);
  if (!(highest > lowest))
    throw NumericalError("the signal is constant", "", fmt::format("{}: every sample is {:g}", record.source, lowest));
}

Whiteness whiteness_of(const std::vector<double>& standardised, int fitted_parameters) {
  constexpr std::size_t kLags = 40;
  Whiteness result;
  const auto n = static_cast<double>(standardised.size());
  const double variance = std::inner_product(standardised.begin(), standardised.end(), standardised.begin(), 0.0) / n;
  double q = 0.0;
  const std::size_t lags = std::min(kLags, standardised.size() / 4);
  for (std::size_t lag = 1; lag <= lags; ++lag) {
    double sum = 0.0;
    for (std::size_t i = lag; i < standardised.size(); ++i) sum += standardised[i] * standardised[i - lag];
    const double r = sum / (n * variance);
    result.autocorrelation.push_back(r);
    q += r * r / (n - static_cast<double>(lag));
  }
  const double dof = std::max(1.0, static_cast<double>(lags) - fitted_parameters);
  result.p_value = chi2_survival(dof, n * (n + 2.0) * q);
  return result;
}

std::vector<Outlier> outliers_of(const Likelihood& likelihood, const std::vector<double>& u) {
  std::vector<Outlier> outliers;
  for (std::size_t r = 0; r < likelihood.records().size(); ++r) {
    const StaticSignal& signal = likelihood.records()[r].signal;
    const double bound = normal_bound(0.01 / static_cast<double>(signal.values.size()));
    const std::vector<double> standardised = likelihood.standardised_innovations(u, r, bound);
    const std::vector<double> times = times_of(signal);
    for (std::size_t i = 0; i < standardised.size(); ++i)
      if (std::abs(standardised[i]) > bound) outliers.push_back({r, times[i], standardised[i]});
  }
  return outliers;
}

std::vector<ParameterEstimate> parameters_of(const Likelihood& likelihood, const Fit& fit, const Eigen::MatrixXd& covariance,
                                             const CalibrationOptions& options) {
  const SumModel& model = likelihood.model();
  const double duration = likelihood.scale().duration;
  const std::vector<ProfileInterval> intervals =
      options.bootstrap > 0 ? std::vector<ProfileInterval>(model.parameters()) : profile_intervals(likelihood, fit);
  std::vector<ParameterEstimate> all;
  for (std::size_t i = 0; i < model.parameters(); ++i) {
    const ParameterInfo info = model.parameter(i);
    ParameterEstimate& estimate = all.emplace_back();
    estimate.name = model.parameter_name(i);
    estimate.unit = info.unit;
    estimate.value = info.value(fit.u[i]);
    const auto at = static_cast<Eigen::Index>(i);
    estimate.relative_bound = std::sqrt(covariance(at, at));
    const double ratio = estimate.relative_bound / kQuarter;
    estimate.duration_for_quarter = duration * ratio * ratio;
    if (intervals[i].lower) estimate.lower = info.value(*intervals[i].lower);
    if (intervals[i].upper) estimate.upper = info.value(*intervals[i].upper);
  }
  return all;
}

std::vector<Combination> combinations_of(const SumModel& model, const Eigen::MatrixXd& information) {
  constexpr double kShown = 0.2;
  std::vector<Combination> all;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(information);
  for (Eigen::Index k = information.rows() - 1; k >= 0; --k) {
    Combination combination;
    Eigen::VectorXd direction = eigen.eigenvectors().col(k);
    Eigen::Index largest = 0;
    direction.cwiseAbs().maxCoeff(&largest);
    // Powers relative to the largest, as usually written.
    combination.relative_sd = 1.0 / std::sqrt(std::max(eigen.eigenvalues()(k), 1e-300)) / std::abs(direction(largest));
    direction /= direction(largest);
    for (Eigen::Index i = 0; i < direction.size(); ++i) {
      if (std::abs(direction(i)) < kShown) continue;
      const std::string name = model.parameter_name(static_cast<std::size_t>(i));
      combination.text += combination.text.empty() ? "" : " * ";
      combination.text +=
          std::abs(direction(i) - 1.0) < 0.05 ? fmt::format("({})", name) : fmt::format("({})^{:.2g}", name, direction(i));
    }
    all.push_back(std::move(combination));
  }
  return all;
}

std::vector<std::string> remarks_of(const SumModel& model, const std::vector<ParameterEstimate>& parameters,
                                    const Eigen::MatrixXd& covariance, double duration) {
  constexpr double kUnknown = 0.5;
  std::vector<std::string> remarks;
  for (const SumModel::Term& term : model.terms()) {
    const auto at = static_cast<Eigen::Index>(term.parameter);
    if (term.process->symbol() != "GM" || !std::isfinite(covariance(at, at))) continue;
    const double product = std::sqrt(covariance(at, at) + 2.0 * covariance(at, at + 1) + covariance(at + 1, at + 1));
    const ParameterEstimate& beta = parameters[term.parameter];
    const ParameterEstimate& sigma2 = parameters[term.parameter + 1];
    if (beta.relative_bound < kUnknown && sigma2.relative_bound < kUnknown) continue;
    remarks.push_back(fmt::format(
        "{} and {} cannot be told apart from this record ({:.0f} s): alone they are known to {:.0f} % and {:.0f} %, their "
        "product "
        "2 beta sigma2 = {:.4g} (the strength of the random walk that it looks like) to {:.0f} %. To know each to 25 % takes a "
        "record of {:.2g} h.",
        beta.name, sigma2.name, duration, 100.0 * beta.relative_bound, 100.0 * sigma2.relative_bound,
        2.0 * beta.value * sigma2.value, 100.0 * product,
        std::max(beta.duration_for_quarter, sigma2.duration_for_quarter) / 3600.0));
  }
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const ParameterEstimate& p = parameters[i];
    if (model.parameter(i).kind != ParameterInfo::Kind::kVariance || p.relative_bound < 2.0) continue;
    remarks.push_back(fmt::format("{} cannot be seen in this record: it would have to be known to {:.3g} times itself.", p.name,
                                  p.relative_bound));
  }
  return remarks;
}

}  // namespace coast::noise
