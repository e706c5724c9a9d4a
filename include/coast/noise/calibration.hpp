#pragma once
// From a static record to an error model of one axis: model choice, estimates, intervals, checks.

#include <functional>
#include <string>
#include <vector>

#include "coast/noise/uncertainty.hpp"

namespace coast::noise {

enum class Criterion { kBic, kAicc, kHeldOut };
/// Treatment of outliers: left out with a new estimation if they contribute more than a hundredth of the sum of squared
/// innovations; always kept; always left out.
enum class Outliers { kWhereTheyMatter, kKeep, kExclude };

struct CalibrationOptions {
  Sensor sensor = Sensor::kGyro;
  /// Names of the registry; empty: stepwise search, from white noise and a level, over sums with up to `most_gauss_markov`
  /// Gauss-Markov processes, random walk, flicker, quantisation, drift, an autoregression instead of white noise (the sensor's
  /// own filter), and further AR(2) if the innovations have power in a narrow band (vibration of the support).
  std::vector<std::string> processes = {};
  Mean mean = Mean::kLevelAndDrift;  ///< used with `processes`
  int most_gauss_markov = 3;
  Criterion criterion = Criterion::kBic;
  Outliers outliers = Outliers::kWhereTheyMatter;
  bool held_out = false;   ///< score every candidate on the half it was not fitted to; implied by kHeldOut
  int realisations = 100;  ///< simulated from the estimate, for the band of its Allan curve; 0: no band
  int bootstrap = 0;       ///< parametric refits for intervals instead of the profile likelihood's
  std::uint64_t seed = 1;
  /// Of the whole estimation, at about the pace of the work; never falls.
  std::function<void(const char* what, double fraction)> progress = {};
};

/// One sum of processes, fitted.
struct Candidate {
  SumModel model;
  Fit fit;  ///< for the chosen candidate, to all samples
  /// Used by the criteria: log-likelihood maximised over level and drift (that of `fit` is restricted, and cannot compare sums
  /// that differ in their mean). For a record beyond 40 000 samples it is from 4000 block means and the first 8000 samples,
  /// unless `on_all_samples` is set.
  double compared_log_likelihood = 0.0;
  int parameters = 0;  ///< of the processes and of the means
  /// Of each parameter of the processes: number of independent squares that would determine it equally well, 2/variance of its
  /// logarithm. For white noise that is the number of samples, for a slow process about the number of its correlation times.
  std::vector<double> independent = {};
  /// -2 log L + the cost of each parameter: log(independent), at least 6.63, for Gauss-Markov, random walk and flicker (flicker
  /// another 6.63); log(samples) for all others and for each coefficient of the means (docs/decisions/0011).
  double bic = 0.0;
  double aicc = 0.0;
  std::optional<double> held_out;  ///< log-likelihood per sample on halves that were not fitted
  bool on_all_samples = false;     ///< the compared value is from all samples; false: from extracts
  bool degenerate = false;         ///< a variance went to zero: equivalent to the sum without that process
};

struct ParameterEstimate {
  std::string name;  ///< "gauss_markov beta 2"
  std::string unit;
  double value = 0.0;
  double relative_bound = 0.0;  ///< Cramer-Rao standard deviation of log(value); infinite: not determined
  std::optional<double> lower;  ///< 95 %; absent: not bounded by the record
  std::optional<double> upper;
  double duration_for_quarter = 0.0;  ///< record length needed to determine it to 25 %, s
};

/// A product of powers of parameters: an eigenvector of the information matrix.
struct Combination {
  std::string text;  ///< "gauss_markov beta 1 * gauss_markov sigma2 1"
  double relative_sd = 0.0;
};

/// A sample so large that only one clean record in a hundred would contain one.
struct Outlier {
  std::size_t record = 0;
  double time_s = 0.0;  ///< from the first sample
  double sigmas = 0.0;  ///< standardised innovation
  bool excluded = false;
};

/// An exponential trend: amplitude exp(-t/time_constant), t since the record's first sample.
struct WarmUp {
  std::size_t record = 0;
  double amplitude = 0.0;      ///< [signal]
  double time_constant = 0.0;  ///< s
  double gain = 0.0;           ///< of log-likelihood, after the sum is fitted again to the record without the trend
};

/// Portmanteau test of Ljung & Box (1978) on standardised innovations.
struct Whiteness {
  std::vector<double> autocorrelation;  ///< lags 1, 2, ...
  double p_value = 1.0;
};

/// Simultaneous 95 % band of the Allan curve of realisations from the estimate.
struct CurveBand {
  std::vector<double> tau;
  std::vector<double> lower;
  std::vector<double> median;
  std::vector<double> upper;
  bool inside = false;  ///< the record's curve is in the band at all of these averaging times
};

/// One axis, from one or several records.
struct AxisCalibration {
  std::vector<AllanCurve> curves;  ///< of each record without its warm-up, with its drift
  AllanReading reading;            ///< of the first
  std::vector<Candidate> candidates;
  std::size_t chosen = 0;
  std::optional<Fit> em;            ///< the first iterations of EM for the chosen sum, for comparison; only up to 6 states
  std::vector<MeanEstimate> means;  ///< of each record
  std::vector<std::vector<ProfileInterval>> mean_intervals;  ///< [record][coefficient]
  std::vector<ParameterEstimate> parameters;
  std::vector<Combination> combinations;  ///< from the best known to the least
  std::vector<std::string> remarks;       ///< what this record cannot tell
  std::vector<WarmUp> warm_ups;           ///< subtracted from the records before the model was estimated
  std::vector<Outlier> outliers;
  Whiteness whiteness;
  CurveBand band;
  /// Several records: p-value of one common set of parameters against one set per record.
  std::optional<double> common_parameters_p;
  std::vector<Fit> own;  ///< several records: the chosen sum fitted to each alone
  double seconds = 0.0;  ///< spent estimating

  [[nodiscard]] const Candidate& best() const { return candidates.at(chosen); }
};

/// Test of an estimate on a record that was not used for it. Only level and drift are fitted to the record.
struct RecordTest {
  double log_likelihood_per_sample = 0.0;
  double innovation_variance = 0.0;  ///< of the standardised innovations: 1 if the estimate is right
  Whiteness whiteness;
  AllanCurve curve;
  CurveBand band;  ///< of realisations as long as this record
};

/// The records less these trends: the input of the estimation.
[[nodiscard]] std::vector<StaticSignal> without_warm_ups(std::vector<StaticSignal> records,
                                                         const std::vector<WarmUp>& warm_ups);

/// A record drawn from a sum of processes, without level and drift. The same bytes for the same seed.
[[nodiscard]] StaticSignal realisation(const SumModel& model, const std::vector<double>& u, double interval,
                                       std::uint64_t length, std::uint64_t seed);

/// Smoothed estimate of each process that has states, at up to `points` times of a record.
struct SmoothedComponents {
  std::vector<double> time_s;
  struct Component {
    std::string name;  ///< "GM 1"
    std::vector<double> value;
    std::vector<double> sd;
  };
  std::vector<Component> components;
  std::vector<double> signal;  ///< the record at these times: means over the interval between points, level and drift removed
};
[[nodiscard]] SmoothedComponents smoothed_components(const Likelihood& likelihood, const std::vector<double>& u,
                                                     std::size_t record, std::size_t points);

/// @param records  of the same axis of the same sensor, at the same interval
/// @throws NumericalError  too few samples (100), or no candidate has a finite likelihood
[[nodiscard]] AxisCalibration calibrate(const std::vector<StaticSignal>& records, const CalibrationOptions& options);

/// @param record  of the sensor that `model` at `u` was estimated for, at the same interval
/// @throws NumericalError  too few samples (100), or all equal
[[nodiscard]] RecordTest test_on(const StaticSignal& record, const SumModel& model, const std::vector<double>& u,
                                 const CalibrationOptions& options);

}  // namespace coast::noise
