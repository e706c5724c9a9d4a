// estimator_study.json, and the summary on the terminal.

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "estimator_study/result.hpp"

namespace coast::jobs {

namespace {

using Json = nlohmann::ordered_json;

void put_number(Json& j, const char* key, const std::optional<double>& value) {
  if (value && std::isfinite(*value)) j[key] = *value;
}

const char* name_of(noise::Estimator kind) {
  constexpr std::array kNames{"em", "default", "best_of_starts", "wavelet_moments", "allan"};
  return kNames[static_cast<std::size_t>(kind)];
}

Json coverage_json(const noise::Coverage& coverage) {
  const noise::Interval interval = coverage.uncertainty();
  return {{"inside", coverage.inside},
          {"intervals", coverage.intervals},
          {"share", coverage.share()},
          {"interval_95", {interval.lower, interval.upper}}};
}

Json parameter_json(const EstimatorStudyConfig& config, const noise::ParameterSummary& p) {
  Json j = {{"name", p.name}, {"unit", config.unit(p.unit)}};
  put_number(j, "truth", p.truth);
  put_number(j, "cramer_rao_sd", p.bound);
  j["mean"] = p.mean;
  if (p.truth) j["bias"] = p.mean - *p.truth;
  if (p.truth && p.bound) put_number(j, "bias_to_bound", (p.mean - *p.truth) / *p.bound);
  j["sd"] = p.sd;
  if (p.bound) put_number(j, "sd_to_bound", p.sd / *p.bound);
  j["q05"] = p.q05;
  j["median"] = p.median;
  j["q95"] = p.q95;
  put_number(j, "share_at_zero", p.zero);
  if (p.coverage) j["coverage"] = coverage_json(*p.coverage);
  return j;
}

Json by_run_json(const noise::StudiedEstimator& estimator, const noise::EstimatorSummary& summary,
                 const std::vector<noise::StudyFit>& fits) {
  Json j;
  for (const noise::StudyFit& fit : fits) {
    j["log_likelihood"].push_back(fit.log_likelihood);
    j["iterations"].push_back(fit.iterations);
    j["passes"].push_back(fit.passes);
    j["seconds"].push_back(fit.seconds);
  }
  for (std::size_t i = 0; i < summary.parameters.size(); ++i)
    j["values"][summary.parameters[i].name] = noise::values_of(estimator, fits, i);
  return j;
}

Json estimator_json(const EstimatorStudyConfig& config, const EstimatorStudyOutcome& outcome, std::size_t e) {
  const noise::StudiedEstimator& estimator = config.study.estimators[e];
  const noise::EstimatorSummary& summary = outcome.summaries[e];
  Json j = {{"name", estimator.name}, {"kind", name_of(estimator.kind)}, {"model", estimator.model.name()}};
  for (const noise::ParameterSummary& p : summary.parameters) j["parameters"].push_back(parameter_json(config, p));
  if (summary.pooled) j["pooled_coverage"] = coverage_json(*summary.pooled);
  j["log_likelihood_shortfall"] = {{"largest", summary.largest_shortfall}, {"mean", summary.mean_shortfall}};
  j["mean_iterations"] = summary.mean_iterations;
  j["mean_passes"] = summary.mean_passes;
  j["converged_share"] = summary.converged;
  j["seconds"] = {{"median", summary.median_seconds}, {"largest", summary.largest_seconds}};
  j["by_run"] = by_run_json(estimator, summary, outcome.result.fits[e]);
  return j;
}

Json truth_json(const EstimatorStudyConfig& config, const noise::StudyTruth& truth) {
  Json j = {{"model", truth.model.name()}};
  const std::vector<double> bounds = bounds_of(truth.model, truth, config.study.interval, config.study.samples);
  const std::vector<double> u = noise::in_order(truth.model, truth.u);
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double value = truth.model.parameter(i).value(u[i]);
    Json p = {{"name", truth.model.parameter_name(i)},
              {"unit", config.unit(std::string(truth.model.parameter(i).unit))},
              {"value", value}};
    put_number(p, "cramer_rao_sd", bounds[i]);
    put_number(p, "cramer_rao_relative_sd", bounds[i] / std::abs(value));
    j["parameters"].push_back(std::move(p));
  }
  constexpr int kPerDecade = 3;
  for (const double tau : averaging_times(config.study, kPerDecade)) {
    j["allan"]["tau_s"].push_back(tau);
    j["allan"]["deviation"].push_back(allan_deviation(truth, config.study.interval, tau));
  }
  return j;
}

}  // namespace

std::vector<std::size_t> times_chosen(const EstimatorStudyConfig& config, const EstimatorStudyOutcome& outcome) {
  std::vector<std::size_t> times(config.study.choices.size(), 0);
  for (const std::size_t which : outcome.result.chosen) ++times[which];
  return times;
}

std::vector<double> averaging_times(const noise::EstimatorStudy& study, int per_decade) {
  constexpr double kFewestAverages = 3.0;
  const double last = static_cast<double>(study.samples) * study.interval / kFewestAverages;
  std::vector<double> times;
  for (int i = 0;; ++i) {
    const double tau = study.interval * std::pow(10.0, static_cast<double>(i) / per_decade);
    if (tau > last) return times;
    times.push_back(tau);
  }
}

double allan_deviation(const noise::StudyTruth& truth, double interval, double tau) {
  const auto processes = truth.model.processes(truth.u, {noise::Sensor::kGyro, interval});
  // IEEE Std 952-1997 annex C: a ramp R t has the deviation R tau / sqrt(2).
  return std::hypot(std::sqrt(noise::allan_variance(processes, tau)), truth.slope * tau / std::sqrt(2.0));
}

std::string estimator_study_json(const EstimatorStudyConfig& config, const EstimatorStudyOutcome& outcome) {
  const noise::EstimatorStudy& study = config.study;
  Json j = {{"schema", "coast.estimator_study_result/1"},
            {"title", config.title},
            {"interval_s", study.interval},
            {"samples", study.samples},
            {"runs", study.runs},
            {"first_seed", study.first_seed}};
  j["truth"] = truth_json(config, study.truth);
  j["truth"]["level"] = study.truth.level;
  j["truth"]["slope"] = study.truth.slope;
  for (std::size_t e = 0; e < study.estimators.size(); ++e) j["estimators"].push_back(estimator_json(config, outcome, e));
  const std::vector<std::size_t> times = times_chosen(config, outcome);
  for (std::size_t i = 0; i < times.size(); ++i)
    j["choices"].push_back({{"model", study.choices[i].name()},
                            {"runs", times[i]},
                            {"share", static_cast<double>(times[i]) / static_cast<double>(study.runs)}});
  for (const StudyReading& reading : config.readings) {
    Json r = {{"name", reading.name}};
    r.update(truth_json(config, reading.truth));
    j["readings"].push_back(std::move(r));
  }
  return j.dump(1) + "\n";
}

std::string estimator_study_text(const EstimatorStudyConfig& config, const EstimatorStudyOutcome& outcome) {
  std::string text = fmt::format("{}: {} runs of {} samples of {}\n", config.title, config.study.runs, config.study.samples,
                                 config.study.truth.model.name());
  for (std::size_t e = 0; e < outcome.summaries.size(); ++e) {
    const noise::EstimatorSummary& summary = outcome.summaries[e];
    text += fmt::format("{} ({}): log-likelihood short by {:.2g} in the mean, {:.2g} at most; {:.3f} s a run\n",
                        config.study.estimators[e].name, config.study.estimators[e].model.name(), summary.mean_shortfall,
                        summary.largest_shortfall, summary.median_seconds);
    for (const noise::ParameterSummary& p : summary.parameters) {
      text += fmt::format("  {:<24} {:>10.4g} +- {:<10.3g}", p.name, p.mean, p.sd);
      if (p.truth) text += fmt::format(" true {:.4g}", *p.truth);
      if (p.bound && std::isfinite(*p.bound)) text += fmt::format(", bound {:.3g}", *p.bound);
      if (p.zero && *p.zero > 0.0) text += fmt::format(", zero in {:.1f} %", 100.0 * *p.zero);
      if (p.coverage) text += fmt::format(", 95 % intervals hold {:.1f} %", 100.0 * p.coverage->share());
      text += "\n";
    }
    if (summary.pooled)
      text += fmt::format("  all 95 % intervals of processes hold {:.1f} %\n", 100.0 * summary.pooled->share());
  }
  const std::vector<std::size_t> times = times_chosen(config, outcome);
  for (std::size_t i = 0; i < times.size(); ++i)
    text += fmt::format("BIC chose {:<32} in {} of {} runs\n", config.study.choices[i].name(), times[i], config.study.runs);
  return text;
}

}  // namespace coast::jobs
