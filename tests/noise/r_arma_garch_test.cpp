// Likelihood, optimum and robust deviations against R's fGarch, which shares no code with this (fgarch.R).

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "noise/arma_garch_models.hpp"

namespace coast::noise {
namespace {

struct FgarchCase {
  const char* name;
  ArmaGarch truth;
  std::uint64_t seed;
};

/// fGarch keeps every coefficient inside (-1, 1): the truths do, too.
std::vector<FgarchCase> fgarch_cases() {
  const ArmaGarch arma32{
      .nu = 0.1, .alpha = {0.9, -0.55, 0.3}, .beta = {0.6, 0.25}, .gamma0 = 0.05, .gamma = {0.1}, .delta = {0.8}};
  const ArmaGarch arma11{.nu = 0.2, .alpha = {0.85}, .beta = {-0.4}, .gamma0 = 0.1, .gamma = {0.15}, .delta = {0.7}};
  return {{"arma32", arma32, 1}, {"arma11", arma11, 2}, {"arma11_again", arma11, 3}};
}

bool has_fgarch() {
  return std::system("Rscript --vanilla -e 'quit(status = !requireNamespace(\"fGarch\", quietly = TRUE))' >/dev/null 2>&1") ==
         0;
}

class AgainstFgarch : public testing::TestWithParam<int> {};

TEST_P(AgainstFgarch, LikelihoodIsTheSameAndTheOptimumNoWorse) {
  if (!has_fgarch()) GTEST_SKIP() << "R with the package fGarch (Debian: r-cran-fgarch) is not installed";
  const FgarchCase c = fgarch_cases()[static_cast<std::size_t>(GetParam())];
  const std::vector<double> y = test::simulated_arma_garch(c.truth, 3000, c.seed);
  const ArmaGarchOrders orders = c.truth.orders();
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / fmt::format("coast-fgarch-{}", c.name);
  std::filesystem::create_directories(folder);
  std::ofstream values(folder / "series.txt");
  for (const double value : y) values << fmt::format("{:.17g}\n", value);
  values.close();
  const std::string command = fmt::format("Rscript --vanilla {}/tests/noise/fgarch.R {} {} {} {} {} >{}", COAST_SOURCE_DIR,
                                          (folder / "series.txt").string(), orders.ar, orders.ma, orders.arch, orders.garch,
                                          (folder / "answer.txt").string());
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
  std::ifstream answer(folder / "answer.txt");
  double maximum = 0.0;
  Eigen::VectorXd optimum = arma_garch_vector(c.truth, true);
  Eigen::VectorXd sds = optimum;
  answer >> maximum;
  for (double& value : optimum) answer >> value;
  for (double& value : sds) answer >> value;
  ASSERT_TRUE(answer);

  const ArmaGarch theirs = arma_garch_model(orders, true, optimum);
  ASSERT_EQ(theirs.defect(), "");
  EXPECT_NEAR(arma_garch_log_likelihood(theirs, {y}, ArmaGarchStart::kFgarch), maximum, 1e-6);  // rounding of 3000 terms
  const ArmaGarchFit fit = fit_arma_garch({y}, orders, {.start = ArmaGarchStart::kFgarch});
  EXPECT_TRUE(fit.converged);
  EXPECT_GE(fit.log_likelihood, maximum - 1e-6);
  EXPECT_LT(fit.log_likelihood, maximum + 0.05);  // nlminb ends near the same top
  // fGarch's Hessian and scores are differences of its likelihood, with steps of 1e-4 of a parameter.
  const ArmaGarchUncertainty stated = arma_garch_uncertainty(fit, {y}).value();
  for (Eigen::Index i = 0; i < sds.size(); ++i) EXPECT_NEAR(stated.robust_sd(i) / sds(i), 1.0, 2e-3) << i;
}

INSTANTIATE_TEST_SUITE_P(ArmaGarch, AgainstFgarch, testing::Range(0, 3), [](const auto& param) {
  return std::string(fgarch_cases()[static_cast<std::size_t>(param.param)].name);
});

}  // namespace
}  // namespace coast::noise
