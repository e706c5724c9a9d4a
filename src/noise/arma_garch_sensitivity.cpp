// Forward sensitivities of the recursions: scores of the samples and Fisher's information.

#include <algorithm>
#include <cmath>

#include "arma_garch_recursion.hpp"

namespace coast::noise {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// to += factor * from, of a few numbers: Eigen's dynamic columns cost more than the operation itself.
inline void add_column(double* to, double factor, const double* from, Index count) {
  for (Index k = 0; k < count; ++k) to[k] += factor * from[k];
}

}  // namespace

void ArmaGarchRecursion::run_mean_sensitivity(const VectorXd& centred) {
  const Index k = layout_.gamma0();
  const bool has_gaps = observations_ < static_cast<std::size_t>(n_);
  x_by_.setZero(k, n_ + lags_);
  residual_by_.setZero(k, n_ + lags_);
  std::vector<double> row(static_cast<std::size_t>(k));
  const double* x = x_.data() + lags_;
  const double* e = residual_.data() + lags_;
  const auto x_by = [&](Index t) { return x_by_.data() + (t + lags_) * k; };
  const auto e_by = [&](Index t) { return residual_by_.data() + (t + lags_) * k; };
  for (Index t = 0; t < n_; ++t) {  // row: of the prediction
    std::fill(row.begin(), row.end(), 0.0);
    for (Index i = 0; i < layout_.ar; ++i) {
      // Without gaps x depends only on mu.
      add_column(row.data(), centred(layout_.alpha() + i), x_by(t - 1 - i), has_gaps ? k : 1);
      row[static_cast<std::size_t>(layout_.alpha() + i)] += x[t - 1 - i];
    }
    for (Index j = layout_.ma - 1; j >= 0; --j) {
      add_column(row.data(), centred(layout_.beta() + j), e_by(t - 1 - j), k);
      row[static_cast<std::size_t>(layout_.beta() + j)] += e[t - 1 - j];
    }
    if (is_missing_[static_cast<std::size_t>(t)] != 0) {
      std::copy(row.begin(), row.end(), x_by(t));
      continue;
    }
    x_by(t)[0] = -1.0;
    if (t < held_residuals_) continue;
    std::transform(row.begin(), row.end(), e_by(t), [](double value) { return -value; });
    e_by(t)[0] -= 1.0;
  }
}

void ArmaGarchRecursion::run_variance_sensitivity(const VectorXd& centred) {
  const Index k = layout_.size();
  const Index of_mean = layout_.gamma0();
  const Index moving = layout_.arch + layout_.garch;
  const Eigen::Map<const VectorXd> residuals(residual_.data() + lags_, n_);
  const VectorXd counted = (counted_ * residuals.array()).matrix();
  VectorXd mean_square_by = VectorXd::Zero(k);
  mean_square_by.head(of_mean) = 2.0 / static_cast<double>(observations_) * (residual_by_.rightCols(n_) * counted);
  square_by_.setZero(k, n_ + lags_);
  variance_by_.setZero(k, n_ + lags_);
  square_by_.leftCols(lags_).colwise() = mean_square_by;
  variance_by_.leftCols(lags_).colwise() = mean_square_by;
  const double* s = square_.data() + lags_;
  const double* h = variance_.data() + lags_;
  const auto s_by = [&](Index t) { return square_by_.data() + (t + lags_) * k; };
  const auto h_by = [&](Index t) { return variance_by_.data() + (t + lags_) * k; };
  for (Index t = 0; t < n_; ++t) {
    double* now = h_by(t);
    now[layout_.gamma0()] = 1.0;
    if (t < held_variances_) {
      variance_by_.col(t + lags_) += centred.segment(layout_.gamma(), moving).sum() * mean_square_by;
      variance_by_.col(t + lags_).segment(layout_.gamma(), moving).array() += mean_square_;
    } else {
      for (Index i = 0; i < layout_.arch; ++i) {
        add_column(now, centred(layout_.gamma() + i), s_by(t - 1 - i), k);
        now[layout_.gamma() + i] += s[t - 1 - i];
      }
      for (Index j = 0; j < layout_.garch; ++j) {
        add_column(now, centred(layout_.delta() + j), h_by(t - 1 - j), k);
        now[layout_.delta() + j] += h[t - 1 - j];
      }
    }
    if (counted_(t) != 0.0)
      add_column(s_by(t), 2.0 * residuals(t), residual_by_.data() + (t + lags_) * of_mean, of_mean);
    else
      std::copy(now, now + k, s_by(t));
  }
}

ArmaGarchRecursion::Information ArmaGarchRecursion::information(const VectorXd& centred) {
  Information at;
  at.value = slope(centred, at.gradient);
  run_mean_sensitivity(centred);
  run_variance_sensitivity(centred);
  const Index k = layout_.size();
  const Index of_mean = layout_.gamma0();
  const Eigen::Map<const Eigen::ArrayXd> h(variance_.data() + lags_, n_);
  const Eigen::ArrayXd weight = counted_ / h;
  const Eigen::ArrayXd root = weight.sqrt();
  at.expected = Eigen::MatrixXd::Zero(k, k);
  const Eigen::MatrixXd by_variance =
      (variance_by_.rightCols(n_).array().rowwise() * (std::sqrt(0.5) * weight).transpose()).matrix();
  const Eigen::MatrixXd by_residual = (residual_by_.rightCols(n_).array().rowwise() * root.transpose()).matrix();
  at.expected.noalias() += by_variance * by_variance.transpose();
  at.expected.topLeftCorner(of_mean, of_mean).noalias() += by_residual * by_residual.transpose();
  return at;
}

Eigen::MatrixXd ArmaGarchRecursion::scores(const VectorXd& centred) {
  run_mean(centred);
  run_variance(centred);
  run_mean_sensitivity(centred);
  run_variance_sensitivity(centred);
  const Eigen::Map<const Eigen::ArrayXd> e(residual_.data() + lags_, n_);
  const Eigen::Map<const Eigen::ArrayXd> h(variance_.data() + lags_, n_);
  const Eigen::ArrayXd by_variance = -0.5 * counted_ / h * (1.0 - e.square() / h);
  const Eigen::ArrayXd by_residual = -counted_ * e / h;
  Eigen::MatrixXd scores = (variance_by_.rightCols(n_).array().rowwise() * by_variance.transpose()).matrix();
  scores.topRows(layout_.gamma0()) += (residual_by_.rightCols(n_).array().rowwise() * by_residual.transpose()).matrix();
  return scores.transpose();
}

}  // namespace coast::noise
