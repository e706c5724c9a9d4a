#pragma once
// A process with a single state: common base of white noise, constants, walks and Gauss-Markov processes.

#include "coast/noise/process.hpp"

namespace coast::noise {

/// x[k+1] = phi(dt) x[k] + w, var w = q(dt), error = x * input. Derived classes define phi, q and the initial variance.
class ScalarProcess : public Process {
 public:
  [[nodiscard]] int states() const override { return 1; }
  void transition(double dt, Eigen::Ref<Eigen::MatrixXd> Phi) const override { Phi(0, 0) = phi(dt); }
  void driving_noise(double dt, Eigen::Ref<Eigen::MatrixXd> Q_d) const override { Q_d(0, 0) = q(dt); }
  void output(Eigen::Ref<Eigen::RowVectorXd> h) const override { h(0) = 1.0; }
  void initial_covariance(Eigen::Ref<Eigen::MatrixXd> P) const override { P(0, 0) = initial_variance(); }

 protected:
  [[nodiscard]] virtual double phi(double dt) const = 0;
  [[nodiscard]] virtual double q(double dt) const = 0;
  [[nodiscard]] virtual double initial_variance() const = 0;
};

}  // namespace coast::noise
