// Every process of the registry, as the table lists it; then the closed forms of each.

#include "coast/noise/process.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "coast/geo/units.hpp"
#include "coast/noise/gauss_markov.hpp"
#include "coast/record/error.hpp"
#include "noise/entries.hpp"
#include "support/spectra.hpp"
#include "support/support.hpp"

namespace coast {
namespace {

using noise::Sensor;
using test::block_of;
using test::process_of;
using test::processes_of;

struct Example {
  const noise::Registration* registration;
  Sensor sensor;
  [[nodiscard]] std::string text() const {
    return std::string(sensor == Sensor::kGyro ? registration->gyro_example : registration->accel_example);
  }
};

std::vector<Example> examples() {
  std::vector<Example> all;
  for (const noise::Registration& r : noise::registry()) {
    all.push_back({&r, Sensor::kGyro});
    all.push_back({&r, Sensor::kAccel});
  }
  return all;
}

std::string example_name(const testing::TestParamInfo<Example>& info) {
  return std::string(info.param.registration->name) + (info.param.sensor == Sensor::kGyro ? "_gyro" : "_accel");
}

class EveryProcess : public testing::TestWithParam<Example> {};
INSTANTIATE_TEST_SUITE_P(Registry, EveryProcess, testing::ValuesIn(examples()), example_name);

TEST_P(EveryProcess, ExampleIsReadAndNamed) {
  const auto processes = processes_of(GetParam().text(), GetParam().sensor);
  ASSERT_FALSE(processes.empty());
  for (const auto& process : processes) EXPECT_EQ(process->share() ? "share" : process->name(), GetParam().registration->name);
  EXPECT_FALSE(GetParam().registration->help.empty());
}

TEST_P(EveryProcess, TwoPartsOfAnIntervalEqualTheWhole) {
  for (const auto& process : processes_of(GetParam().text(), GetParam().sensor)) {
    for (const double dt : {1e-4, 0.01, 3.0, 5000.0}) {
      const auto whole = block_of(*process, dt), a = block_of(*process, 0.3 * dt), b = block_of(*process, 0.7 * dt);
      // Rounding of exp and expm1 only.
      test::expect_near_matrix(b.Phi * a.Phi, whole.Phi, 1e-14, "Phi");
      test::expect_near_matrix(b.Phi * a.Q_d * b.Phi.transpose() + b.Q_d, whole.Q_d, 1e-13, "Q_d");
    }
  }
}

TEST_P(EveryProcess, CovariancesAreSymmetricAndNotNegative) {
  for (const auto& process : processes_of(GetParam().text(), GetParam().sensor)) {
    if (process->states() == 0) continue;
    const auto block = block_of(*process, 0.1);
    for (const Eigen::MatrixXd& M : {block.Q_d, block.P}) {
      EXPECT_EQ(M, M.transpose());
      EXPECT_GE(test::eigenvalues(M).minCoeff(), 0.0);
    }
    EXPECT_GT(block.h.norm(), 0.0);
  }
}

TEST_P(EveryProcess, EntryWrittenInSiMakesTheSameProcess) {
  const auto before = processes_of(GetParam().text(), GetParam().sensor);
  const auto after = processes_of(before.front()->yaml(), GetParam().sensor);
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    const auto a = block_of(*after[i], 0.7), b = block_of(*before[i], 0.7);
    EXPECT_EQ(after[i]->input(), before[i]->input());
    EXPECT_NEAR(after[i]->white_density().value, before[i]->white_density().value, 1e-15 * before[i]->white_density().value);
    // 17 digits and one division by the unit.
    test::expect_near_matrix(a.Phi, b.Phi, 1e-15, "Phi");
    test::expect_near_matrix(a.Q_d, b.Q_d, 1e-14, "Q_d");
    test::expect_near_matrix(a.P, b.P, 1e-15, "P");
    test::expect_near_matrix(a.mean, b.mean, 1e-15, "mean");
    EXPECT_EQ(after[i]->sample_interval(), before[i]->sample_interval());
    const auto rounded = before[i]->rounding(), again = after[i]->rounding();
    ASSERT_EQ(again.has_value(), rounded.has_value());
    if (!rounded) continue;
    EXPECT_EQ(again->of, rounded->of);
    EXPECT_NEAR(again->step, rounded->step, 1e-15 * rounded->step);
  }
}

/// Nodes and weights of Gauss and Legendre on (0, 1), exact for polynomials up to degree 39.
struct Quadrature {
  std::vector<double> at, weight;
  Quadrature() {
    const int n = 20;
    for (int i = 1; i <= n; ++i) {
      double x = std::cos(M_PI * (i - 0.25) / (n + 0.5)), slope = 0.0;
      for (int newton = 0; newton < 8; ++newton) {
        double before = 1.0, p = x;
        for (int k = 2; k <= n; ++k) {
          const double next = ((2.0 * k - 1.0) * x * p - (k - 1.0) * before) / k;
          before = p;
          p = next;
        }
        slope = n * (x * p - before) / (x * x - 1.0);
        x -= p / slope;
      }
      at.push_back(0.5 * (1.0 + x));
      weight.push_back(1.0 / ((1.0 - x * x) * slope * slope));
    }
  }
};

/// The mean square of sum_i weights[i] * (integral of the error over the i-th interval of length tau), from the state-space
/// block: the double integral of h Phi(t - s) P(s) h', smooth in each cell off the diagonal and in each triangle on it.
double mean_square_in_continuous_time(const noise::Process& process, double tau, const std::vector<double>& weights) {
  const Quadrature gauss;
  const auto covariance = [&](double s, double t) {  // s < t
    const auto from_start = block_of(process, s), onwards = block_of(process, t - s);
    const Eigen::MatrixXd square = from_start.P + from_start.mean * from_start.mean.transpose();
    return (onwards.h * onwards.Phi * (from_start.Phi * square * from_start.Phi.transpose() + from_start.Q_d) *
            onwards.h.transpose())(0, 0);
  };
  double sum = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    sum += weights[i] * weights[i] * process.white_density().value * tau;
    for (std::size_t j = 0; j <= i && process.states() > 0; ++j)
      for (std::size_t p = 0; p < gauss.at.size(); ++p)
        for (std::size_t q = 0; q < gauss.at.size(); ++q) {
          const double t = gauss.at[p], s = i == j ? t * gauss.at[q] : gauss.at[q], area = i == j ? t : 1.0;
          sum += 2.0 * weights[i] * weights[j] * tau * tau * area * gauss.weight[p] * gauss.weight[q] *
                 covariance(tau * (static_cast<double>(j) + s), tau * (static_cast<double>(i) + t));
        }
  }
  return sum;
}

bool is_stationary(const noise::Process& process) {
  const auto block = block_of(process, 1.0);
  return block.mean.isZero(0.0) &&
         (block.Phi * block.P * block.Phi.transpose() + block.Q_d - block.P).norm() <= 1e-14 * block.P.norm();
}

/// The same where only the lag counts and time constants are spread over decades: one integral, in panels that shrink towards
/// a lag of zero.
double mean_square_by_lag(const noise::Process& process, double tau, const std::vector<double>& weights) {
  const Quadrature gauss;
  const auto pairs = [&](std::size_t lag) {
    double sum = 0.0;
    for (std::size_t i = 0; i + lag < weights.size(); ++i) sum += weights[i] * weights[i + lag];
    return sum;
  };
  double sum = 0.0;
  for (std::size_t j = 0; j < weights.size(); ++j)
    for (double from = 0.0, to = 1e-6; from < 1.0; from = to, to = std::min(1.0, 4.0 * to))
      for (std::size_t p = 0; p < gauss.at.size(); ++p) {
        const double u = from + (to - from) * gauss.at[p];
        const auto block = block_of(process, tau * (static_cast<double>(j) + u));
        sum += 2.0 * tau * tau * (to - from) * gauss.weight[p] * ((1.0 - u) * pairs(j) + u * pairs(j + 1)) *
               (block.h * block.Phi * block.P * block.h.transpose())(0, 0);
      }
  return sum;
}

/// The same of a stationary series that is held from sample to sample, tau a whole number of them: the sum over all pairs, by
/// lag.
double mean_square_of_series(const noise::Process& process, double tau, const std::vector<double>& weights) {
  const double interval = *process.sample_interval();
  const auto m = static_cast<std::size_t>(std::lround(tau / interval));
  const auto pairs = [&](std::size_t lag) {  // of intervals that far apart
    double sum = 0.0;
    for (std::size_t i = 0; i + lag < weights.size(); ++i) sum += weights[i] * weights[i + lag];
    return sum;
  };
  double sum = 0.0;
  for (std::size_t lag = 0; lag < weights.size() * m; ++lag) {
    const auto far = static_cast<double>(lag % m), near = static_cast<double>(m) - far;
    const auto block = block_of(process, std::max(1e-300, interval * static_cast<double>(lag)));
    sum += (lag == 0 ? 1.0 : 2.0) * (near * pairs(lag / m) + far * pairs(lag / m + 1)) *
           (block.h * block.Phi * block.P * block.h.transpose())(0, 0);
  }
  return interval * interval * sum;
}

/// And with what has no state: the errors of a rounded integral are independent at both ends of each interval.
double mean_square_by_propagation(const noise::Process& process, double tau, const std::vector<double>& weights) {
  if (process.sample_interval()) return mean_square_of_series(process, tau, weights);
  if (process.states() > 1 && is_stationary(process)) return mean_square_by_lag(process, tau, weights);
  double sum = mean_square_in_continuous_time(process, tau, weights);
  const auto rounding = process.rounding();
  if (!rounding || rounding->of != noise::Rounding::Of::kIntegral) return sum;
  for (std::size_t i = 0; i <= weights.size(); ++i) {
    const double change = (i > 0 ? weights[i - 1] : 0.0) - (i < weights.size() ? weights[i] : 0.0);
    sum += change * change * rounding->step * rounding->step / 12.0;
  }
  return sum;
}

TEST_P(EveryProcess, ClosedFormVariancesAreThoseOfTheBlock) {
  for (const auto& process : processes_of(GetParam().text(), GetParam().sensor)) {
    for (const double any : {0.01, 1.0, 700.0, 1400.0, 9000.0}) {
      const double tau = std::max(any, process->sample_interval().value_or(0.0));
      const auto allan = process->allan_variance(tau), hadamard = process->hadamard_variance(tau);
      EXPECT_EQ(allan.has_value(), process->input() == noise::Input::kOne);
      EXPECT_EQ(hadamard.has_value(), process->input() == noise::Input::kOne);
      if (!allan || !hadamard) continue;
      // A bias or a ramp is differenced away: what rounding leaves of its variance, and of each term of the sums.
      const double rounding =
          process->states() == 0 ? 0.0 : 1e-15 * mean_square_by_propagation(*process, tau, {1.0, 2.0, 1.0}) / (tau * tau);
      const double by_block = mean_square_by_propagation(*process, tau, {1.0, -1.0}) / (2.0 * tau * tau);
      EXPECT_NEAR(*allan, by_block, 1e-11 * by_block + rounding) << tau;
      const double third = mean_square_by_propagation(*process, tau, {1.0, -2.0, 1.0}) / (6.0 * tau * tau);
      EXPECT_NEAR(*hadamard, third, 1e-11 * third + rounding) << tau;
    }
  }
}

// A spoiled entry is an error that names the line of what is wrong (the entry stands alone on line 1).
TEST_P(EveryProcess, SpoiledEntriesAreRefusedWithTheirLine) {
  const std::string good = GetParam().text();
  const std::regex unit(", unit: [^,}]+"), value("(sigma|density|slope|coefficient|step): [^,}]+");
  std::vector<std::string> all = {std::regex_replace(good, unit, ""),
                                  std::regex_replace(good, unit, ", unit: K/h"),
                                  std::regex_replace(good, unit, ", unit: " + std::string("m")),
                                  std::regex_replace(good, value, "$1: large"),
                                  std::regex_replace(good, value, "lambda: 1"),
                                  std::regex_replace(good, std::regex("process: [a-z_]+"), "process: brown_noise")};
  if (GetParam().registration->name != "drift")
    all.push_back(std::regex_replace(good, value, "$1: -1"));  // downhill is a slope
  for (const std::string& spoiled : all) {
    ASSERT_NE(spoiled, good);
    try {
      (void)processes_of(spoiled, GetParam().sensor);
      ADD_FAILURE() << "accepted: " << spoiled;
    } catch (const InputError& e) {
      EXPECT_EQ(e.parts().line, 1) << e.what();
      EXPECT_EQ(std::string(e.what()).rfind("entry.yaml:1: ", 0), 0u) << e.what();
    }
  }
}

TEST(Registry, UnknownProcessNamesTheNearest) {
  try {
    (void)process_of("{process: white_nose, density: 1, unit: rad/s}", Sensor::kGyro);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("white_noise?"), std::string::npos) << e.what();
  }
}

TEST(WhiteNoise, UnitsOfDataSheets) {
  // 0.15 deg/sqrt(h): deg = pi/180 rad, sqrt(h) = 60 sqrt(s). 50 ug/sqrt(Hz): g = 9.80665 m/s^2.
  const double arw = 0.15 * M_PI / 180.0 / 60.0;
  const double vrw = 50e-6 * 9.80665;
  const auto density = [](const char* entry, Sensor sensor, double rate = 0.0) {
    return process_of(entry, sensor, rate)->white_density().value;
  };
  EXPECT_NEAR(density("{process: white_noise, density: 0.15, unit: deg/sqrt(h)}", Sensor::kGyro), arw * arw, 1e-14 * arw * arw);
  EXPECT_NEAR(density("{process: white_noise, density: 50, unit: ug/sqrt(Hz)}", Sensor::kAccel), vrw * vrw, 1e-14 * vrw * vrw);
  EXPECT_NEAR(density("{process: white_noise, density: 0.6, unit: m/s/sqrt(h)}", Sensor::kAccel), 1e-4, 1e-18);
  // A variance of samples at 100 Hz is a density of a hundredth: the paper's 3.6e-5 (m/s^2)^2 is 61 ug/sqrt(Hz).
  EXPECT_NEAR(density("{process: white_noise, variance_per_sample: 3.6e-5, unit: (m/s^2)^2}", Sensor::kAccel, 100.0), 3.6e-7,
              1e-21);
}

TEST(WhiteNoise, VariancePerSampleNeedsARate) {
  EXPECT_THROW((void)process_of("{process: white_noise, variance_per_sample: 1, unit: (m/s^2)^2}", Sensor::kAccel), InputError);
}

TEST(GaussMarkov, AutocovarianceIsExponentialAndStationary) {
  const double sigma = 2e-4, time = 2500.0;
  const auto process =
      process_of("{process: gauss_markov, sigma: 2e-4, unit: m/s^2, correlation_time_s: 2500}", Sensor::kAccel);
  for (const double lag : {1e-6, 0.01, 1.0, 400.0, 2500.0, 1e5}) {
    const auto block = block_of(*process, lag);
    EXPECT_NEAR((block.Phi * block.P)(0, 0), sigma * sigma * std::exp(-lag / time), 1e-15 * sigma * sigma) << lag;
    EXPECT_NEAR((block.Phi * block.P * block.Phi + block.Q_d)(0, 0), sigma * sigma, 1e-15 * sigma * sigma) << lag;
  }
  // Q_d -> 2 beta sigma^2 dt (1 - beta dt): full precision where 1 - phi^2 would leave nine digits.
  const double dt = 1e-6, beta = 1.0 / time;
  const double expected = 2.0 * beta * sigma * sigma * dt * (1.0 - beta * dt);
  EXPECT_NEAR(block_of(*process, dt).Q_d(0, 0), expected, 1e-13 * expected);
}

TEST(GaussMarkov, FirstOrderFormsAreThePapersAtTheModelsRate) {
  const double sigma2 = 1e-8, beta = 0.10;
  const auto form = [](const char* name, double rate) {
    return process_of(
        std::string("{process: gauss_markov, sigma: 1e-4, unit: m/s^2, correlation_time_s: 10, first_order: ") + name + "}",
        Sensor::kAccel, rate);
  };
  for (const double rate : {1.0, 100.0}) {
    const double dt = 1.0 / rate;
    const auto table1 = block_of(*form("table1", rate), dt), section2e = block_of(*form("section2e", rate), dt);
    EXPECT_NEAR(table1.Phi(0, 0), 1.0 - beta * dt, 1e-15);
    EXPECT_NEAR(section2e.Phi(0, 0), 1.0 - beta * dt, 1e-15);
    EXPECT_NEAR(table1.Q_d(0, 0), dt * dt * 2.0 * beta * sigma2, 1e-13 * dt * dt * sigma2);
    EXPECT_NEAR(section2e.Q_d(0, 0), 2.0 * beta * sigma2, 1e-13 * sigma2);
  }
  // Over a longer interval: as many of those steps.
  const auto process = form("section2e", 100.0);
  double phi = 1.0, q = 0.0;
  for (int k = 0; k < 50; ++k) {
    phi *= 1.0 - beta * 0.01;
    q = (1.0 - beta * 0.01) * (1.0 - beta * 0.01) * q + 2.0 * beta * sigma2;
  }
  EXPECT_NEAR(block_of(*process, 0.5).Phi(0, 0), phi, 1e-14);
  EXPECT_NEAR(block_of(*process, 0.5).Q_d(0, 0), q, 1e-13 * q);
}

TEST(GaussMarkov, FirstOrderFormsSurviveWritingAndNeedARateThatCarriesThem) {
  const std::string entry = "{process: gauss_markov, sigma: 1e-4, unit: m/s^2, correlation_time_s: 10, first_order: table1}";
  const auto before = process_of(entry, Sensor::kAccel, 100.0);
  const auto after = process_of(before->yaml(), Sensor::kAccel, 100.0);
  EXPECT_NE(before->yaml().find("first_order: table1"), std::string::npos);
  EXPECT_NEAR(block_of(*after, 0.01).Q_d(0, 0), block_of(*before, 0.01).Q_d(0, 0), 1e-14 * 1e-8);
  EXPECT_THROW((void)process_of(entry, Sensor::kAccel), InputError);        // no rate: a step of what length?
  EXPECT_THROW((void)process_of(entry, Sensor::kAccel, 0.05), InputError);  // 1 - beta dt is negative
}

TEST(RandomWalk, VarianceGrowsFromZeroWithTime) {
  const auto process = process_of("{process: random_walk, density: 2, unit: deg/h/sqrt(h)}", Sensor::kGyro);
  const double density = 2.0 * M_PI / 180.0 / 3600.0 / 60.0;
  const auto block = block_of(*process, 1234.5);
  EXPECT_EQ(block.P(0, 0), 0.0);
  EXPECT_EQ(block.Phi(0, 0), 1.0);
  EXPECT_NEAR(block.Q_d(0, 0), density * density * 1234.5, 1e-14 * density * density * 1234.5);
}

// At small beta tau the closed forms are a walk's of density 2 beta sigma^2, less 3/4 of beta tau (Allan); Hadamard's differs
// from it in the second order only.
TEST(GaussMarkov, VariancesKeepTheirDigitsWhereTheProcessHasHardlyMoved) {
  const double sigma = 2e-4, time = 2500.0;
  const auto process =
      process_of("{process: gauss_markov, sigma: 2e-4, unit: m/s^2, correlation_time_s: 2500}", Sensor::kAccel);
  for (const double tau : {1e-4, 1e-2}) {
    const double u = tau / time;
    const double walk = 2.0 * sigma * sigma * u;
    EXPECT_NEAR(*process->allan_variance(tau), walk / 3.0 * (1.0 - 0.75 * u), 1e-10 * walk);
    EXPECT_NEAR(*process->hadamard_variance(tau), walk / 6.0, 1e-10 * walk);
  }
}

TEST(RandomConstant, HasNoAllanVariance) {
  const auto process = process_of("{process: random_constant, sigma: 1, unit: mg}", Sensor::kAccel);
  EXPECT_EQ(process->allan_variance(3.0), 0.0);
  EXPECT_EQ(process->hadamard_variance(3.0), 0.0);
}

TEST(RandomConstant, StaysWhatItWas) {
  const auto process = process_of("{process: random_constant, sigma: 1, unit: mg}", Sensor::kAccel);
  const auto block = block_of(*process, 1e4);
  EXPECT_EQ(block.Phi(0, 0), 1.0);
  EXPECT_EQ(block.Q_d(0, 0), 0.0);
  EXPECT_NEAR(block.P(0, 0), 9.80665e-3 * 9.80665e-3, 1e-18);
}

TEST(Drift, IsKnownFromTheStartAndMayFall) {
  const auto process = process_of("{process: drift, slope: -0.4, unit: deg/h/h}", Sensor::kGyro);
  const double slope = -0.4 * M_PI / 180.0 / 3600.0 / 3600.0;
  const auto block = block_of(*process, 7200.0);
  EXPECT_TRUE(block.P.isZero(0.0));
  EXPECT_TRUE(block.Q_d.isZero(0.0));
  EXPECT_NEAR((block.h * block.Phi * block.mean)(0, 0), 7200.0 * slope, 1e-14 * 7200.0 * std::abs(slope));
  EXPECT_NEAR(*process->allan_variance(50.0), 1250.0 * slope * slope, 1e-14 * 1250.0 * slope * slope);
  EXPECT_EQ(*process->hadamard_variance(50.0), 0.0);
}

TEST(RateRamp, IsADriftWhoseSlopeIsDrawn) {
  const auto process = process_of("{process: rate_ramp, coefficient: 20, unit: ug/h}", Sensor::kAccel);
  const double slope = 20e-6 * 9.80665 / 3600.0;
  const auto block = block_of(*process, 100.0);
  EXPECT_TRUE(block.mean.isZero(0.0));
  const double variance = (block.h * block.Phi * block.P * block.Phi.transpose() * block.h.transpose())(0, 0);
  EXPECT_NEAR(variance, 1e4 * slope * slope, 1e-14 * 1e4 * slope * slope);
  EXPECT_NEAR(*process->allan_variance(std::sqrt(2.0)), slope * slope, 1e-14 * slope * slope);  // where people read R
}

// Backwards a straight line through the value falls where it rose, and steps on to where it came from.
TEST(RateRamp, ReversedStatesLeadBack) {
  const auto process = process_of("{process: rate_ramp, coefficient: 20, unit: ug/h}", Sensor::kAccel);
  Eigen::VectorXd sign(2);
  process->reversal(sign);
  const Eigen::Vector2d start(3.0, 0.25);
  const Eigen::Matrix2d Phi = block_of(*process, 40.0).Phi, mirror = sign.asDiagonal();
  const Eigen::Vector2d back = mirror * Phi * mirror * Phi * start;
  EXPECT_EQ(back, start);
}

TEST(ScaleFactor, MultipliesItsOwnAxis) {
  const auto process = process_of("{process: scale_factor, sigma: 300, unit: ppm}", Sensor::kGyro);
  EXPECT_EQ(process->input(), noise::Input::kOwnAxis);
  EXPECT_NEAR(block_of(*process, 1.0).P(0, 0), 9e-8, 1e-22);
  const auto drifting = process_of("{process: scale_factor, sigma: 300, unit: ppm, correlation_time_s: 50}", Sensor::kGyro);
  EXPECT_NEAR(block_of(*drifting, 50.0).Phi(0, 0), std::exp(-1.0), 1e-15);
}

TEST(Misalignment, IsTwoAnglesToTheOtherAxes) {
  const auto angles = processes_of("{process: misalignment, sigma: 0.05, unit: deg}", Sensor::kAccel);
  ASSERT_EQ(angles.size(), 2u);
  EXPECT_EQ(angles[0]->input(), noise::Input::kNextAxis);
  EXPECT_EQ(angles[1]->input(), noise::Input::kPrevAxis);
  for (const auto& angle : angles) EXPECT_NEAR(std::sqrt(block_of(*angle, 1.0).P(0, 0)), 0.05 * M_PI / 180.0, 1e-18);
}

}  // namespace
}  // namespace coast
