#include "support/spectra.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace coast::test {

Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& symmetric) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric, Eigen::EigenvaluesOnly).eigenvalues();
}

double condition_number(const Eigen::MatrixXd& A) {
  const Eigen::VectorXd squares = eigenvalues(A.transpose() * A);
  return std::sqrt(squares(squares.size() - 1) / squares(0));
}

}  // namespace coast::test
