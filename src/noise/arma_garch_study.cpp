#include "coast/noise/arma_garch_study.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "coast/parallel.hpp"

namespace coast::noise {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

struct ArmaGarchRun {
  VectorXd estimate;
  VectorXd se;  ///< empty if there is none
  std::vector<bool> is_inside;
  bool converged = false;
  double seconds = 0.0;
};

ArmaGarchRun study_run(const ArmaGarch& truth, std::size_t n, std::uint64_t seed, bool constant) {
  std::mt19937_64 generator(seed);
  const std::vector<double> y = simulate_arma_garch(truth, n, generator);
  const auto began = std::chrono::steady_clock::now();
  const ArmaGarchFit fit = fit_arma_garch({y}, truth.orders(), {.constant = constant});
  const std::optional<ArmaGarchUncertainty> uncertainty = arma_garch_uncertainty(fit, {y});
  ArmaGarchRun run;
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  run.estimate = arma_garch_vector(fit.model, constant);
  run.converged = fit.converged;
  const VectorXd theta = arma_garch_vector(truth, constant);
  run.is_inside.assign(static_cast<std::size_t>(theta.size()), false);
  if (!uncertainty) return run;
  run.se = uncertainty->robust.diagonal().cwiseSqrt();
  const std::vector<Interval> intervals = arma_garch_intervals(fit, *uncertainty);
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    const double value = theta(static_cast<Index>(i));
    run.is_inside[i] = intervals[i].lower <= value && value <= intervals[i].upper;
  }
  return run;
}

ArmaGarchParameterSummary parameter_summary(const std::vector<ArmaGarchRun>& runs, std::size_t parameter) {
  const auto at = static_cast<Index>(parameter);
  const auto count = static_cast<double>(runs.size());
  ArmaGarchParameterSummary summary;
  double mean = 0.0;
  double stated = 0.0;
  for (const ArmaGarchRun& run : runs) {
    mean += run.estimate(at) / count;
    summary.inside += run.is_inside[parameter] ? 1U : 0U;
    if (run.se.size() == 0) continue;
    summary.mean_se += run.se(at);
    stated += 1.0;
  }
  double squares = 0.0;
  for (const ArmaGarchRun& run : runs) squares += (run.estimate(at) - mean) * (run.estimate(at) - mean);
  summary.bias = mean;  // the truth is subtracted by the caller
  summary.sd = runs.size() > 1 ? std::sqrt(squares / (count - 1.0)) : 0.0;
  if (stated > 0.0) summary.mean_se /= stated;
  summary.coverage = static_cast<double>(summary.inside) / count;
  return summary;
}

}  // namespace

ArmaGarchStudy run_arma_garch_study(const ArmaGarch& model, std::size_t n, std::size_t runs, std::uint64_t first_seed,
                                    const std::function<void(double)>& progress, bool constant) {
  if (runs == 0) throw std::invalid_argument("run_arma_garch_study: no runs");
  std::vector<ArmaGarchRun> all(runs);
  std::atomic<std::size_t> done = 0;
  coast::parallel_for(std::size_t{0}, runs, [&](std::size_t r) {
    all[r] = study_run(model, n, first_seed + r, constant);
    if (progress) progress(static_cast<double>(++done) / static_cast<double>(runs));
  });
  ArmaGarchStudy study;
  study.runs = runs;
  const std::vector<std::string> names = arma_garch_names(model.orders(), constant);
  const VectorXd theta = arma_garch_vector(model, constant);
  std::size_t inside = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    ArmaGarchParameterSummary summary = parameter_summary(all, i);
    summary.name = names[i];
    summary.truth = theta(static_cast<Index>(i));
    summary.bias -= summary.truth;
    inside += summary.inside;
    study.parameters.push_back(std::move(summary));
  }
  study.pooled_coverage = static_cast<double>(inside) / static_cast<double>(runs * names.size());
  std::vector<double> seconds;
  for (const ArmaGarchRun& run : all) {
    seconds.push_back(run.seconds);
    study.without_uncertainty += run.se.size() == 0 ? 1U : 0U;
    study.not_converged += run.converged ? 0U : 1U;
  }
  std::ranges::sort(seconds);
  study.median_seconds = seconds[seconds.size() / 2];
  return study;
}

}  // namespace coast::noise
