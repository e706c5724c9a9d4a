#include "coast/ins/compensation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "coast/geo/units.hpp"

namespace coast::ins {
namespace {

constexpr int kWindow = static_cast<int>(kCompensationWindow);
constexpr int kNodes = 7;             // Chebyshev points per interval: polynomials of degree 6 on 1/11 of the window
constexpr int kMaxIterations = 12;    // each reduces the error by a factor |dtheta|/2 or better
constexpr double kConverged = 1e-14;  // rad

using Increments = Eigen::Matrix<double, 6, kWindow>;  // columns (dtheta, dv)
using Nodes3 = Eigen::Matrix<double, 3, kNodes>;
using Nodes6 = Eigen::Matrix<double, 6, kNodes>;
using Fit = Eigen::Matrix<double, kWindow, kNodes>;

// All quantities that depend only on the geometry. Time s is in [0, 1] in the requested interval.
struct Tables {
  std::array<Fit, kWindow> rate;                   // by position: increments to rates (times dt) at the nodes
  std::array<Fit, kWindow> angle;                  // increments to integrals from s = 0 to the nodes
  Eigen::Matrix<double, kNodes, kNodes> integral;  // values at nodes to integrals from 0 to a node: column = end node
  Eigen::Matrix<double, kNodes, 1> weights;        // to the integral over [0, 1]
};

double node(int i) {
  return 0.5 * (1.0 - std::cos(geo::kPi * (2 * i + 1) / (2.0 * kNodes)));
}

// Lagrange polynomial k through 0, 1, .., kWindow at t, and its derivative, by the product rule: no division, exact at nodes.
struct Lagrange {
  double value;
  double derivative;
};
Lagrange lagrange(int k, double t) {
  Lagrange l{1.0, 0.0};
  for (int i = 0; i <= kWindow; ++i) {
    if (i == k) continue;
    l.derivative = (l.derivative * (t - i) + l.value) / (k - i);
    l.value *= (t - i) / (k - i);
  }
  return l;
}

// The integral up to the end of interval k is the sum of increments 0..k: increment j affects all later ends.
void fill_fit(Tables& tables, int position) {
  for (int i = 0; i < kNodes; ++i) {
    double rate = 0.0;
    double angle = 0.0;
    for (int j = kWindow - 1; j >= 0; --j) {
      const Lagrange at_node = lagrange(j + 1, position + node(i));
      rate += at_node.derivative;
      angle += at_node.value - lagrange(j + 1, position).value;
      tables.rate[static_cast<std::size_t>(position)](j, i) = rate;
      tables.angle[static_cast<std::size_t>(position)](j, i) = angle;
    }
  }
}

// Integral of the Chebyshev polynomial T_k from -1 to x.
double chebyshev_integral(int k, double x) {
  const auto T = [x](int m) { return std::cos(m * std::acos(x)); };
  if (k == 0) return x + 1.0;
  if (k == 1) return 0.5 * (x * x - 1.0);
  const double at_start = (k % 2 == 0 ? -1.0 : 1.0) * (0.5 / (k + 1) - 0.5 / (k - 1));
  return 0.5 * T(k + 1) / (k + 1) - 0.5 * T(k - 1) / (k - 1) - at_start;
}

// Values at the Chebyshev points determine the coefficients (discrete orthogonality), and these the integral; ds = dx / 2.
double integral_of_cardinal(int j, double s) {
  double sum = 0.0;
  for (int k = 0; k < kNodes; ++k) {
    const double T_k = std::cos(k * std::acos(2.0 * node(j) - 1.0));
    sum += (k == 0 ? 1.0 : 2.0) / kNodes * T_k * chebyshev_integral(k, 2.0 * s - 1.0);
  }
  return 0.5 * sum;
}

Tables make_tables() {
  Tables tables;
  for (int position = 0; position < kWindow; ++position) fill_fit(tables, position);
  for (int j = 0; j < kNodes; ++j) {
    for (int i = 0; i < kNodes; ++i) tables.integral(j, i) = integral_of_cardinal(j, node(i));
    tables.weights(j) = integral_of_cardinal(j, 1.0);
  }
  return tables;
}

const Tables& tables() {
  static const Tables instance = make_tables();
  return instance;
}

// Difference between the derivative of the Rodrigues vector and the rate.
Eigen::Vector3d rodrigues_excess(const Eigen::Vector3d& g, const Eigen::Vector3d& omega) {
  return 0.5 * g.cross(omega) + (0.25 * g.dot(omega)) * g;
}

// 2 atan(a/2)/a by series for small angles, the usual case.
Eigen::Vector3d rotation_vector_from_rodrigues(const Eigen::Vector3d& g) {
  const double x = 0.25 * g.squaredNorm();
  if (x < 1e-3) return g * (1.0 - x * (1.0 / 3.0 - x * (1.0 / 5.0 - x * (1.0 / 7.0 - x * (1.0 / 9.0 - x / 11.0)))));
  const double half = std::sqrt(x);
  return g * (std::atan(half) / half);
}

BodyIncrement iterate(const Increments& increments, std::size_t position, double dt) {
  const Tables& table = tables();
  const Nodes6 rates = increments.lazyProduct(table.rate[position]);
  const Nodes3 theta = increments.topRows<3>().lazyProduct(table.angle[position]);
  const Increments::ConstColXpr own = increments.col(static_cast<Eigen::Index>(position));

  Nodes3 g = theta;
  Nodes3 excess;
  Eigen::Vector3d g_end = own.head<3>();
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    for (int i = 0; i < kNodes; ++i) excess.col(i) = rodrigues_excess(g.col(i), rates.col(i).head<3>());
    const Eigen::Vector3d last = g_end;
    g_end = own.head<3>() + excess * table.weights;
    g = theta + excess.lazyProduct(table.integral);
    if ((g_end - last).squaredNorm() < kConverged * kConverged) break;
  }

  Eigen::Vector3d u = own.tail<3>();  // C(g) f = f + (g x f + g x (g x f)/2) / (1 + g^2/4)
  for (int i = 0; i < kNodes; ++i) {
    const Eigen::Vector3d g_i = g.col(i);
    const Eigen::Vector3d turned = g_i.cross(rates.col(i).tail<3>());
    u += (table.weights(i) / (1.0 + 0.25 * g_i.squaredNorm())) * (turned + 0.5 * g_i.cross(turned));
  }
  return {dt, rotation_vector_from_rodrigues(g_end), u};
}

Eigen::Matrix<double, 6, 1> column(const Eigen::Vector3d& dtheta, const Eigen::Vector3d& dv) {
  return (Eigen::Matrix<double, 6, 1>() << dtheta, dv).finished();
}

RawIncrement raw(const record::ImuSample& sample) {
  return {sample.dt, sample.dtheta, sample.dv};
}

void store(const BodyIncrement& increment, record::ImuSample& sample) {
  sample.dtheta = increment.phi;
  sample.dv = increment.u;
}

// Tags have rounding errors; a tenth of an interval is no missing time.
bool adjoins(const record::ImuSample& previous, const record::ImuSample& next) {
  return std::abs((next.t - previous.t) - next.dt) < 0.1 * next.dt;
}

// End of the run of equal adjoining intervals that starts at `first`.
std::size_t end_of_run(const std::vector<record::ImuSample>& samples, std::size_t first) {
  std::size_t end = first + 1;
  while (end < samples.size() && adjoins(samples[end - 1], samples[end]) &&
         std::abs(samples[end].dt - samples[first].dt) < 1e-3 * samples[first].dt + 2e-6)
    ++end;
  return end;
}

// [first, last) contains at least one window.
void compensate_run(std::span<record::ImuSample> run) {
  Increments window;
  for (std::size_t j = 0; j < kCompensationWindow; ++j)
    window.col(static_cast<Eigen::Index>(j)) = column(run[j].dtheta, run[j].dv);
  std::size_t start = 0;  // of the window in the run; its content is raw even if the run is compensated already
  for (std::size_t i = 0; i < run.size(); ++i) {
    if (i - start > kCompensationWindow / 2 && start + kCompensationWindow < run.size()) {
      const record::ImuSample& next = run[start + kCompensationWindow];
      std::copy(window.data() + 6, window.data() + window.size(), window.data());
      window.col(kWindow - 1) = column(next.dtheta, next.dv);
      ++start;
    }
    store(iterate(window, i - start, run[i].dt), run[i]);
  }
}

}  // namespace

BodyIncrement compensate_chebyshev(std::span<const RawIncrement> window, std::size_t position) {
  if (window.size() != kCompensationWindow)
    throw std::invalid_argument(
        fmt::format("compensate_chebyshev: {} increments, expected {}", window.size(), kCompensationWindow));
  if (position >= window.size())
    throw std::invalid_argument(fmt::format("compensate_chebyshev: position {} is outside the window", position));
  Increments increments;
  for (std::size_t j = 0; j < window.size(); ++j)
    increments.col(static_cast<Eigen::Index>(j)) = column(window[j].dtheta, window[j].dv);
  return iterate(increments, position, window[position].dt);
}

void compensate_chebyshev(record::ImuRecording& body) {
  std::vector<record::ImuSample>& samples = body.samples;
  RawIncrement previous;  // raw, of the sample before the current one; dt = 0 if there is none or time is missing
  for (std::size_t first = 0; first < samples.size();) {
    const std::size_t end = end_of_run(samples, first);
    const RawIncrement last = raw(samples[end - 1]);
    if (end - first >= kCompensationWindow) {
      compensate_run({samples.data() + first, end - first});
    } else {
      for (std::size_t i = first; i < end; ++i) {
        const RawIncrement current = raw(samples[i]);
        store(compensate_two_sample(previous, current), samples[i]);
        previous = current;
      }
    }
    previous = end < samples.size() && adjoins(samples[end - 1], samples[end]) ? last : RawIncrement{};
    first = end;
  }
}

BodyIncrement without_bias(const BodyIncrement& increment, const Eigen::Vector3d& gyro_bias,
                           const Eigen::Vector3d& accel_bias) {
  const double dt = increment.dt;
  const Eigen::Vector3d phi = increment.phi - dt * gyro_bias;
  const Eigen::Vector3d u = increment.u - dt * accel_bias - 0.5 * dt * (phi.cross(accel_bias) + gyro_bias.cross(increment.u));
  return {dt, phi, u};
}

}  // namespace coast::ins
