#include "coast/noise/calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "calibration_checks.hpp"
#include "candidate.hpp"
#include "coast/geo/units.hpp"
#include "coast/noise/chi_square.hpp"
#include "coast/parallel.hpp"
#include "coast/record/error.hpp"
#include "contradiction.hpp"
#include "model_search.hpp"
#include "resolution.hpp"
#include "warm_up.hpp"
#include "work_progress.hpp"

namespace coast::noise {

namespace {

/// Positions of the outliers in the values of a record.
std::vector<std::size_t> places_of(const std::vector<Outlier>& outliers, const StaticSignal& signal, std::size_t record) {
  std::vector<std::size_t> places;
  for (const Outlier& outlier : outliers) {
    if (outlier.record != record) continue;
    const auto at = static_cast<std::uint64_t>(std::llround(outlier.time_s / signal.interval));
    const auto run = std::ranges::upper_bound(signal.runs, at, {}, &StaticSignal::Run::start) - 1;
    places.push_back(run->first + static_cast<std::size_t>(at - run->start));
  }
  return places;
}

/// If a step of the sensor is several sigma, every sample off the commonest value looks like an outlier, and without these
/// nothing varies: then they are signal.
bool leave_a_constant(const std::vector<Outlier>& outliers, const std::vector<StaticSignal>& records) {
  for (std::size_t r = 0; r < records.size(); ++r) {
    const StaticSignal rest = without(records[r], places_of(outliers, records[r], r));
    if (rest.values.empty() || std::ranges::min(rest.values) == std::ranges::max(rest.values)) return true;
  }
  return false;
}

bool to_be_excluded(const std::vector<Outlier>& outliers, const std::vector<StaticSignal>& records, Outliers what) {
  if (leave_a_constant(outliers, records)) return false;
  constexpr double kMatters = 0.01;  // of the sum of squares, whose expectation is the number of samples
  if (what != Outliers::kWhereTheyMatter) return what == Outliers::kExclude;
  double squares = 0.0;
  for (const Outlier& outlier : outliers) squares += outlier.sigmas * outlier.sigmas;
  double samples = 0.0;
  for (const StaticSignal& record : records) samples += static_cast<double>(record.values.size());
  return squares > kMatters * samples;
}

/// Each time a smaller sigma may reveal further outliers. @param search  the estimation, again
void leave_out_outliers(std::vector<StaticSignal>& records, Outliers what, const std::function<void()>& search,
                        AxisCalibration& result) {
  constexpr int kRounds = 3;
  for (int round = 0;; ++round) {
    std::vector<Outlier> found = outliers_of(Likelihood(records, result.best().model), result.best().fit.u);
    const bool excluded = round < kRounds && !found.empty() && to_be_excluded(found, records, what);
    for (Outlier& outlier : found) outlier.excluded = excluded;
    result.outliers.insert(result.outliers.end(), found.begin(), found.end());
    if (!excluded) return;
    for (std::size_t r = 0; r < records.size(); ++r) {
      records[r] = without(records[r], places_of(found, records[r], r));
      result.curves[r] = allan_curve(records[r]);
    }
    search();
  }
}

AllanCurve detrended_curve(const StaticSignal& signal) {
  return allan_curve(detrend(signal).signal);
}

std::vector<Fit> fit_each(const std::vector<StaticSignal>& records, const Candidate& joint) {
  std::vector<Fit> own;
  if (records.size() < 2) return own;
  for (const StaticSignal& record : records)
    own.push_back(fit_maximum_likelihood(Likelihood({record}, joint.model), joint.fit.u));
  return own;
}

/// One set of parameters for all records against one for each: likelihood ratio, chi-square.
std::optional<double> test_of_common_parameters(const std::vector<Fit>& records, const Candidate& joint) {
  if (records.size() < 2) return {};
  double separate = 0.0;
  for (const Fit& record : records) separate += record.log_likelihood;
  const double ratio = 2.0 * (separate - joint.fit.log_likelihood);
  const auto dof = static_cast<double>(joint.model.parameters() * (records.size() - 1));
  return chi2_survival(dof, std::max(0.0, ratio));
}

/// 95 % interval from refits to realisations of the estimate, in logarithms about the estimate.
void bootstrap_intervals(const Likelihood& likelihood, const Fit& fit, const CalibrationOptions& options,
                         std::vector<ParameterEstimate>& parameters) {
  const SumModel& model = likelihood.model();
  const auto count = static_cast<std::size_t>(options.bootstrap);
  std::vector<std::vector<double>> refits(count);
  coast::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    std::vector<StaticSignal> drawn;
    for (std::size_t r = 0; r < likelihood.records().size(); ++r) {
      StaticSignal signal = likelihood.records()[r].signal;  // the same holes
      const StaticSignal whole =
          realisation(model, fit.u, signal.interval, signal.length(), options.seed + 1000003ULL * (i + 1) + r);
      for (const StaticSignal::Run& run : signal.runs)
        std::copy_n(whole.values.begin() + static_cast<std::ptrdiff_t>(run.start), run.count,
                    signal.values.begin() + static_cast<std::ptrdiff_t>(run.first));
      drawn.push_back(std::move(signal));
    }
    refits[i] = fit_maximum_likelihood(Likelihood(drawn, model), fit.u).u;
  });
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    std::vector<double> off;
    for (const auto& u : refits) off.push_back(u[p] - fit.u[p]);
    std::ranges::sort(off);
    const auto quantile = [&](double q) {
      return off[static_cast<std::size_t>(std::lround(q * static_cast<double>(off.size() - 1)))];
    };
    // Basic bootstrap: the estimate relates to the truth as the refits to the estimate.
    parameters[p].lower = model.parameter(p).value(fit.u[p] - quantile(0.975));
    parameters[p].upper = model.parameter(p).value(fit.u[p] - quantile(0.025));
  }
}

/// For comparison; for a large sum or a long record EM gives nothing new and takes minutes.
std::optional<Fit> first_passes_of_em(const std::vector<StaticSignal>& records, const Likelihood& likelihood) {
  constexpr int kPasses = 20;
  constexpr double kSamples = 4e6;  // of all passes
  constexpr Eigen::Index kStates = 6;
  const int passes = std::min(kPasses, static_cast<int>(kSamples / likelihood.samples()));
  if (likelihood.model().states() > kStates || passes < 1) return {};
  const std::vector<double> start =
      fit_curve(detrended_curve(records.front()), likelihood.model(), likelihood.scale(), CurveFit::kWaveletMoments);
  return fit_em(likelihood, start, {.iterations = passes});
}

/// Trends that are not part of the processes.
void remark_on_trends(const AxisCalibration& result, Sensor sensor, std::vector<std::string>& remarks) {
  const char* unit = sensor == Sensor::kGyro ? "rad/s" : "m/s^2";
  const auto place = [&](std::size_t record) {
    return result.means.size() > 1 ? fmt::format("Record {}: ", record + 1) : std::string();
  };
  for (const WarmUp& w : result.warm_ups)
    remarks.push_back(
        fmt::format("{}An exponential trend of {:.3g} {} with a time constant of {:.3g} s from the start on, as of a "
                    "sensor that warms up (log-likelihood {:.1f} better with it). It is subtracted: the model describes "
                    "the record without it, and not the next warm-up.",
                    place(w.record), w.amplitude, unit, w.time_constant, w.gain));
  constexpr double kTold = 2.0;  // standard deviations
  for (std::size_t r = 0; r < result.means.size(); ++r) {
    const MeanEstimate& mean = result.means[r];
    if (mean.value.size() < 2 || std::abs(mean.value(1)) < kTold * std::sqrt(mean.covariance(1, 1))) continue;
    remarks.push_back(
        fmt::format("{}A linear trend of {:.3g} {} per hour, with a standard deviation of {:.2g}. The processes "
                    "describe the record without it.",
                    place(r), geo::kHour * mean.value(1), unit, geo::kHour * std::sqrt(mean.covariance(1, 1))));
  }
}

/// Reasons to doubt an estimate independent of its interval.
void remark_on_the_fit(const std::vector<StaticSignal>& records, const Fit& fit, Sensor sensor,
                       std::vector<std::string>& remarks) {
  if (!fit.converged)
    remarks.emplace_back(
        "The fit did NOT CONVERGE: its values are doubtful. A sum of fewer processes, or a longer record, is likelier to "
        "converge.");
  for (const StaticSignal& record : records) {
    const Resolution resolution = resolution_of(record);
    if (!resolution.hides_the_noise()) continue;
    remarks.push_back(
        fmt::format("The sensor's output has steps of {:.3g} {}, {:.1f} times what changes from sample to sample: the white "
                    "noise told here is "
                    "what the rounding leaves of it. A smaller measuring range, or raw output without the device's own filter, "
                    "shows the sensor's.",
                    resolution.step, sensor == Sensor::kGyro ? "rad/s" : "m/s^2", resolution.step / resolution.scatter));
    return;
  }
}

}  // namespace

AxisCalibration calibrate(const std::vector<StaticSignal>& given, const CalibrationOptions& wanted) {
  const auto began = std::chrono::steady_clock::now();
  WorkProgress work(wanted.progress);
  CalibrationOptions options = wanted;
  options.progress = [&work](const char* what, double fraction) { work(what, fraction); };
  for (const StaticSignal& record : given) check_record(record);
  AxisCalibration result;
  std::vector<StaticSignal> records = given;
  for (const StaticSignal& record : records) result.curves.push_back(allan_curve(record));
  result.reading = read_coefficients(result.curves.front());
  const auto search = [&] {
    work.begin(0.5);
    result.candidates = fit_candidates(records, detrended_curve(records.front()), options);
    result.chosen = choose(result.candidates, options.criterion);
  };
  search();
  if (result.warm_ups = warm_ups_of(records, result.best()); !result.warm_ups.empty()) {
    records = without_warm_ups(std::move(records), result.warm_ups);
    for (const WarmUp& w : result.warm_ups) result.curves[w.record] = allan_curve(records[w.record]);
    search();
  }
  leave_out_outliers(records, options.outliers, search, result);
  result.band = settle_contradiction(records, result.curves.front(), options, result.candidates, result.chosen, work);
  Candidate& best = result.candidates[result.chosen];
  const Likelihood likelihood(records, best.model);
  work.begin(1.0);
  work("intervals", 0.0);
  result.em = first_passes_of_em(records, likelihood);
  work("intervals", 0.3);
  result.means = likelihood.value(best.fit.u).means;
  result.mean_intervals = mean_intervals(likelihood, best.fit);
  work("intervals", 0.6);
  const Eigen::MatrixXd information = record_information(likelihood, best.fit.u);
  double duration = 0.0;
  for (const StaticSignal& record : records) duration += record.duration();
  const Eigen::MatrixXd covariance = cramer_rao(information);
  result.parameters = parameters_of(likelihood, best.fit, covariance, options);
  if (options.bootstrap > 0) bootstrap_intervals(likelihood, best.fit, options, result.parameters);
  result.combinations = combinations_of(best.model, information);
  result.remarks = remarks_of(best.model, result.parameters, covariance, duration);
  remark_on_trends(result, options.sensor, result.remarks);
  for (const ProcessPtr& process : best.model.processes(best.fit.u, {options.sensor, records.front().interval}))
    if (const std::string words = process->in_words(); !words.empty()) result.remarks.push_back(words + ".");
  remark_on_the_fit(given, best.fit, options.sensor, result.remarks);
  result.whiteness = whiteness_of(likelihood.standardised_innovations(best.fit.u, 0), static_cast<int>(best.fit.u.size()));
  result.own = fit_each(records, best);
  result.common_parameters_p = test_of_common_parameters(result.own, best);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return result;
}

}  // namespace coast::noise
