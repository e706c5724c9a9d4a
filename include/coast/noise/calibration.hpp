#pragma once
// The whole way from a static record to an error model of one axis: model choice, estimates, intervals, checks.

#include <functional>
#include <string>
#include <vector>

#include "coast/noise/uncertainty.hpp"

namespace coast::noise {

enum class Criterion { kBic, kAicc, kHeldOut };
/// What becomes of outliers: left out, and all estimated again, where they are above a hundredth of the sum of squared
/// innovations; kept in any case; left out in any case.
enum class Outliers { kWhereTheyMatter, kKeep, kExclude };

struct CalibrationOptions {
  Sensor sensor = Sensor::kGyro;
  /// Names of the registry; empty: searched stepwise, from white noise and a level, over sums with up to `most_gauss_markov`
  /// Gauss-Markov processes, random walk, quantisation, drift, an autoregression in the place of white noise (the sensor's own
  /// filter), and further AR(2) where the innovations have power in a narrow band (vibration of what the sensor stands on).
  std::vector<std::string> processes = {};
  Mean mean = Mean::kLevelAndDrift;  ///< with `processes`
  int most_gauss_markov = 3;
  Criterion criterion = Criterion::kBic;
  Outliers outliers = Outliers::kWhereTheyMatter;
  bool held_out = false;   ///< score every candidate on the half it was not fitted to; implied by its criterion
  int realisations = 100;  ///< of the estimate, for the band of its Allan curve; 0: no band
  int bootstrap = 0;       ///< parametric refits for intervals instead of the profile likelihood's
  std::uint64_t seed = 1;
  std::function<void(const char* what, double fraction)> progress = {};
};

/// One sum of processes, fitted.
struct Candidate {
  SumModel model;
  Fit fit;  ///< of the chosen one to all samples
  /// What the criteria compare: log-likelihood maximised over level and drift (that of `fit` is restricted, and sums that
  /// differ in their mean cannot be compared by it). Of a record beyond 40 000 samples it is on 4000 block means and the first
  /// 8000 samples unless the sum got as far as `on_all_samples`.
  double compared_log_likelihood = 0.0;
  int parameters = 0;  ///< of the processes and of the means
  double bic = 0.0;
  double aicc = 0.0;
  std::optional<double> held_out;  ///< log-likelihood per sample on halves that were not fitted
  bool on_all_samples = false;     ///< what is compared; false: on extracts
  bool degenerate = false;         ///< a variance went to zero: the sum without that process says the same
};

struct ParameterEstimate {
  std::string name;  ///< "gauss_markov beta 2"
  std::string unit;
  double value = 0.0;
  double relative_bound = 0.0;  ///< Cramer-Rao standard deviation of log(value); infinite: nothing is known
  std::optional<double> lower;  ///< 95 %; absent: the record does not bound it
  std::optional<double> upper;
  double duration_for_quarter = 0.0;  ///< s of record that would be needed to know it to 25 %
};

/// A product of powers of parameters, the directions of the information matrix.
struct Combination {
  std::string text;  ///< "gauss_markov beta 1 * gauss_markov sigma2 1"
  double relative_sd = 0.0;
};

/// A sample that one clean record in a hundred would have.
struct Outlier {
  std::size_t record = 0;
  double time_s = 0.0;  ///< from the first sample
  double sigmas = 0.0;  ///< standardised innovation
  bool excluded = false;
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
  bool inside = false;  ///< the record's curve, at all of these averaging times
};

/// One axis, from one or several records.
struct AxisCalibration {
  std::vector<AllanCurve> curves;  ///< of each record as it is, with its drift
  AllanReading reading;            ///< of the first
  std::vector<Candidate> candidates;
  std::size_t chosen = 0;
  std::optional<Fit> em;            ///< the first passes of EM towards the chosen sum, for comparison; of up to 6 states
  std::vector<MeanEstimate> means;  ///< of each record
  std::vector<std::vector<ProfileInterval>> mean_intervals;  ///< [record][coefficient]
  std::vector<ParameterEstimate> parameters;
  std::vector<Combination> combinations;  ///< from the best known to the least
  std::vector<std::string> remarks;       ///< what this record cannot tell
  std::vector<Outlier> outliers;
  Whiteness whiteness;
  CurveBand band;
  /// Several records: test of one set of parameters for all against one for each.
  std::optional<double> common_parameters_p;
  std::vector<Fit> own;  ///< several records: the chosen sum fitted to each alone
  double seconds = 0.0;  ///< spent estimating

  [[nodiscard]] const Candidate& best() const { return candidates.at(chosen); }
};

/// What a record that was not estimated from says of an estimate. Only its level and drift are fitted to it.
struct RecordTest {
  double log_likelihood_per_sample = 0.0;
  double innovation_variance = 0.0;  ///< of the standardised innovations: 1 where the estimate holds
  Whiteness whiteness;
  AllanCurve curve;
  CurveBand band;  ///< of realisations as long as this record
};

/// A record drawn from a sum of processes, without level and drift. The same bytes for the same seed.
[[nodiscard]] StaticSignal realisation(const SumModel& model, const std::vector<double>& u, double interval,
                                       std::uint64_t length, std::uint64_t seed);

/// What the smoother says of each process that has states, at up to `points` times of a record.
struct SmoothedComponents {
  std::vector<double> time_s;
  struct Component {
    std::string name;  ///< "GM 1"
    std::vector<double> value;
    std::vector<double> sd;
  };
  std::vector<Component> components;
  std::vector<double> signal;  ///< the record itself there, means over the interval between points, level and drift taken off
};
[[nodiscard]] SmoothedComponents smoothed_components(const Likelihood& likelihood, const std::vector<double>& u,
                                                     std::size_t record, std::size_t points);

/// @param records  of the same axis of the same sensor, at the same interval
/// @throws NumericalError  too few samples (100), or no candidate has a finite likelihood
[[nodiscard]] AxisCalibration calibrate(const std::vector<StaticSignal>& records, const CalibrationOptions& options);

/// @param record  of the sensor that `model` at `u` was estimated for, at the same interval
/// @throws NumericalError  too few samples (100), or all alike
[[nodiscard]] RecordTest test_on(const StaticSignal& record, const SumModel& model, const std::vector<double>& u,
                                 const CalibrationOptions& options);

}  // namespace coast::noise
