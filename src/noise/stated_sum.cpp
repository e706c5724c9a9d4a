#include "stated_sum.hpp"

#include <algorithm>
#include <cmath>

#include "full_fit.hpp"
#include "model_search.hpp"
#include "polish.hpp"

namespace coast::noise {

namespace {

constexpr double kWithinReach = 3.0;  // of log-likelihood: a sum further below leads to no other maximum
constexpr double kDoubt = 20.0;       // the same on extracts, which have only part of the record

/// The sum at the optimum of a sum of some of its processes: the added ones are practically zero.
std::vector<double> silent_start(const Candidate& smaller, const SumModel& model, const std::vector<Interval>& ranges) {
  std::vector<double> u = shared_start(smaller.model, smaller.fit.u, model, ranges, 0.0);
  for (std::size_t i = 0; i < u.size(); ++i)
    if (model.parameter(i).kind == ParameterInfo::Kind::kVariance && u[i] == ranges[i].upper) u[i] = ranges[i].lower;
  return u;
}

/// Sums of some of the processes first: each sum also starts from their optima.
class StatedSum {
 public:
  StatedSum(const std::vector<StaticSignal>& records, const AllanCurve& curve, const CalibrationOptions& options)
      : records_(records), curve_(curve), options_(options) {}

  Candidate run(const SumModel& model) {
    Candidate best = fitted_[on_extracts(model)];
    if (!best.on_all_samples) best = on_all_samples(best);
    if (options_.held_out || options_.criterion == Criterion::kHeldOut)
      best.held_out = held_out_score(records_, model, best.fit.u);
    return best;
  }

 private:
  /// Its index among the fitted ones. For a short record extracts are the full record.
  std::size_t on_extracts(const SumModel& model) {
    for (std::size_t i = 0; i < fitted_.size(); ++i)
      if (fitted_[i].model.name() == model.name()) return i;
    std::vector<std::size_t> below;
    for (const SumModel& sum : smaller(model))
      if (sum.mean() == model.mean()) below.push_back(on_extracts(sum));
    const Likelihood likelihood(records_, model);
    const std::vector<Interval> ranges = model.ranges(likelihood.scale());
    std::vector<std::vector<double>> starts;
    constexpr double kVariances[] = {10.0, 15.0};  // below the upper end: 3e-3 and 1e-4 of the signal
    for (const std::size_t i : below)
      for (const double variance : kVariances)
        starts.push_back(shared_start(fitted_[i].model, fitted_[i].fit.u, model, ranges, variance));
    Candidate best = fit_candidate(records_, curve_, model, starts);
    for (const std::size_t i : below) {
      if (!(fitted_[i].fit.log_likelihood > best.fit.log_likelihood)) continue;
      const Candidate from_below = fit_from(records_, model, silent_start(fitted_[i], model, ranges));
      if (from_below.fit.log_likelihood > best.fit.log_likelihood) best = from_below;
    }
    fitted_.push_back(std::move(best));
    return fitted_.size() - 1;
  }

  Candidate on_all_samples(const Candidate& extract) {
    const SumModel& model = extract.model;
    const Likelihood likelihood(records_, model);
    const std::vector<Interval> ranges = model.ranges(likelihood.scale());
    const Spectrum spectrum = spectrum_of(likelihood.records());
    const auto on_all = [&](const SumModel& sum, const std::vector<double>& u) {
      return fit_on_all_samples(records_, spectrum, sum, u, options_);
    };
    Candidate best = extract;
    best.fit = fit_maximum_likelihood(likelihood, extract.fit.u);
    for (const Candidate& candidate : fitted_) {
      if (candidate.model.name() == model.name() || candidate.fit.log_likelihood < extract.fit.log_likelihood - kDoubt)
        continue;
      const Candidate smaller = on_all(candidate.model, candidate.fit.u);
      if (smaller.fit.log_likelihood < best.fit.log_likelihood - kWithinReach) continue;
      for (const std::vector<double>& start :
           {shared_start(smaller.model, smaller.fit.u, model, ranges, 15.0), silent_start(smaller, model, ranges)}) {
        const Candidate other = on_all(model, start);
        if (other.fit.log_likelihood > best.fit.log_likelihood) best.fit = other.fit;
        if (!(smaller.fit.log_likelihood > best.fit.log_likelihood)) break;
      }
    }
    best.on_all_samples = true;
    best.compared_log_likelihood = likelihood.value(best.fit.u).at_mean;
    score(likelihood, spectral_slope(spectrum, model, best.fit.u).information, best);
    return best;
  }

  const std::vector<StaticSignal>& records_;
  const AllanCurve& curve_;
  const CalibrationOptions& options_;
  std::vector<Candidate> fitted_;
};

}  // namespace

Candidate fit_stated(const std::vector<StaticSignal>& records, const AllanCurve& curve, const SumModel& model,
                     const CalibrationOptions& options) {
  return StatedSum(records, curve, options).run(model);
}

}  // namespace coast::noise
