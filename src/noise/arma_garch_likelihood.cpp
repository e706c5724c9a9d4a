#include <Eigen/LU>

#include "arma_garch_checks.hpp"
#include "arma_garch_recursion.hpp"

namespace coast::noise {

using Eigen::VectorXd;

namespace {

ArmaGarchRecursion checked_recursion(const ArmaGarch& model, const ArmaGarchSeries& series, ArmaGarchStart start) {
  check_arma_garch(model);
  check_arma_garch(series, model.orders());
  return {model.orders(), series, start};
}

}  // namespace

ArmaGarchResiduals arma_garch_residuals(const ArmaGarch& model, const ArmaGarchSeries& series, ArmaGarchStart start) {
  ArmaGarchRecursion recursion = checked_recursion(model, series, start);
  static_cast<void>(recursion.value(centred_vector(model)));
  const std::span<const double> e = recursion.residuals();
  const std::span<const double> h = recursion.variances();
  return {{e.begin(), e.end()}, {h.begin(), h.end()}};
}

double arma_garch_log_likelihood(const ArmaGarch& model, const ArmaGarchSeries& series, ArmaGarchStart start) {
  return checked_recursion(model, series, start).value(centred_vector(model));
}

VectorXd arma_garch_gradient(const ArmaGarch& model, const ArmaGarchSeries& series, const ArmaGarchOptions& options) {
  ArmaGarchRecursion recursion = checked_recursion(model, series, options.start);
  const VectorXd centred = centred_vector(model);
  VectorXd gradient;
  recursion.slope(centred, gradient);
  const VectorXd natural = natural_by_centred(recursion.layout(), centred).transpose().partialPivLu().solve(gradient);
  return options.constant ? natural : VectorXd(natural.tail(natural.size() - 1));
}

Eigen::MatrixXd arma_garch_scores(const ArmaGarch& model, const ArmaGarchSeries& series, const ArmaGarchOptions& options) {
  ArmaGarchRecursion recursion = checked_recursion(model, series, options.start);
  const VectorXd centred = centred_vector(model);
  const Eigen::MatrixXd J = natural_by_centred(recursion.layout(), centred);
  const Eigen::MatrixXd natural = recursion.scores(centred) * J.inverse();
  return options.constant ? natural : Eigen::MatrixXd(natural.rightCols(natural.cols() - 1));
}

}  // namespace coast::noise
