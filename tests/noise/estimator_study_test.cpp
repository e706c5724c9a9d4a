#include "coast/noise/estimator_study.hpp"

#include <gtest/gtest.h>

#include <tbb/global_control.h>
#include "noise/static_record.hpp"

#include <numeric>

#include "coast/noise/calibration.hpp"
#include "coast/noise/partial_autocorrelation.hpp"

namespace coast::noise {
namespace {

using test::sum;

using test::logs;

/// Four units of white noise, nothing else, nothing known beforehand but its mean of zero.
EstimatorStudy white_noise_study() {
  const SumModel model = sum({"white_noise"}, Mean::kZero);
  EstimatorStudy study;
  study.truth = {model, logs({4.0})};
  study.samples = 200;
  study.runs = 400;
  study.estimators = {{.name = "default", .model = model, .intervals = true}};
  return study;
}

TEST(EstimatorStudy, OfWhiteNoiseAloneIsTheClosedForm) {
  const EstimatorStudy study = white_noise_study();
  const EstimatorStudyResult result = run_estimator_study(study);
  const std::vector<double> values = values_of(study.estimators[0], result.fits[0], 0);
  for (std::size_t run = 0; run < study.runs; ++run) {
    const std::vector<double> y = realisation(study.truth.model, study.truth.u, 1.0, 200, study.first_seed + run).values;
    const double expected = std::inner_product(y.begin(), y.end(), y.begin(), 0.0) / 200.0;
    // The search ends where it expects to gain less than 1e-7: N/4 d^2 for d the logarithm's miss.
    ASSERT_NEAR(values[run], expected, 5e-5 * expected) << run;
  }
  const ParameterSummary p = summarise(study, result).at(0).parameters.at(0);
  EXPECT_EQ(p.truth, 4.0);
  EXPECT_NEAR(p.bound.value(), 4.0 * std::sqrt(2.0 / 200.0), 1e-9);
  // 99.9 % of a mean and of a standard deviation over 400 runs of about normal estimates.
  EXPECT_NEAR(p.mean, 4.0, 3.3 * *p.bound / std::sqrt(400.0));
  EXPECT_NEAR(p.sd / *p.bound, 1.0, 3.3 / std::sqrt(2.0 * 399.0));
  EXPECT_NEAR(p.q05, 4.0 - 1.645 * *p.bound, 0.3 * *p.bound);
  EXPECT_EQ(p.zero, 0.0);
  EXPECT_NEAR(p.coverage.value().share(), 0.95, 3.3 * std::sqrt(0.95 * 0.05 / 400.0));
}

// Of calibration-three-markov's records the one whose curve leads to a lower top, by 1.2, and one whose ridge is so flat that
// Gauss-Newton steps along it end 0.002 below.
TEST(EstimatorStudy, ThreeMarkovProcessesReachTheHigherTop) {
  EstimatorStudy study;
  study.truth.model = sum({"white_noise", "gauss_markov", "gauss_markov", "gauss_markov"}, Mean::kLevel);
  study.truth.u = logs({0.09, 0.2, 0.05, 0.01, 0.1, 1.0 / 1500.0, 0.25});
  study.samples = 20000;
  study.runs = 1;
  study.estimators = {{.name = "default", .model = study.truth.model},
                      {.name = "best", .kind = Estimator::kBestOfStarts, .model = study.truth.model, .starts = 4}};
  for (const std::uint64_t seed : {40U, 6U}) {
    study.first_seed = seed;
    const EstimatorStudyResult result = run_estimator_study(study);
    EXPECT_TRUE(result.fits[0][0].converged) << seed;
    EXPECT_GT(result.fits[0][0].log_likelihood, result.fits[1][0].log_likelihood - 1e-4) << seed;
  }
}

TEST(EstimatorStudy, LevelAndSlopeAreThoseOfLeastSquares) {
  const SumModel model = sum({"white_noise"}, Mean::kLevelAndDrift);
  EstimatorStudy study = white_noise_study();
  study.truth.level = 7.0;
  study.truth.slope = 0.01;
  study.estimators = {{.name = "default", .model = model, .intervals = true}};
  const EstimatorSummary summary = summarise(study, run_estimator_study(study)).at(0);
  ASSERT_EQ(summary.parameters.size(), 3U);
  const ParameterSummary& level = summary.parameters[1];
  const ParameterSummary& slope = summary.parameters[2];
  EXPECT_NEAR(level.truth.value(), 7.0 + 0.01 * 99.5, 1e-12);  // in the middle
  EXPECT_NEAR(level.bound.value(), std::sqrt(4.0 / 200.0), 1e-9);
  EXPECT_NEAR(slope.bound.value(), std::sqrt(12.0 * 4.0 / (200.0 * (200.0 * 200.0 - 1.0))), 1e-12);
  EXPECT_NEAR(slope.mean, 0.01, 3.3 * *slope.bound / std::sqrt(400.0));
  EXPECT_NEAR(slope.sd / *slope.bound, 1.0, 3.3 / std::sqrt(2.0 * 399.0));
  EXPECT_NEAR(slope.coverage.value().share(), 0.95, 0.04);
}

/// Small, with everything that there is.
EstimatorStudy whole_study() {
  const SumModel truth = sum({"white_noise", "gauss_markov"}, Mean::kLevel);
  const SumModel walk = sum({"white_noise", "gauss_markov", "random_walk"}, Mean::kLevel);
  EstimatorStudy study;
  study.truth = {truth, logs({0.09, 0.05, 0.25})};
  study.samples = 600;
  study.runs = 6;
  study.estimators = {{.name = "EM", .kind = Estimator::kEm, .model = truth, .start = logs({0.5, 0.3, 0.05}), .iterations = 4},
                      {.name = "default", .model = truth, .intervals = true},
                      {.name = "walk", .model = walk},
                      {.name = "best", .kind = Estimator::kBestOfStarts, .model = walk, .starts = 3},
                      {.name = "moments", .kind = Estimator::kWaveletMoments, .model = truth},
                      {.name = "Allan", .kind = Estimator::kAllan, .model = truth}};
  study.choices = {truth, walk};
  study.restitution = {.runs = 2, .realisations = 3, .estimator = 1};
  return study;
}

EstimatorStudyResult run_on(int threads, const EstimatorStudy& study) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  return run_estimator_study(study);
}

TEST(EstimatorStudy, IsTheSameOnAnyNumberOfThreads) {
  const EstimatorStudy study = whole_study();
  const EstimatorStudyResult one = run_on(1, study);
  const EstimatorStudyResult two = run_on(2, study);
  EXPECT_EQ(one.chosen, two.chosen);
  for (std::size_t e = 0; e < study.estimators.size(); ++e)
    for (std::size_t run = 0; run < study.runs; ++run) {
      const StudyFit& a = one.fits[e][run];
      const StudyFit& b = two.fits[e][run];
      EXPECT_EQ(a.u, b.u);
      EXPECT_EQ(a.mean, b.mean);
      EXPECT_EQ(a.log_likelihood, b.log_likelihood);
      EXPECT_EQ(a.trace, b.trace);
      EXPECT_EQ(a.passes, b.passes);
      ASSERT_EQ(a.intervals.size(), b.intervals.size());
      for (std::size_t i = 0; i < a.intervals.size(); ++i) EXPECT_EQ(a.intervals[i].lower, b.intervals[i].lower);
    }
  ASSERT_EQ(one.restitution.size(), 2U);
  for (std::size_t r = 0; r < 2; ++r) EXPECT_EQ(one.restitution[r].realisations, two.restitution[r].realisations);
  EXPECT_EQ(one.restitution[0].realisations.size(), 3U);
  EXPECT_NE(one.restitution[0].realisations[0], one.restitution[1].realisations[0]);
}

TEST(EstimatorStudy, ShortfallIsAgainstTheBestOfTheSameSumOrAPartOfIt) {
  const EstimatorStudy study = whole_study();
  const EstimatorStudyResult result = run_estimator_study(study);
  const std::vector<EstimatorSummary> summaries = summarise(study, result);
  double largest = 0.0;
  for (std::size_t run = 0; run < study.runs; ++run) {
    double best = -1e300;
    for (const std::size_t e : {0U, 1U, 4U, 5U}) best = std::max(best, result.fits[e][run].log_likelihood);
    largest = std::max(largest, best - result.fits[0][run].log_likelihood);
  }
  EXPECT_EQ(summaries[0].largest_shortfall, largest);
  EXPECT_GT(largest, 1.0);  // four passes of EM from far away
  EXPECT_EQ(summaries[0].mean_iterations, 4.0);
  EXPECT_EQ(summaries[0].converged, 0.0);
  // A sum with a random walk more is at least as likely; the search promises 1e-7.
  for (const std::size_t e : {1U, 2U, 3U}) EXPECT_LT(summaries[e].largest_shortfall, 1e-5) << study.estimators[e].name;
  EXPECT_FALSE(result.fits[0][0].trace.empty());
  EXPECT_TRUE(result.fits[0][1].trace.empty());
}

TEST(EstimatorStudy, AVarianceThatIsNotThereIsZeroWhereTheSumWithoutItIsAsLikely) {
  EstimatorStudy study = whole_study();
  study.runs = 20;
  study.estimators = {study.estimators[1], study.estimators[2]};
  study.choices.clear();
  study.restitution = {};
  const EstimatorStudyResult result = run_estimator_study(study);
  int zeros = 0;
  for (std::size_t run = 0; run < study.runs; ++run) {
    const double gained = result.fits[1][run].log_likelihood - result.fits[0][run].log_likelihood;
    EXPECT_EQ(result.fits[1][run].zero.at(3), gained < 1e-3) << gained;
    zeros += result.fits[1][run].zero.at(3) ? 1 : 0;
  }
  EXPECT_GT(zeros, 4);  // a half is expected: 1 of 200 that it were so few
  EXPECT_EQ(summarise(study, result)[1].parameters.at(3).zero, zeros / 20.0);
  EXPECT_FALSE(summarise(study, result)[1].parameters.at(3).truth.has_value());
}

TEST(EstimatorStudy, ProcessesOfOneKindKnowNoOrder) {
  const SumModel model = sum({"gauss_markov", "white_noise", "gauss_markov"}, Mean::kLevel);
  const std::vector<double> u = logs({0.5, 2.0, 0.09, 0.01, 3.0});
  EXPECT_EQ(in_order(model, u), logs({0.01, 3.0, 0.09, 0.5, 2.0}));
  const StudyTruth truth{model, u};
  const auto of_one = truth_in(sum({"gauss_markov"}, Mean::kZero), truth);
  EXPECT_EQ(of_one.at(0), std::log(0.01));
  EXPECT_EQ(of_one.at(1), std::log(3.0));
  const auto of_three = truth_in(sum({"gauss_markov", "gauss_markov", "gauss_markov"}, Mean::kZero), truth);
  EXPECT_EQ(of_three.at(2), std::log(0.5));
  EXPECT_FALSE(of_three.at(4).has_value());
  EXPECT_TRUE(bounds_of(sum({"random_walk"}, Mean::kZero), truth, 1.0, 500).empty());
}

TEST(Coverage, IntervalIsWilsons) {
  // Wilson (1927): of none in n the upper end is z^2/(n + z^2).
  const double z2 = 1.959963984540054 * 1.959963984540054;
  const Interval none = Coverage{0, 10}.uncertainty();
  EXPECT_NEAR(none.lower, 0.0, 1e-15);
  EXPECT_NEAR(none.upper, z2 / (10.0 + z2), 1e-15);
  const Interval half = Coverage{50, 100}.uncertainty();
  EXPECT_NEAR(half.lower, 0.4038, 5e-5);  // standard tables
  EXPECT_NEAR(half.upper, 0.5962, 5e-5);
}

TEST(EstimatorStudy, RefusesWhatItCannotRun) {
  const auto refused = [](const auto& spoil) {
    EstimatorStudy study = whole_study();
    spoil(study);
    EXPECT_THROW(static_cast<void>(run_estimator_study(study)), std::invalid_argument);
  };
  refused([](EstimatorStudy& study) { study.runs = 0; });
  refused([](EstimatorStudy& study) { study.samples = 99; });
  refused([](EstimatorStudy& study) { study.interval = 0.0; });
  refused([](EstimatorStudy& study) { study.estimators[0].start.clear(); });
  refused([](EstimatorStudy& study) { study.restitution.estimator = 6; });
}

TEST(PartialAutocorrelations, OfLowOrdersAreTheClosedForms) {
  EXPECT_EQ(partial_autocorrelations(std::vector{0.5}), std::vector{0.5});
  const auto two = partial_autocorrelations(std::vector{1.8, -0.9});
  ASSERT_TRUE(two);
  EXPECT_NEAR(two->at(0), 1.8 / 1.9, 1e-15);  // rho(1) = a1/(1 - a2)
  EXPECT_EQ(two->at(1), -0.9);
  EXPECT_FALSE(partial_autocorrelations(std::vector{1.0}));
  EXPECT_FALSE(partial_autocorrelations(std::vector{0.5, 0.6}));
}

}  // namespace
}  // namespace coast::noise
