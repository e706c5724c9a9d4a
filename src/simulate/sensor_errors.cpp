#include "coast/simulate/sensor_errors.hpp"

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <vector>

#include "random.hpp"

namespace coast::simulate {
namespace {

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
    x = square_root(P) * w;
  }

  void draw() {
    for (Eigen::Index i = 0; i < w.size(); ++i) w[i] = normal();
  }

  void discretise(double dt) {
    // Epochs are rounded to a nanosecond; intervals that differ by no more share their step.
    if (std::abs(dt - step) <= 1.5e-9) return;
    step = dt;
    Eigen::MatrixXd Q_d = Eigen::MatrixXd::Zero(x.size(), x.size());
    Phi.setZero();
    process->transition(dt, Phi);
    process->driving_noise(dt, Q_d);
    L = square_root(Q_d);
  }

  double mean_of_states(double dt) {
    if (x.size() == 0) return 0.0;
    discretise(dt);
    draw();
    before = x;
    x.noalias() = Phi * before;
    x.noalias() += L * w;
    return 0.5 * (h.dot(before) + h.dot(x));
  }

  noise::ProcessPtr process;
  Normal normal;
  double density = 0.0;
  double step = 0.0;
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

// What one process multiplies: the interval for an additive error, else the true increment of the axis it belongs to.
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

}  // namespace

record::ImuRecording with_errors(const record::ImuRecording& truth, const noise::ImuErrorModel& model, std::uint64_t seed) {
  record::ImuRecording measured = truth;
  for (const noise::Sensor sensor : {noise::Sensor::kGyro, noise::Sensor::kAccel}) {
    const bool gyro = sensor == noise::Sensor::kGyro;
    const auto increment = gyro ? &record::ImuSample::dtheta : &record::ImuSample::dv;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::vector<noise::ProcessPtr>& processes = model.axes(sensor)[axis];
      for (std::size_t p = 0; p < processes.size(); ++p)
        add_errors(measured, truth, increment, processes[p], axis, stream_seed(seed, {gyro ? 1u : 2u, axis, p}));
    }
  }
  return measured;
}

}  // namespace coast::simulate
