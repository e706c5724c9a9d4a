#pragma once
// Spectra of dense matrices, for tests: one instance of a solver that takes the compiler seconds.

#include <Eigen/Core>

namespace coast::test {

/// Ascending.
Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& symmetric);

/// Largest over smallest singular value, by the eigenvalues of A' A: right to 1e-16 times its square, up to some 1e6.
double condition_number(const Eigen::MatrixXd& A);

}  // namespace coast::test
