#include "coast/array/merge_study.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <numeric>

namespace coast::array {
namespace {

MergeStudyOptions short_study() {
  MergeStudyOptions options;
  options.sensors = {{.alpha = {0.6}, .gamma0 = 1e-4, .gamma = {0.1}, .delta = {0.8}},
                     {.alpha = {0.6}, .gamma0 = 4e-4, .gamma = {0.1}, .delta = {0.8}},
                     {.alpha = {0.2}, .gamma0 = 2e-4, .gamma = {0.1}, .delta = {0.8}}};
  options.samples = 8000;
  options.runs = 4;
  options.orders = {1, 0, 1, 1};
  return options;
}

const MergeResult& by_name(const MergeStudy& study, const std::string& name) {
  return *std::ranges::find(study.merges, name, &MergeResult::name);
}

TEST(MergeStudy, MeasuresWhatTheModelsSay) {
  const MergeStudyOptions options = short_study();
  const MergeStudy study = run_merge_study(options);
  double mean = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    // 32000 samples of an AR(1) of 0.6 know a variance as 15000 white ones do, and GARCH makes that worse: 3 %; three sigmas.
    const double truth = options.sensors[k].unconditional_variance();
    EXPECT_NEAR(by_name(study, fmt::format("single {}", k + 1)).mean() / truth, 1.0, 0.1);
    mean += truth / 9.0;
  }
  EXPECT_NEAR(by_name(study, "mean").mean() / mean, 1.0, 0.1);
  // The oracle's merged innovations: at best the sum of precisions, with variances that move better than with their means.
  double precision = 0.0;
  for (const noise::ArmaGarch& model : options.sensors) precision += 1.0 / model.innovation_variance();
  EXPECT_LT(by_name(study, "oracle").mean(), 1.03 / precision);
  EXPECT_GT(by_name(study, "oracle").mean(), 0.7 / precision);
  EXPECT_LT(by_name(study, "oracle").mean(), by_name(study, "oracle weights").mean());
}

TEST(MergeStudy, PredictionsByErrorsTakeOffWhatAnAutoregressionHolds) {
  const MergeStudy study = run_merge_study(short_study());
  // Of an AR(1) the share alpha^2 is predictable.
  EXPECT_NEAR(study.residual_models[0].removed_by_errors, 0.36, 0.03);
  EXPECT_NEAR(study.residual_models[2].removed_by_errors, 0.04, 0.02);
  for (const ResidualModel& model : study.residual_models) EXPECT_LT(model.removed, model.removed_by_errors + 1e-3);
  EXPECT_NEAR(study.residual_models[0].true_autocorrelation, 0.6, 1e-9);
}

TEST(MergeStudy, KeepsTheFirstRunForFigures) {
  const MergeStudyOptions options = short_study();
  const MergeStudy study = run_merge_study(options);
  ASSERT_EQ(study.first_errors.size(), options.sensors.size() + 3);  // mean, corrected by residuals, corrected by errors
  const auto mean_square = [](const std::vector<double>& values) {
    return std::inner_product(values.begin(), values.end(), values.begin(), 0.0) / static_cast<double>(values.size());
  };
  EXPECT_GT(mean_square(study.first_errors[3]), mean_square(study.first_errors[5]));
  // What is left of the errors is white with the true variance: mean square 1 over it, four of sqrt(2/8000).
  ASSERT_EQ(study.first_residuals.size(), options.samples);
  std::vector<double> standardised = study.first_residuals;
  for (std::size_t n = 0; n < standardised.size(); ++n) standardised[n] /= study.first_sd[n];
  EXPECT_NEAR(mean_square(standardised), 1.0, 0.063);
}

TEST(MergeStudy, DoesNotDependOnThreads) {
  const MergeStudy all = run_merge_study(short_study());
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(run_merge_study(short_study()).merges[5].mse, all.merges[5].mse);
}

TEST(MergeStudy, RefusesOneSensor) {
  MergeStudyOptions options = short_study();
  options.sensors.resize(1);
  EXPECT_THROW(static_cast<void>(run_merge_study(options)), std::invalid_argument);
}

}  // namespace
}  // namespace coast::array
