#include "coast/noise/estimator_study.hpp"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <random>

#include "candidate.hpp"
#include "coast/noise/calibration.hpp"
#include "coast/parallel.hpp"

namespace coast::noise {

namespace {

class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
  }

 private:
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};

/// One record with the start values of all estimators.
struct Run {
  std::size_t number = 0;
  StaticSignal signal;
  AllanCurve curve;  ///< level and slope subtracted
  double curve_seconds = 0.0;
};

void add_ramp(StaticSignal& signal, double level, double slope) {
  for (std::size_t i = 0; i < signal.values.size(); ++i)
    signal.values[i] += level + slope * signal.interval * static_cast<double>(i);
}

Run draw(const EstimatorStudy& study, std::size_t number) {
  Run run;
  run.number = number;
  run.signal = realisation(study.truth.model, study.truth.u, study.interval, study.samples, study.first_seed + number);
  add_ramp(run.signal, study.truth.level, study.truth.slope);
  const Stopwatch watch;
  run.curve = allan_curve(detrend(run.signal).signal);
  run.curve_seconds = watch.seconds();
  return run;
}

/// The best maximum likelihood from the truth and from starts about it, with a standard deviation of a factor e.
Fit best_of_starts(const Likelihood& likelihood, const std::vector<double>& curve_start, const EstimatorStudy& study,
                   const StudiedEstimator& estimator, std::uint64_t seed) {
  std::vector<double> centre = curve_start;
  const std::vector<std::optional<double>> truth = truth_in(likelihood.model(), study.truth);
  for (std::size_t i = 0; i < centre.size(); ++i) centre[i] = truth[i].value_or(centre[i]);
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  Fit best = fit_maximum_likelihood(likelihood, centre);
  for (int start = 1; start < estimator.starts; ++start) {
    std::vector<double> u = centre;
    for (double& value : u) value += normal(generator);
    Fit fit = fit_maximum_likelihood(likelihood, u);
    fit.passes += best.passes;
    if (fit.log_likelihood > best.log_likelihood)
      best = std::move(fit);
    else
      best.passes = fit.passes;
  }
  return best;
}

Fit estimate(const EstimatorStudy& study, const StudiedEstimator& estimator, const Likelihood& likelihood, const Run& run) {
  const auto from_curve = [&](CurveFit kind) { return fit_curve(run.curve, likelihood.model(), likelihood.scale(), kind); };
  constexpr std::uint64_t kApart = 0x9E3779B97F4A7C15ULL;  // starts must not use the seed of a record
  Fit fit;
  switch (estimator.kind) {
    case Estimator::kEm:
      return fit_em(likelihood, estimator.start, {.iterations = estimator.iterations});
    case Estimator::kDefault:
      return fit_maximum_likelihood(likelihood, from_curve(CurveFit::kWaveletMoments));
    case Estimator::kBestOfStarts:
      return best_of_starts(likelihood, from_curve(CurveFit::kWaveletMoments), study, estimator,
                            study.first_seed + run.number + kApart);
    case Estimator::kWaveletMoments:
      fit.u = from_curve(CurveFit::kWaveletMoments);
      break;
    case Estimator::kAllan:
      fit.u = from_curve(CurveFit::kAllan);
      break;
  }
  fit.converged = true;
  return fit;
}

/// Variances whose removal costs almost nothing.
std::vector<bool> zeros_of(const Likelihood& likelihood, const std::vector<double>& u, double log_likelihood) {
  constexpr double kNothing = 1e-3;  // of log-likelihood: a variance with any effect costs half or more
  const std::vector<Interval> ranges = likelihood.model().ranges(likelihood.scale());
  std::vector<bool> zero(u.size(), false);
  for (std::size_t i = 0; i < u.size(); ++i) {
    if (likelihood.model().parameter(i).kind != ParameterInfo::Kind::kVariance) continue;
    std::vector<double> without = u;
    without[i] = std::min(u[i], ranges[i].lower);
    zero[i] = log_likelihood - likelihood.value(without).log_likelihood < kNothing;
  }
  return zero;
}

StudyFit fit_run(const EstimatorStudy& study, const StudiedEstimator& estimator, const Run& run) {
  const Likelihood likelihood({run.signal}, estimator.model);
  const Stopwatch watch;
  Fit fit = estimate(study, estimator, likelihood, run);
  StudyFit result;
  result.seconds = watch.seconds() + (estimator.kind == Estimator::kEm ? 0.0 : run.curve_seconds);
  result.iterations = static_cast<int>(fit.trace.size());
  result.passes = fit.passes;
  result.converged = fit.converged;
  if (run.number == 0) result.trace = fit.trace;
  fit.u = in_order(estimator.model, fit.u);
  const LikelihoodValue at = likelihood.value(fit.u);
  result.log_likelihood = fit.log_likelihood = at.log_likelihood;
  if (!at.means.empty()) result.mean.assign(at.means.front().value.begin(), at.means.front().value.end());
  result.zero = zeros_of(likelihood, fit.u, fit.log_likelihood);
  if (estimator.intervals) {
    result.intervals = profile_intervals(likelihood, fit);
    const std::vector<ProfileInterval> of_mean = mean_intervals(likelihood, fit).front();
    result.intervals.insert(result.intervals.end(), of_mean.begin(), of_mean.end());
  }
  result.u = std::move(fit.u);
  return result;
}

std::size_t choice_of(const EstimatorStudy& study, const Run& run) {
  std::vector<Candidate> candidates;
  for (const SumModel& model : study.choices) candidates.push_back(fit_candidate({run.signal}, run.curve, model, {}));
  return choose(candidates, Criterion::kBic);
}

Restitution restitution_of(const EstimatorStudy& study, const StudyFit& fit, const Run& run) {
  Restitution result;
  result.record = allan_curve(run.signal);
  const SumModel& model = study.estimators[study.restitution.estimator].model;
  for (std::size_t i = 0; i < study.restitution.realisations; ++i) {
    const std::uint64_t seed = study.first_seed + run.number + 1000003ULL * (i + 1);
    StaticSignal drawn = realisation(model, fit.u, study.interval, study.samples, seed);
    if (fit.mean.size() > 1) add_ramp(drawn, 0.0, fit.mean[1]);
    std::vector<double> deviations;
    for (const AllanPoint& point : allan_curve(drawn)) deviations.push_back(point.allan.value);
    result.realisations.push_back(std::move(deviations));
  }
  return result;
}

void check(const EstimatorStudy& study) {
  constexpr std::uint64_t kFewestSamples = 100;
  const auto refuse = [](const std::string& what) { throw std::invalid_argument("run_estimator_study: " + what); };
  if (study.runs == 0) refuse("no runs");
  if (study.samples < kFewestSamples) refuse(fmt::format("{} samples, at least {} expected", study.samples, kFewestSamples));
  if (!(study.interval > 0.0)) refuse(fmt::format("an interval of {} s", study.interval));
  for (const StudiedEstimator& estimator : study.estimators)
    if (estimator.kind == Estimator::kEm && estimator.start.size() != estimator.model.parameters())
      refuse(fmt::format("{}: a start of {} parameters, {} expected", estimator.name, estimator.start.size(),
                         estimator.model.parameters()));
  if (study.restitution.runs > study.runs ||
      (study.restitution.runs > 0 && study.restitution.estimator >= study.estimators.size()))
    refuse("restitution of a run or of an estimator that does not exist");
}

}  // namespace

EstimatorStudyResult run_estimator_study(const EstimatorStudy& study, const std::function<void(double)>& progress) {
  check(study);
  EstimatorStudyResult result;
  result.fits.assign(study.estimators.size(), std::vector<StudyFit>(study.runs));
  if (!study.choices.empty()) result.chosen.resize(study.runs);
  result.restitution.resize(study.restitution.runs);
  std::atomic<std::size_t> done = 0;
  coast::parallel_for(std::size_t{0}, study.runs, [&](std::size_t number) {
    const Run run = draw(study, number);
    for (std::size_t e = 0; e < study.estimators.size(); ++e) result.fits[e][number] = fit_run(study, study.estimators[e], run);
    if (!study.choices.empty()) result.chosen[number] = choice_of(study, run);
    if (number < study.restitution.runs)
      result.restitution[number] = restitution_of(study, result.fits[study.restitution.estimator][number], run);
    if (progress) progress(static_cast<double>(++done) / static_cast<double>(study.runs));
  });
  return result;
}

}  // namespace coast::noise
