#pragma once
// Common base of drift and rate ramp: a constant slope and its integral.

#include "coast/noise/process.hpp"

namespace coast::noise {

/// x = [value, slope], value = slope (t - start). Derived classes define the initial slope and its uncertainty.
class LinearRamp : public Process {
 public:
  [[nodiscard]] int states() const override { return 2; }
  void transition(double dt, Eigen::Ref<Eigen::MatrixXd> Phi) const override {
    Phi.setIdentity();
    Phi(0, 1) = dt;
  }
  void driving_noise(double, Eigen::Ref<Eigen::MatrixXd> Q_d) const override { Q_d.setZero(); }
  void output(Eigen::Ref<Eigen::RowVectorXd> h) const override {
    h(0) = 1.0;
    h(1) = 0.0;
  }
  void initial_covariance(Eigen::Ref<Eigen::MatrixXd> P) const override { P.setZero(); }
  void reversal(Eigen::Ref<Eigen::VectorXd> sign) const override {
    sign(0) = 1.0;
    sign(1) = -1.0;
  }
  /// IEEE Std 952-1997 annex C: R^2 tau^2/2. The Hadamard variance is zero: second differences remove a straight line.
  [[nodiscard]] std::optional<double> allan_variance(double tau) const override {
    return 0.5 * mean_square_slope() * tau * tau;
  }
  [[nodiscard]] std::optional<double> hadamard_variance(double) const override { return 0.0; }

 protected:
  [[nodiscard]] virtual double mean_square_slope() const = 0;  ///< ([signal]/s)^2
};

}  // namespace coast::noise
