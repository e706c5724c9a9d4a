#include "coast/simulate/signal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace coast::simulate {
namespace {

const std::vector<Step> kSteps = {{10.0, 6.0, 4.0}, {12.0, 3.0, -1.5}, {30.0, 8.0, 2.0}, {55.0, 1.0, -4.5}};

double by_error_function(double constant, double t) {
  for (const Step& s : kSteps)
    constant += 0.5 * s.change * (1.0 + std::erf((t - s.start - 0.5 * s.duration) / (std::numbers::sqrt2 * s.duration / 6.0)));
  return constant;
}

TEST(Steps, EqualTheSumOfErrorFunctionsEverywhere) {
  const Steps steps(0.5, kSteps);
  for (double t = -20.0; t < 90.0; t += 0.0371) EXPECT_NEAR(steps.at(t).value(), by_error_function(0.5, t), 2e-15) << t;
}

TEST(Steps, DerivativesMatchFiniteDifferences) {
  const Steps steps(0.5, kSteps);
  const double h = 0.01;
  for (double t = -2.0; t < 70.0; t += 0.113) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto f = [&](int i) { return steps.at(t + i * h).derivative(k) - steps.at(t - i * h).derivative(k); };
      const double numeric = (0.8 * f(1) - 0.2 * f(2) + 4.0 / 105.0 * f(3) - f(4) / 280.0) / h;
      // Truncation (h / sigma)^8 / 630 of the sharpest step (sigma = 1/6 s) times its derivative k + 1.
      EXPECT_NEAR(steps.at(t).derivative(k + 1), numeric, 2e-9 * std::pow(6.0, static_cast<double>(k + 1)) * 4.5) << t;
    }
  }
}

TEST(Steps, AreExactlyConstantBeyondTheirReach) {
  const Steps steps(0.0, {{10.0, 6.0, 4.0}, {40.0, 6.0, -4.0}});
  const double reach = Steps::reach(6.0);
  EXPECT_EQ(steps.at(10.0 - reach - 1e-9).c, SignalJet(0.0).c);
  EXPECT_EQ(steps.at(16.0 + reach + 1e-9).c, SignalJet(4.0).c);
  EXPECT_EQ(steps.at(1000.0).c, SignalJet(0.0).c);
  EXPECT_NE(steps.at(10.0).c, SignalJet(0.0).c);
}

TEST(Steps, AreContinuousWhereAStepIsCutAndWhereBucketsMeet) {
  const Steps steps(0.0, kSteps);
  double earliest = 1e9;
  std::vector<double> joints;
  for (const Step& s : kSteps) {
    joints.push_back(s.start - Steps::reach(s.duration));
    joints.push_back(s.start + s.duration + Steps::reach(s.duration));
    earliest = std::min(earliest, joints[joints.size() - 2]);
  }
  for (int bucket = 0; bucket < 140; ++bucket) joints.push_back(earliest + 0.5 * bucket);
  const double eps = 1e-9;
  for (double t : joints) {
    const SignalJet before = steps.at(t - eps);
    const SignalJet after = steps.at(t + eps);
    for (std::size_t k = 0; k <= 3; ++k) {
      // What a function changes by over 2 eps, with the next derivative bounded by 4.5 (6 / 1 s)^(k+1) (k+1)!, and rounding.
      const double bound = 2.0 * eps * 4.5 * std::pow(6.0, static_cast<double>(k + 1)) + 1e-14;
      EXPECT_NEAR(before.c[k], after.c[k], bound) << "joint " << t << " order " << k;
    }
  }
}

TEST(Signal, TonesFollowTheirEnvelope) {
  const Steps envelope(0.0, {{5.0, 2.0, 1.0}});
  const Signal signal(Steps(3.0), envelope, {{0.2, 1.5, 0.4}, {0.1, 4.0, 0.0}});
  EXPECT_EQ(signal.at(1.0).c, SignalJet(3.0).c);
  const double t = 20.0;
  const double pi = std::numbers::pi;
  EXPECT_NEAR(signal.at(t).value(), 3.0 + 0.2 * std::sin(3.0 * pi * t + 0.4) + 0.1 * std::sin(8.0 * pi * t), 1e-14);
  EXPECT_NEAR(signal.at(t).derivative(1), 0.6 * pi * std::cos(3.0 * pi * t + 0.4) + 0.8 * pi * std::cos(8.0 * pi * t), 1e-12);
}

}  // namespace
}  // namespace coast::simulate
