// Degrees of freedom by dense linear algebra and by the published formulas; coverage of the intervals by simulation.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <functional>

#include "coast/noise/allan.hpp"
#include "coast/noise/chi_square.hpp"
#include "noise/noise_samples.hpp"

namespace coast {
namespace {

using noise::degrees_of_freedom;
using noise::DifferencePlan;
using noise::NoiseType;

/// Rows: differences of the integral, as combinations of `columns` of its increments.
Eigen::MatrixXd differences(const DifferencePlan& plan, Eigen::Index points) {
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(plan.terms), points);
  const auto m = static_cast<Eigen::Index>(plan.factor);
  for (Eigen::Index i = 0; i < D.rows(); ++i) {
    const Eigen::Index at = i * static_cast<Eigen::Index>(plan.stride);
    for (int k = 0; k <= plan.order; ++k) {
      const double binomial = plan.order == 2 ? (k == 1 ? 2.0 : 1.0) : (k == 0 || k == 3 ? 1.0 : 3.0);
      D(i, at + k * m) = (k % 2 == 0 ? 1.0 : -1.0) * binomial;
    }
  }
  return D;
}

/// 2 mean^2 / var of the sum of squares of a Gaussian vector with this covariance.
double freedom_of(const Eigen::MatrixXd& S) {
  return S.trace() * S.trace() / S.squaredNorm();
}

/// Covariance of the integral at points 0, 1, .. from the covariance of its increments.
Eigen::MatrixXd integrated(const Eigen::MatrixXd& increments) {
  const Eigen::Index n = increments.rows();
  Eigen::MatrixXd L = Eigen::MatrixXd::Zero(n + 1, n);
  for (Eigen::Index i = 1; i <= n; ++i) L.row(i).head(i).setOnes();
  return L * increments * L.transpose();
}

class Freedom : public testing::TestWithParam<DifferencePlan> {};
INSTANTIATE_TEST_SUITE_P(Plans, Freedom,
                         testing::Values(DifferencePlan{2, 1, 1, 99, 1}, DifferencePlan{2, 7, 1, 86, 1},
                                         DifferencePlan{3, 7, 1, 79, 1}, DifferencePlan{2, 16, 4, 30, 1},
                                         DifferencePlan{3, 12, 4, 20, 1}, DifferencePlan{2, 30, 1, 3, 1},
                                         DifferencePlan{3, 30, 1, 1, 1}, DifferencePlan{2, 20, 2, 55, 1}));

TEST_P(Freedom, IsThatOfTheDenseCovariance) {
  const DifferencePlan plan = GetParam();
  const auto last =
      static_cast<Eigen::Index>((plan.terms - 1) * plan.stride + static_cast<std::uint64_t>(plan.order) * plan.factor);
  const Eigen::MatrixXd D = differences(plan, last + 1);
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(last + 1, last + 1);
  const auto expect = [&](NoiseType type, const Eigen::MatrixXd& integral, double tolerance) {
    const double dense = freedom_of(D * integral * D.transpose());
    EXPECT_NEAR(degrees_of_freedom(type, plan), dense, tolerance * dense) << static_cast<int>(type);
  };
  expect(NoiseType::kQuantisation, I, 1e-12);
  expect(NoiseType::kWhite, integrated(I.topLeftCorner(last, last)), 1e-11);
  // A Wiener process's means over intervals: increments between neighbours have covariances 2/3, 1/6, and the process has an
  // increment before each mean but the first.
  Eigen::MatrixXd steps = Eigen::MatrixXd::Zero(last - 1, last - 1);
  steps.diagonal().setConstant(2.0 / 3.0);
  steps.diagonal(1).setConstant(1.0 / 6.0);
  steps.diagonal(-1).setConstant(1.0 / 6.0);
  expect(NoiseType::kRandomWalk, integrated(integrated(steps)), 1e-9);
}

// Riley (2008), NIST SP 1065, table 5 (Howe, Allan & Barnes 1981): empirical formulas for the overlapping Allan variance, N
// points of the integral; fits to simulations, and as far as 7.5 % from the exact values of the test above where m is small.
TEST(FreedomTable, PublishedFormulas) {
  const double N = 1001.0;
  for (const double m : {4.0, 10.0, 40.0, 100.0}) {
    DifferencePlan plan{.order = 2, .factor = static_cast<std::uint64_t>(m)};
    plan.terms = static_cast<std::uint64_t>(N - 2.0 * m);
    const auto near = [&](NoiseType type, double published) {
      EXPECT_NEAR(degrees_of_freedom(type, plan), published, 0.08 * published) << m << " " << static_cast<int>(type);
    };
    near(NoiseType::kQuantisation, (N + 1.0) * (N - 2.0 * m) / (2.0 * (N - m)));
    near(NoiseType::kWhite, (1.5 * (N - 1.0) / m - 2.0 * (N - 2.0) / N) * 4.0 * m * m / (4.0 * m * m + 5.0));
    near(NoiseType::kFlicker, 5.0 * N * N / (4.0 * m * (N + 3.0 * m)));
    near(NoiseType::kRandomWalk,
         (N - 2.0) / m * ((N - 1.0) * (N - 1.0) - 3.0 * m * (N - 1.0) + 4.0 * m * m) / ((N - 3.0) * (N - 3.0)));
  }
}

TEST(FreedomRuns, EqualRunsAddUp) {
  const DifferencePlan one{.order = 2, .factor = 10, .stride = 1, .terms = 81, .runs = 1};
  DifferencePlan four = one;
  four.terms *= 4;
  four.runs = 4;
  for (const NoiseType type :
       {NoiseType::kQuantisation, NoiseType::kWhite, NoiseType::kFlicker, NoiseType::kRandomWalk, NoiseType::kRamp})
    EXPECT_NEAR(degrees_of_freedom(type, four), 4.0 * degrees_of_freedom(type, one), 1e-9);
}

/// Share of records whose intervals hold the truth, at each averaging time.
struct Coverage {
  using Generator = std::function<std::vector<double>(std::uint64_t)>;
  std::vector<double> tau, allan_68, allan_95, hadamard_95;

  /// @param allan, hadamard  the truth at tau; where they are not given, the mean over all records
  Coverage(int records, const Generator& samples, const std::function<double(double)>& allan,
           const std::function<double(double)>& hadamard) {
    std::vector<noise::AllanCurve> curves;
    for (int record = 0; record < records; ++record) {
      noise::AllanAccumulator accumulator(1.0, {.points_per_decade = 3});
      accumulator.add(samples(static_cast<std::uint64_t>(record)));
      curves.push_back(accumulator.finish());
    }
    for (std::size_t i = 0; i < curves.front().size(); ++i) {
      tau.push_back(curves.front()[i].tau);
      double mean_allan = 0.0, mean_hadamard = 0.0;
      for (const auto& curve : curves) {
        mean_allan += std::pow(curve[i].allan.value, 2) / records;
        mean_hadamard += std::pow(curve[i].hadamard.value, 2) / records;
      }
      const double true_allan = std::sqrt(allan ? allan(tau.back()) : mean_allan);
      const double true_hadamard = std::sqrt(hadamard ? hadamard(tau.back()) : mean_hadamard);
      const auto share = [&](auto interval, double truth) {
        double inside = 0.0;
        for (const auto& curve : curves)
          inside += interval(curve[i]).lower < truth && truth < interval(curve[i]).upper ? 1.0 : 0.0;
        return inside / records;
      };
      allan_68.push_back(share([](const auto& p) { return p.allan.interval_68; }, true_allan));
      allan_95.push_back(share([](const auto& p) { return p.allan.interval_95; }, true_allan));
      hadamard_95.push_back(share([](const auto& p) { return p.hadamard.interval_95; }, true_hadamard));
    }
  }

  /// Binomial bounds of four sigma.
  void expect_nominal(double records) const {
    for (std::size_t i = 0; i < tau.size(); ++i) {
      const auto near = [&](double share, double nominal) {
        EXPECT_NEAR(share, nominal, 4.0 * std::sqrt(nominal * (1.0 - nominal) / records)) << tau[i];
      };
      near(allan_68[i], 0.6827);
      near(allan_95[i], 0.95);
      near(hadamard_95[i], 0.95);
    }
  }
};

constexpr int kRecords = 1000;
constexpr std::size_t kSamples = 600;

TEST(Intervals, CoverWhiteNoise) {
  const auto truth = [](double tau) { return 1.0 / tau; };
  Coverage(
      kRecords, [](std::uint64_t seed) { return test::white_samples(kSamples, seed); }, truth, truth)
      .expect_nominal(kRecords);
}

TEST(Intervals, CoverRandomWalk) {
  Coverage(
      kRecords, [](std::uint64_t seed) { return test::random_walk_samples(kSamples, 1.0, seed, 0.0); },
      [](double tau) { return tau / 3.0; }, [](double tau) { return tau / 6.0; })
      .expect_nominal(kRecords);
}

TEST(Intervals, CoverQuantisation) {
  Coverage(
      kRecords, [](std::uint64_t seed) { return test::quantisation_samples(kSamples, 1.0, seed); },
      [](double tau) { return 3.0 / (tau * tau); }, [](double tau) { return 10.0 / (3.0 * tau * tau); })
      .expect_nominal(kRecords);
}

TEST(Intervals, CoverFlicker) {
  Coverage(
      kRecords, [](std::uint64_t seed) { return test::flicker_samples(kSamples, seed); }, nullptr, nullptr)
      .expect_nominal(kRecords);
}

TEST(Intervals, AreChiSquareQuantilesRoundADeviation) {
  // Abramowitz & Stegun, table 26.8: chi2(10) at 0.025 and 0.975.
  const noise::Interval interval = noise::chi_square_interval(2.0, 10.0, 0.95);
  EXPECT_NEAR(interval.lower, 2.0 * std::sqrt(10.0 / 20.4832), 2e-6);
  EXPECT_NEAR(interval.upper, 2.0 * std::sqrt(10.0 / 3.24697), 4e-6);
}

}  // namespace
}  // namespace coast
