#include "model_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "coast/record/error.hpp"
#include "polish.hpp"

namespace coast::noise {

namespace {

/// A process that the record does not want: without its variance the likelihood is the same, or its rate has gone to where it
/// is another process.
bool says_nothing(const ShortLikelihood& likelihood, const std::vector<Interval>& ranges, const SumModel& model,
                  const std::vector<double>& u) {
  constexpr double kAtEnd = 1e-6;
  constexpr double kNothing = 0.02;  // of log-likelihood
  const double value = likelihood.value(u);
  for (std::size_t i = 0; i < u.size(); ++i) {
    const ParameterInfo::Kind kind = model.parameter(i).kind;
    if (kind == ParameterInfo::Kind::kRate && (u[i] < ranges[i].lower + kAtEnd || u[i] > ranges[i].upper - kAtEnd)) return true;
    if (kind != ParameterInfo::Kind::kVariance) continue;
    std::vector<double> without = u;
    without[i] = ranges[i].lower;
    if (value - likelihood.value(without) < kNothing) return true;
  }
  return false;
}

void score(const Likelihood& likelihood, Candidate& candidate) {
  const double n = likelihood.samples();
  candidate.parameters = static_cast<int>(candidate.model.parameters()) +
                         coefficients(candidate.model.mean()) * static_cast<int>(likelihood.records().size());
  const auto k = static_cast<double>(candidate.parameters);
  candidate.bic = -2.0 * candidate.at_mean + k * std::log(n);
  candidate.aicc = -2.0 * candidate.at_mean + 2.0 * k + 2.0 * k * (k + 1.0) / std::max(1.0, n - k - 1.0);
}

/// Each half scored with what the other was fitted to.
double held_out_score(const std::vector<StaticSignal>& records, const SumModel& model, const std::vector<double>& u) {
  double sum = 0.0;
  double samples = 0.0;
  for (const StaticSignal& record : records) {
    const std::uint64_t half = record.length() / 2;
    const StaticSignal parts[] = {part_of(record, 0, half), part_of(record, half, record.length() - half)};
    for (const std::size_t fitted : {std::size_t{0}, std::size_t{1}}) {
      const Fit fit = fit_maximum_likelihood(Likelihood({parts[fitted]}, model), u);
      const Likelihood other({parts[1 - fitted]}, model);
      sum += other.value(fit.u).at_mean;
      samples += other.samples();
    }
  }
  return sum / samples;
}

/// The sums to be tried: white noise with k Gauss-Markov processes, with and without walk, quantisation and drift.
std::vector<SumModel> sums_to_try(const CalibrationOptions& options) {
  std::vector<SumModel> sums;
  const auto named = [](const std::vector<std::string>& names) {
    std::vector<const Estimable*> processes;
    for (const std::string& name : names) processes.push_back(&estimable(name));
    return processes;
  };
  if (!options.processes.empty()) return {SumModel(named(options.processes), options.mean)};
  for (int k = 0; k <= options.most_gauss_markov; ++k)
    for (const bool walk : {false, true})
      for (const bool quantised : {false, true})
        for (const Mean mean : {Mean::kLevel, Mean::kLevelAndDrift}) {
          std::vector<std::string> names{"white_noise"};
          names.insert(names.end(), static_cast<std::size_t>(k), "gauss_markov");
          if (walk) names.emplace_back("random_walk");
          if (quantised) names.emplace_back("quantisation");
          sums.emplace_back(named(names), mean);
        }
  return sums;
}

/// Every process of `part` is in `whole`, which has more.
bool is_part_of(const SumModel& part, const SumModel& whole) {
  if (part.mean() != whole.mean() || part.terms().size() >= whole.terms().size()) return false;
  const auto count = [](const SumModel& model, const Estimable* process) {
    return std::ranges::count(model.terms(), process, &SumModel::Term::process);
  };
  return std::ranges::all_of(
      part.terms(), [&](const SumModel::Term& term) { return count(part, term.process) <= count(whole, term.process); });
}

/// What smaller sums found, with the process that is new at next to nothing, or in the middle of its range.
std::vector<std::vector<double>> starts_from(const std::vector<Candidate>& smaller, const SumModel& model,
                                             const SignalScale& scale) {
  std::vector<std::vector<double>> starts;
  const std::vector<Interval> ranges = model.ranges(scale);
  for (const Candidate& candidate : smaller) {
    if (candidate.model.terms().size() + 1 < model.terms().size() || candidate.degenerate) continue;
    std::vector<double> u(model.parameters());
    for (std::size_t i = 0; i < u.size(); ++i) {
      const bool variance = model.parameter(i).kind == ParameterInfo::Kind::kVariance;
      u[i] = variance ? ranges[i].upper - 15.0 : 0.5 * (ranges[i].lower + ranges[i].upper);
    }
    std::size_t matched = 0;
    std::vector<bool> taken(model.terms().size(), false);
    for (const SumModel::Term& from : candidate.model.terms())
      for (std::size_t t = 0; t < model.terms().size(); ++t) {
        const SumModel::Term& to = model.terms()[t];
        if (taken[t] || to.process != from.process) continue;
        std::copy_n(candidate.fit.u.begin() + static_cast<std::ptrdiff_t>(from.parameter), from.parameters,
                    u.begin() + static_cast<std::ptrdiff_t>(to.parameter));
        taken[t] = true;
        ++matched;
        break;
      }
    if (matched == candidate.model.terms().size()) starts.push_back(std::move(u));
  }
  return starts;
}

/// Of a sum with a process that is not there, the likelihood is that of the sum without it.
void take_from_smaller(const std::vector<Candidate>& smaller, const std::vector<StaticSignal>& records, Candidate& candidate) {
  const Candidate* best = nullptr;
  for (const Candidate& other : smaller)
    if (is_part_of(other.model, candidate.model) && (best == nullptr || other.fit.log_likelihood > best->fit.log_likelihood))
      best = &other;
  if (best == nullptr) return;
  candidate.fit.log_likelihood = best->fit.log_likelihood;
  candidate.at_mean = best->at_mean;
  score(Likelihood(records, candidate.model), candidate);
}

}  // namespace

Candidate fit_candidate(const std::vector<StaticSignal>& records, const AllanCurve& curve, const SumModel& model,
                        const std::vector<std::vector<double>>& starts) {
  constexpr double kTableTolerance = 1e-3;
  Candidate candidate;
  candidate.model = model;
  const Likelihood likelihood(records, model);
  const ShortLikelihood shortened(likelihood);
  const SignalScale scale = likelihood.scale();
  std::vector<double> best = fit_curve(curve, model, scale, CurveFit::kWaveletMoments);
  double value = shortened.value(best);
  for (const std::vector<double>& start : starts) {
    const double there = shortened.value(start);
    if (!(there > value)) continue;
    value = there;
    best = start;
  }
  candidate.fit = fit_maximum_likelihood(likelihood, best, {.polished = shortened.is_whole()});
  candidate.degenerate = says_nothing(shortened, model.ranges(scale), model, candidate.fit.u);
  if (!candidate.degenerate && !shortened.is_whole()) {
    Fit& fit = candidate.fit;
    polish([&](const std::vector<double>& u) { return likelihood.slope(u); }, model, box_of(likelihood, fit.u, {}),
           excess_curvature(shortened, fit.u), kTableTolerance, fit);
  }
  candidate.at_mean = likelihood.value(candidate.fit.u).at_mean;
  score(likelihood, candidate);
  return candidate;
}

std::vector<Candidate> fit_candidates(const std::vector<StaticSignal>& records, const AllanCurve& curve,
                                      const CalibrationOptions& options) {
  const std::vector<SumModel> sums = sums_to_try(options);
  const SignalScale scale = Likelihood(records, sums.front()).scale();
  std::vector<Candidate> candidates;
  for (const SumModel& model : sums) {
    if (options.progress)
      options.progress("fitting sums of processes", static_cast<double>(candidates.size()) / static_cast<double>(sums.size()));
    candidates.push_back(fit_candidate(records, curve, model, starts_from(candidates, model, scale)));
    Candidate& last = candidates.back();
    if (last.degenerate) take_from_smaller(candidates, records, last);
    if (!last.degenerate && (options.held_out || options.criterion == Criterion::kHeldOut))
      last.held_out = held_out_score(records, model, last.fit.u);
  }
  return candidates;
}

std::size_t choose(const std::vector<Candidate>& candidates, Criterion criterion) {
  const auto cost = [&](const Candidate& c) {
    if (!std::isfinite(c.fit.log_likelihood)) return std::numeric_limits<double>::infinity();
    if (criterion == Criterion::kHeldOut) return c.held_out ? -*c.held_out : std::numeric_limits<double>::infinity();
    return criterion == Criterion::kBic ? c.bic : c.aicc;
  };
  std::size_t best = 0;
  for (std::size_t i = 1; i < candidates.size(); ++i) {
    const Candidate& a = candidates[i];
    const Candidate& b = candidates[best];
    if (a.degenerate != b.degenerate ? b.degenerate : cost(a) < cost(b)) best = i;
  }
  if (!std::isfinite(cost(candidates[best])))
    throw NumericalError("no sum of processes has a finite likelihood", "", "is the signal constant?");
  return best;
}

}  // namespace coast::noise
