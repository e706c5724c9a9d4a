// Joint summary of the runs of an estimator study.

#include <algorithm>
#include <cmath>
#include <limits>

#include "coast/noise/estimator_study.hpp"

namespace coast::noise {

namespace {

constexpr double kRoot95 = 1.959963984540054;  // 97.5 % quantile of the normal distribution

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// By linear interpolation between order statistics (Hyndman and Fan 1996, definition 7).
double quantile(std::vector<double> values, double p) {
  std::ranges::sort(values);
  const double at = p * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (at - static_cast<double>(below)) * (values[above] - values[below]);
}

/// Terms of one kind, in order of position.
std::vector<const SumModel::Term*> terms_like(const SumModel& model, const Estimable* process) {
  std::vector<const SumModel::Term*> terms;
  for (const SumModel::Term& term : model.terms())
    if (term.process == process) terms.push_back(&term);
  return terms;
}

/// Whether every process and mean of `part` is in `whole`: then `whole` can be as likely.
bool contains(const SumModel& whole, const SumModel& part) {
  if (coefficients(part.mean()) > coefficients(whole.mean())) return false;
  return std::ranges::all_of(part.terms(), [&](const SumModel::Term& term) {
    return terms_like(part, term.process).size() <= terms_like(whole, term.process).size();
  });
}

/// The highest known log-likelihood of a sum on one run.
double best_known(const EstimatorStudy& study, const EstimatorStudyResult& result, const SumModel& model, std::size_t run) {
  double best = -std::numeric_limits<double>::infinity();
  for (std::size_t e = 0; e < study.estimators.size(); ++e)
    if (contains(model, study.estimators[e].model)) best = std::max(best, result.fits[e][run].log_likelihood);
  return best;
}

void spread(const std::vector<double>& values, ParameterSummary& summary) {
  summary.mean = mean_of(values);
  double squares = 0.0;
  for (const double value : values) squares += (value - summary.mean) * (value - summary.mean);
  if (values.size() > 1) summary.sd = std::sqrt(squares / static_cast<double>(values.size() - 1));
  summary.q05 = quantile(values, 0.05);
  summary.median = quantile(values, 0.5);
  summary.q95 = quantile(values, 0.95);
}

Coverage coverage_of(const std::vector<StudyFit>& fits, std::size_t parameter, double truth) {
  Coverage coverage;
  coverage.intervals = fits.size();
  for (const StudyFit& fit : fits) {
    const ProfileInterval& interval = fit.intervals[parameter];
    const bool above = !interval.lower || *interval.lower <= truth;
    if (above && (!interval.upper || *interval.upper >= truth)) ++coverage.inside;
  }
  return coverage;
}

ParameterSummary of_process(const StudiedEstimator& estimator, const std::vector<StudyFit>& fits, std::size_t i) {
  ParameterSummary summary;
  summary.name = estimator.model.parameter_name(i);
  summary.unit = estimator.model.parameter(i).unit;
  spread(values_of(estimator, fits, i), summary);
  if (estimator.model.parameter(i).kind == ParameterInfo::Kind::kVariance) {
    const auto zeros = std::ranges::count_if(fits, [&](const StudyFit& fit) { return fit.zero[i]; });
    summary.zero = static_cast<double>(zeros) / static_cast<double>(fits.size());
  }
  return summary;
}

ParameterSummary of_mean(const EstimatorStudy& study, const StudiedEstimator& estimator, const std::vector<StudyFit>& fits,
                         std::size_t which) {
  ParameterSummary summary;
  summary.name = which == 0 ? "level" : "slope";
  summary.unit = which == 0 ? "signal" : "signal/s";
  const double middle = 0.5 * static_cast<double>(study.samples - 1) * study.interval;
  const double truth = which == 0 ? study.truth.level + study.truth.slope * middle : study.truth.slope;
  summary.truth = truth;
  spread(values_of(estimator, fits, estimator.model.parameters() + which), summary);
  if (estimator.intervals) summary.coverage = coverage_of(fits, estimator.model.parameters() + which, truth);
  return summary;
}

EstimatorSummary summary_of(const EstimatorStudy& study, const EstimatorStudyResult& result, std::size_t e) {
  const StudiedEstimator& estimator = study.estimators[e];
  const std::vector<StudyFit>& fits = result.fits[e];
  const std::vector<std::optional<double>> truth = truth_in(estimator.model, study.truth);
  EstimatorSummary summary;
  for (std::size_t i = 0; i < estimator.model.parameters(); ++i) {
    ParameterSummary parameter = of_process(estimator, fits, i);
    if (truth[i]) parameter.truth = estimator.model.parameter(i).value(*truth[i]);
    if (truth[i] && estimator.intervals) {
      parameter.coverage = coverage_of(fits, i, *truth[i]);
      if (!summary.pooled) summary.pooled.emplace();
      summary.pooled->inside += parameter.coverage->inside;
      summary.pooled->intervals += parameter.coverage->intervals;
    }
    summary.parameters.push_back(std::move(parameter));
  }
  for (int k = 0; k < coefficients(estimator.model.mean()); ++k)
    summary.parameters.push_back(of_mean(study, estimator, fits, static_cast<std::size_t>(k)));
  const std::vector<double> bounds = bounds_of(estimator.model, study.truth, study.interval, study.samples);
  for (std::size_t i = 0; i < bounds.size(); ++i) summary.parameters[i].bound = bounds[i];

  std::vector<double> seconds, iterations, passes, shortfalls;
  for (std::size_t run = 0; run < fits.size(); ++run) {
    seconds.push_back(fits[run].seconds);
    iterations.push_back(fits[run].iterations);
    passes.push_back(fits[run].passes);
    shortfalls.push_back(best_known(study, result, estimator.model, run) - fits[run].log_likelihood);
  }
  summary.largest_shortfall = *std::ranges::max_element(shortfalls);
  summary.mean_shortfall = mean_of(shortfalls);
  summary.mean_iterations = mean_of(iterations);
  summary.mean_passes = mean_of(passes);
  summary.converged = static_cast<double>(std::ranges::count_if(fits, &StudyFit::converged)) / static_cast<double>(fits.size());
  summary.median_seconds = quantile(seconds, 0.5);
  summary.largest_seconds = *std::ranges::max_element(seconds);
  return summary;
}

}  // namespace

Interval Coverage::uncertainty() const {
  const auto n = static_cast<double>(intervals);
  const double z2 = kRoot95 * kRoot95;
  const double centre = (share() + z2 / (2.0 * n)) / (1.0 + z2 / n);
  const double half = kRoot95 * std::sqrt(share() * (1.0 - share()) / n + z2 / (4.0 * n * n)) / (1.0 + z2 / n);
  return {centre - half, centre + half};
}

std::vector<EstimatorSummary> summarise(const EstimatorStudy& study, const EstimatorStudyResult& result) {
  std::vector<EstimatorSummary> all;
  for (std::size_t e = 0; e < study.estimators.size(); ++e) all.push_back(summary_of(study, result, e));
  return all;
}

std::vector<double> values_of(const StudiedEstimator& estimator, const std::vector<StudyFit>& fits, std::size_t parameter) {
  const std::size_t processes = estimator.model.parameters();
  std::vector<double> values;
  for (const StudyFit& fit : fits)
    values.push_back(parameter < processes ? estimator.model.parameter(parameter).value(fit.u[parameter])
                                           : fit.mean[parameter - processes]);
  return values;
}

std::vector<double> in_order(const SumModel& model, const std::vector<double>& u) {
  std::vector<double> ordered = u;
  for (const SumModel::Term& term : model.terms()) {
    const std::vector<const SumModel::Term*> places = terms_like(model, term.process);
    if (places.front() != &term || places.size() < 2) continue;
    std::vector<const SumModel::Term*> from = places;
    std::ranges::stable_sort(from, {}, [&](const SumModel::Term* t) { return u[t->parameter]; });
    for (std::size_t k = 0; k < places.size(); ++k)
      std::copy_n(u.begin() + static_cast<std::ptrdiff_t>(from[k]->parameter), term.parameters,
                  ordered.begin() + static_cast<std::ptrdiff_t>(places[k]->parameter));
  }
  return ordered;
}

std::vector<std::optional<double>> truth_in(const SumModel& model, const StudyTruth& truth) {
  const std::vector<double> u = in_order(truth.model, truth.u);
  std::vector<std::optional<double>> values(model.parameters());
  for (const SumModel::Term& term : model.terms()) {
    const std::vector<const SumModel::Term*> places = terms_like(model, term.process);
    const std::vector<const SumModel::Term*> from = terms_like(truth.model, term.process);
    const auto k = static_cast<std::size_t>(std::ranges::find(places, &term) - places.begin());
    for (std::size_t i = 0; k < from.size() && i < term.parameters; ++i) values[term.parameter + i] = u[from[k]->parameter + i];
  }
  return values;
}

std::vector<double> bounds_of(const SumModel& model, const StudyTruth& truth, double interval, std::uint64_t samples) {
  std::vector<double> u;
  for (const std::optional<double>& value : truth_in(model, truth)) {
    if (!value) return {};
    u.push_back(*value);
  }
  const Eigen::MatrixXd covariance = cramer_rao(expected_information(model, u, interval, samples));
  std::vector<double> bounds;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const ParameterInfo info = model.parameter(i);
    const double value = info.value(u[i]);
    const double slope = info.kind == ParameterInfo::Kind::kPartial ? 1.0 - value * value : value;  // d value / d u
    bounds.push_back(slope * std::sqrt(covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i))));
  }
  // The covariance of generalised least squares does not depend on the record.
  const Likelihood nothing({StaticSignal::regular(std::vector<double>(samples, 0.0), interval)}, model);
  const LikelihoodValue at = nothing.value(u);
  for (int k = 0; k < coefficients(model.mean()); ++k) bounds.push_back(std::sqrt(at.means.front().covariance(k, k)));
  return bounds;
}

}  // namespace coast::noise
