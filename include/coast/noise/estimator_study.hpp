#pragma once
// Monte Carlo study of the estimators: many records of known processes, each estimated in several ways and compared with the
// Cramer-Rao bound.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "coast/noise/uncertainty.hpp"

namespace coast::noise {

enum class Estimator {
  kEm,              ///< from given values, a given number of iterations
  kDefault,         ///< wavelet moments, then maximum likelihood: what `calibrate` does with a given sum
  kBestOfStarts,    ///< the best maximum likelihood from the truth and from random starts about it: approximates the global
                    ///< maximum
  kWaveletMoments,  ///< wavelet moments alone
  kAllan,           ///< least squares on the Allan curve alone
};

struct StudiedEstimator {
  std::string name;
  Estimator kind = Estimator::kDefault;
  SumModel model;                  ///< model that it fits; need not be that of the truth
  std::vector<double> start = {};  ///< u, of EM
  int iterations = 500;            ///< of EM
  int starts = 6;                  ///< of kBestOfStarts
  bool intervals = false;          ///< 95 % by profile likelihood
};

/// Model from which the records are simulated.
struct StudyTruth {
  SumModel model;  ///< processes; its mean is not used
  std::vector<double> u;
  double level = 0.0;  ///< [signal], at the first sample
  double slope = 0.0;  ///< [signal]/s
};

/// Allan curves of realisations of an estimate, compared with that of its record (Stebler et al. 2011, Figs. 2 and 3).
struct RestitutionPlan {
  std::size_t runs = 0;  ///< the first ones
  std::size_t realisations = 20;
  std::size_t estimator = 0;  ///< index in the study's
};

struct EstimatorStudy {
  StudyTruth truth;
  double interval = 1.0;  ///< s
  std::uint64_t samples = 0;
  std::size_t runs = 0;
  std::uint64_t first_seed = 1;  ///< run r is drawn with first_seed + r
  std::vector<StudiedEstimator> estimators;
  std::vector<SumModel> choices = {};  ///< candidates for the choice by BIC, as in `calibrate`; empty: no choice is studied
  RestitutionPlan restitution = {};
};

/// One estimate of one record.
struct StudyFit {
  std::vector<double> u;                   ///< processes of one kind in ascending order of their first parameter
  std::vector<double> mean;                ///< empty, [level at the middle], or [level, slope per second]
  std::vector<bool> zero;                  ///< a variance whose removal lowers the log-likelihood by less than 1e-3
  double log_likelihood = 0.0;             ///< also if the estimator does not use it
  std::vector<double> trace;               ///< log-likelihood by iteration; of the first run
  int iterations = 0;                      ///< of EM, of the direct search
  int passes = 0;                          ///< over the record
  bool converged = false;                  ///< for EM: within its iterations
  double seconds = 0.0;                    ///< without intervals
  std::vector<ProfileInterval> intervals;  ///< if requested: one per parameter, then of the mean
};

/// A record and realisations of its estimate.
struct Restitution {
  AllanCurve record;
  std::vector<std::vector<double>> realisations;  ///< Allan deviations at the record's averaging times
};

struct EstimatorStudyResult {
  std::vector<std::vector<StudyFit>> fits;  ///< [estimator][run]
  std::vector<std::size_t> chosen;          ///< [run], index in choices
  std::vector<Restitution> restitution;
};

/// Simulates and estimates all runs in parallel; the result is bitwise the same for any number of threads, except for times.
/// @param progress  called with the fraction done, from any thread
/// @throws std::invalid_argument  no runs, fewer than 100 samples, an interval of zero or less, a start that is missing, or an
///                                index that does not exist
[[nodiscard]] EstimatorStudyResult run_estimator_study(const EstimatorStudy& study,
                                                       const std::function<void(double)>& progress = {});

/// How often intervals contained the truth.
struct Coverage {
  std::size_t inside = 0;
  std::size_t intervals = 0;
  [[nodiscard]] double share() const { return static_cast<double>(inside) / static_cast<double>(intervals); }
  /// 95 % interval of the share, if the intervals are independent (Wilson 1927).
  [[nodiscard]] Interval uncertainty() const;
};

struct ParameterSummary {
  std::string name;  ///< "gauss_markov beta 2", "level", "slope"
  std::string unit;
  std::optional<double> truth;  ///< absent if the truth has no such process
  std::optional<double> bound;  ///< Cramer-Rao standard deviation of the value, at the truth
  double mean = 0.0;
  double sd = 0.0;  ///< over the runs
  double q05 = 0.0;
  double median = 0.0;
  double q95 = 0.0;
  std::optional<double> zero;        ///< share of the runs in which this variance ended at zero
  std::optional<Coverage> coverage;  ///< of profile intervals; of level and slope, by the stated standard deviation
};

struct EstimatorSummary {
  std::vector<ParameterSummary> parameters;  ///< of the processes, then level and slope
  std::optional<Coverage> pooled;            ///< over the parameters of the processes
  double largest_shortfall = 0.0;  ///< of log-likelihood below the best that any estimator found for this sum or a part of it
  double mean_shortfall = 0.0;
  double mean_iterations = 0.0;
  double mean_passes = 0.0;
  double converged = 0.0;  ///< share of the runs
  double median_seconds = 0.0;
  double largest_seconds = 0.0;
};
[[nodiscard]] std::vector<EstimatorSummary> summarise(const EstimatorStudy& study, const EstimatorStudyResult& result);

/// Values of one parameter over the runs, in their order: of a process, or (after those) of level and slope.
[[nodiscard]] std::vector<double> values_of(const StudiedEstimator& estimator, const std::vector<StudyFit>& fits,
                                            std::size_t parameter);

/// u with the processes of one kind in ascending order of their first parameter, because the order in a sum is arbitrary.
[[nodiscard]] std::vector<double> in_order(const SumModel& model, const std::vector<double>& u);

/// The truth's parameters for another sum: its k-th process of a kind has those of the k-th such process of the truth; absent
/// if there is none.
[[nodiscard]] std::vector<std::optional<double>> truth_in(const SumModel& model, const StudyTruth& truth);

/// Cramer-Rao standard deviations of the values of the processes' parameters, and of level and slope by generalised least
/// squares with the processes known. Empty if the sum has a process that the truth does not have.
[[nodiscard]] std::vector<double> bounds_of(const SumModel& model, const StudyTruth& truth, double interval,
                                            std::uint64_t samples);

}  // namespace coast::noise
