// Likelihood and optimum against R, which shares no code with this: stats::KalmanRun and optim (likelihood.R).

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "coast/noise/estimators.hpp"
#include "static_record.hpp"

namespace coast::noise {
namespace {

using test::logs;

struct ComparedSum {
  const char* name;  // of the function in likelihood.R
  SumModel model;
  std::vector<double> u;
};

std::vector<ComparedSum> compared_sums() {
  std::vector<ComparedSum> all{
      {"white_markov", test::sum({"white_noise", "gauss_markov"}, Mean::kZero), logs({0.09, 0.02, 0.25})},
      {"white_markov_walk", test::sum({"white_noise", "gauss_markov", "random_walk"}, Mean::kZero),
       logs({0.09, 0.1, 0.25, 1e-3})},
      {"ar2_markov", test::sum({"ar(2)", "gauss_markov"}, Mean::kZero), logs({1.0, 1.0, 0.09, 0.01, 0.25})}};
  all.back().u[0] = std::atanh(0.5);
  all.back().u[1] = std::atanh(-0.6);
  return all;
}

class AgainstR : public testing::TestWithParam<int> {};

TEST_P(AgainstR, LikelihoodAndOptimumAreTheSame) {
  if (std::system("command -v Rscript >/dev/null 2>&1") != 0) GTEST_SKIP() << "Rscript is not installed";
  const ComparedSum c = compared_sums()[static_cast<std::size_t>(GetParam())];
  const StaticSignal record = StaticSignal::regular(test::simulate_block(c.model.block(c.u, 1.0), 2000, 17), 1.0);
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / fmt::format("coast-r-{}", c.name);
  std::filesystem::create_directories(folder);
  std::ofstream values(folder / "record.txt");
  for (const double value : record.values) values << fmt::format("{:.17g}\n", value);
  values.close();
  std::string command = fmt::format("Rscript --vanilla {}/tests/noise/likelihood.R {} {}", COAST_SOURCE_DIR,
                                    (folder / "record.txt").string(), c.name);
  for (const double value : c.model.values(c.u)) command += fmt::format(" {:.17g}", value);
  ASSERT_EQ(std::system(fmt::format("{} >{}", command, (folder / "answer.txt").string()).c_str()), 0) << command;
  std::ifstream answer(folder / "answer.txt");
  double at_given = 0.0;
  double maximum = 0.0;
  std::vector<double> optimum(c.u.size());
  answer >> at_given >> maximum;
  for (double& value : optimum) answer >> value;
  ASSERT_TRUE(answer);

  const Likelihood likelihood({record}, c.model);
  // Twelve decimals are printed; KalmanRun sums 2000 terms.
  EXPECT_NEAR(likelihood.value(c.u).log_likelihood, at_given, 1e-8);
  const Fit fit = fit_maximum_likelihood(likelihood, c.u);
  // optim's gradient is by differences of 1e-3: it ends where the likelihood is flat to some 1e-6.
  EXPECT_NEAR(fit.log_likelihood, maximum, 1e-5);
  EXPECT_GE(fit.log_likelihood, maximum - 1e-7);
  const std::vector<double> found = c.model.values(fit.u);
  const Eigen::MatrixXd information = likelihood.slope(fit.u).information;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const double sd = std::sqrt(information.inverse()(at, at));
    // 1e-5 of log-likelihood is 4.5 thousandths of a standard deviation
    EXPECT_NEAR((c.model.parameter(i).inverse(optimum[i]) - fit.u[i]) / sd, 0.0, 5e-3) << c.model.parameter_name(i);
  }
}

INSTANTIATE_TEST_SUITE_P(Likelihood, AgainstR, testing::Range(0, 3), [](const auto& param) {
  return std::string(compared_sums()[static_cast<std::size_t>(param.param)].name);
});

}  // namespace
}  // namespace coast::noise
