#include "coast/simulate/sensor_errors.hpp"

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "coast/simulate/random.hpp"

namespace coast::simulate {
namespace {

constexpr double kSameInstant = 1.5e-9;  // s; epochs are rounded to a nanosecond, and intervals that differ less are equal

// Square root L of a positive semidefinite matrix, L L' = P: driving noise may be singular, so no Cholesky.
Eigen::MatrixXd square_root(const Eigen::MatrixXd& P) {
  if (P.rows() == 1) return P.cwiseMax(0.0).cwiseSqrt();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(P);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

}  // namespace

struct Realisation::State {
  State(noise::ProcessPtr p, std::uint64_t seed) : process(std::move(p)), normal(seed) {
    const int n = process->states();
    density = process->white_density().value;
    x = w = before = Eigen::VectorXd::Zero(n);
    h = Eigen::RowVectorXd::Zero(n);
    Phi = L = Eigen::MatrixXd::Zero(n, n);
    if (n == 0) return;
    process->output(h);
    Eigen::MatrixXd P = Eigen::MatrixXd::Zero(n, n);
    process->initial_covariance(P);
    draw();
    process->initial_mean(x);
    x += square_root(P) * w;
    held = process->sample_interval();
  }

  void draw() {
    for (Eigen::Index i = 0; i < w.size(); ++i) w[i] = normal();
  }

  void discretise(double dt) {
    if (std::abs(dt - step) <= kSameInstant) return;
    step = dt;
    Eigen::MatrixXd Q_d = Eigen::MatrixXd::Zero(x.size(), x.size());
    Phi.setZero();
    process->transition(dt, Phi);
    process->driving_noise(dt, Q_d);
    L = square_root(Q_d);
  }

  void advance(double dt) {
    discretise(dt);
    draw();
    before = x;
    x.noalias() = Phi * before;
    x.noalias() += L * w;
  }

  double mean_of_states(double dt) {
    if (x.size() == 0) return 0.0;
    if (held) return mean_of_held(dt);
    advance(dt);
    return 0.5 * (h.dot(before) + h.dot(x));
  }

  // A series at its own rate: each value is weighted by the time that it is held within the interval.
  double mean_of_held(double dt) {
    double integral = 0.0;
    for (double left = dt; left > kSameInstant;) {
      const double part = std::min(left, *held - held_for);
      integral += part * h.dot(x);
      left -= part;
      held_for += part;
      if (*held - held_for > kSameInstant) continue;
      advance(*held);
      held_for = 0.0;
    }
    return integral / dt;
  }

  noise::ProcessPtr process;
  Normal normal;
  double density = 0.0;
  double step = 0.0;
  std::optional<double> held;  // s, interval of a series
  double held_for = 0.0;       // s, of the present value
  Eigen::VectorXd x, w, before;
  Eigen::RowVectorXd h;
  Eigen::MatrixXd Phi, L;
};

Realisation::Realisation(noise::ProcessPtr process, std::uint64_t seed)
    : state_(std::make_unique<State>(std::move(process), seed)) {}
Realisation::~Realisation() = default;
Realisation::Realisation(Realisation&&) noexcept = default;
Realisation& Realisation::operator=(Realisation&&) noexcept = default;

double Realisation::next(double dt) {
  const double mean = state_->mean_of_states(dt);
  return state_->density > 0.0 ? mean + std::sqrt(state_->density / dt) * state_->normal() : mean;
}

namespace {

// The input of a process: the interval for an additive error, else the true increment of its axis.
double input_increment(noise::Input input, std::size_t axis, const Eigen::Vector3d& truth, double dt) {
  const auto component = [&](std::size_t i) { return truth[static_cast<Eigen::Index>(i % 3)]; };
  switch (input) {
    case noise::Input::kOne:
      return dt;
    case noise::Input::kOwnAxis:
      return component(axis);
    case noise::Input::kNextAxis:
      return component(axis + 1);
    case noise::Input::kPrevAxis:
      return component(axis + 2);
  }
  return 0.0;
}

void add_errors(record::ImuRecording& recording, const record::ImuRecording& truth,
                Eigen::Vector3d record::ImuSample::*increment, const noise::ProcessPtr& process, std::size_t axis,
                std::uint64_t seed) {
  Realisation realisation(process, seed);
  for (std::size_t k = 0; k < truth.samples.size(); ++k) {
    const record::ImuSample& sample = truth.samples[k];
    const double input = input_increment(process->input(), axis, sample.*increment, sample.dt);
    (recording.samples[k].*increment)[static_cast<Eigen::Index>(axis)] += realisation.next(sample.dt) * input;
  }
}

// The residue carried from sample to sample keeps the integral within half a step of the exact one, for a recording of any
// length. The initial position in the step is random.
void round_integral(record::ImuRecording& recording, Eigen::Vector3d record::ImuSample::*increment, double step,
                    Eigen::Index axis, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  double residue = std::uniform_real_distribution<double>(-0.5 * step, 0.5 * step)(engine);
  for (record::ImuSample& sample : recording.samples) {
    double& value = (sample.*increment)[axis];
    const double whole = step * std::round((residue + value) / step);
    residue += value - whole;
    value = whole;
  }
}

void round_samples(record::ImuRecording& recording, Eigen::Vector3d record::ImuSample::*increment, double step,
                   Eigen::Index axis) {
  for (record::ImuSample& sample : recording.samples) {
    double& value = (sample.*increment)[axis];
    value = step * std::round(value / (step * sample.dt)) * sample.dt;
  }
}

}  // namespace

record::ImuRecording with_errors(const record::ImuRecording& truth, const noise::ImuErrorModel& model, std::uint64_t seed) {
  record::ImuRecording measured = truth;
  for (const noise::Sensor sensor : {noise::Sensor::kGyro, noise::Sensor::kAccel}) {
    const bool gyro = sensor == noise::Sensor::kGyro;
    const auto increment = gyro ? &record::ImuSample::dtheta : &record::ImuSample::dv;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::vector<noise::ProcessPtr>& processes = model.axes(sensor)[axis];
      const auto stream = [&](std::size_t p) { return stream_seed(seed, {gyro ? 1u : 2u, axis, p}); };
      for (std::size_t p = 0; p < processes.size(); ++p)
        if (!processes[p]->rounding()) add_errors(measured, truth, increment, processes[p], axis, stream(p));
      for (std::size_t p = 0; p < processes.size(); ++p) {
        const auto rounding = processes[p]->rounding();
        if (!rounding) continue;
        const auto component = static_cast<Eigen::Index>(axis);
        if (rounding->of == noise::Rounding::Of::kIntegral)
          round_integral(measured, increment, rounding->step, component, stream(p));
        else
          round_samples(measured, increment, rounding->step, component);
      }
    }
  }
  return measured;
}

}  // namespace coast::simulate
