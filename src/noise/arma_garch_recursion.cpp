#include "arma_garch_recursion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coast::noise {

using Eigen::Index;
using Eigen::VectorXd;

VectorXd centred_vector(const ArmaGarch& model) {
  VectorXd centred = arma_garch_vector(model, true);
  centred(0) = model.mean();
  return centred;
}

ArmaGarch model_of_centred(const ArmaGarchLayout& layout, const VectorXd& centred) {
  const auto part = [&](Index from, Index count) {
    return std::vector<double>(centred.data() + from, centred.data() + from + count);
  };
  ArmaGarch model{0.0,
                  part(layout.alpha(), layout.ar),
                  part(layout.beta(), layout.ma),
                  centred(layout.gamma0()),
                  part(layout.gamma(), layout.arch),
                  part(layout.delta(), layout.garch)};
  model.nu = centred(0) * (1.0 - centred.segment(layout.alpha(), layout.ar).sum());
  return model;
}

Eigen::MatrixXd natural_by_centred(const ArmaGarchLayout& layout, const VectorXd& centred) {
  Eigen::MatrixXd J = Eigen::MatrixXd::Identity(layout.size(), layout.size());
  J(0, 0) = 1.0 - centred.segment(layout.alpha(), layout.ar).sum();
  J.row(0).segment(layout.alpha(), layout.ar).setConstant(-centred(0));
  return J;
}

ArmaGarchRecursion::ArmaGarchRecursion(const ArmaGarchOrders& orders, const ArmaGarchSeries& series, ArmaGarchStart start)
    : layout_(orders),
      n_(std::ssize(series.y)),
      lags_(std::max({layout_.ar, layout_.ma, layout_.arch, layout_.garch})),
      held_residuals_(start == ArmaGarchStart::kFgarch ? std::max(layout_.ar, layout_.ma) : 0),
      held_variances_(start == ArmaGarchStart::kFgarch ? std::max(layout_.arch, layout_.garch) : 0),
      y_(Eigen::Map<const VectorXd>(series.y.data(), n_)),
      is_missing_(static_cast<std::size_t>(n_), 0),
      counted_(Eigen::ArrayXd::Ones(n_)) {
  std::ranges::copy(series.is_missing, is_missing_.begin());
  Index unsettled = 0;
  for (Index t = 0; t < n_; ++t) {
    unsettled = is_missing_[static_cast<std::size_t>(t)] != 0 ? kArmaGarchSettling + 1 : std::max<Index>(0, unsettled - 1);
    if (unsettled > 0) counted_(t) = 0.0;
  }
  observations_ = static_cast<std::size_t>(counted_.sum());
  const auto padded = static_cast<std::size_t>(n_ + lags_);
  for (auto* buffer : {&x_, &residual_, &square_, &variance_, &variance_bar_, &row_bar_, &residual_bar_})
    buffer->assign(padded, 0.0);
}

void ArmaGarchRecursion::run_mean(const VectorXd& centred) {
  const double* alpha = centred.data() + layout_.alpha();
  const double* beta = centred.data() + layout_.beta();
  double* x = x_.data() + lags_;
  double* e = residual_.data() + lags_;
  for (Index t = 0; t < n_; ++t) {
    double prediction = 0.0;
    for (Index i = 0; i < layout_.ar; ++i) prediction += alpha[i] * x[t - 1 - i];
    // The newest residual last: it is the only one the processor has to wait for.
    for (Index j = layout_.ma - 1; j >= 0; --j) prediction += beta[j] * e[t - 1 - j];
    const bool is_seen = is_missing_[static_cast<std::size_t>(t)] == 0;
    x[t] = is_seen ? y_(t) - centred(0) : prediction;
    e[t] = is_seen && t >= held_residuals_ ? x[t] - prediction : 0.0;
  }
  mean_square_ = (counted_ * Eigen::Map<const Eigen::ArrayXd>(e, n_).square()).sum() / static_cast<double>(observations_);
}

void ArmaGarchRecursion::run_variance(const VectorXd& centred) {
  const double* gamma = centred.data() + layout_.gamma();
  const double* delta = centred.data() + layout_.delta();
  const double gamma0 = centred(layout_.gamma0());
  const double* e = residual_.data() + lags_;
  double* s = square_.data() + lags_;
  double* h = variance_.data() + lags_;
  std::fill(square_.begin(), square_.begin() + lags_, mean_square_);
  std::fill(variance_.begin(), variance_.begin() + lags_, mean_square_);
  const double held = gamma0 + mean_square_ * centred.segment(layout_.gamma(), layout_.arch + layout_.garch).sum();
  for (Index t = 0; t < n_; ++t) {
    double sum = gamma0;
    for (Index i = 0; i < layout_.arch; ++i) sum += gamma[i] * s[t - 1 - i];
    for (Index j = layout_.garch - 1; j >= 0; --j) sum += delta[j] * h[t - 1 - j];
    h[t] = t < held_variances_ ? held : sum;
    s[t] = counted_(t) != 0.0 ? e[t] * e[t] : h[t];
  }
}

double ArmaGarchRecursion::value(const VectorXd& centred) {
  run_mean(centred);
  run_variance(centred);
  const Eigen::Map<const Eigen::ArrayXd> e(residual_.data() + lags_, n_);
  const Eigen::Map<const Eigen::ArrayXd> h(variance_.data() + lags_, n_);
  const double constant = static_cast<double>(observations_) * std::log(2.0 * std::numbers::pi);
  return -0.5 * (constant + (counted_ * (h.log() + e.square() / h)).sum());
}

/// @return the adjoint of the mean square before the first sample
double ArmaGarchRecursion::run_variance_back(const VectorXd& centred, VectorXd& gradient) {
  const double* gamma = centred.data() + layout_.gamma();
  const double* delta = centred.data() + layout_.delta();
  const double* e = residual_.data() + lags_;
  const double* h = variance_.data() + lags_;
  double* h_bar = variance_bar_.data();
  const double persistence = centred.segment(layout_.gamma(), layout_.arch + layout_.garch).sum();
  double by_mean_square = 0.0;
  for (Index t = n_ - 1; t >= 0; --t) {
    double square_bar = 0.0;
    double sum = 0.0;
    for (Index i = layout_.arch; i > 0; --i) square_bar += gamma[i - 1] * h_bar[t + i];
    for (Index j = layout_.garch; j > 0; --j) sum += delta[j - 1] * h_bar[t + j];
    const double weight = 1.0 / h[t];
    const bool counts = counted_(t) != 0.0;
    sum += counts ? -0.5 * weight * (1.0 - e[t] * e[t] * weight) : square_bar;
    residual_bar_[static_cast<std::size_t>(t)] = counts ? e[t] * (2.0 * square_bar - weight) : 0.0;
    h_bar[t] = sum;
    if (t >= held_variances_) continue;
    gradient(layout_.gamma0()) += sum;
    gradient.segment(layout_.gamma(), layout_.arch + layout_.garch).array() += sum * mean_square_;
    by_mean_square += sum * persistence;
    h_bar[t] = 0.0;
  }
  const Eigen::Map<const VectorXd> bar(h_bar, n_);
  gradient(layout_.gamma0()) += bar.sum();
  for (Index i = 0; i < layout_.arch; ++i)
    gradient(layout_.gamma() + i) += bar.dot(Eigen::Map<const VectorXd>(square_.data() + lags_ - 1 - i, n_));
  for (Index j = 0; j < layout_.garch; ++j)
    gradient(layout_.delta() + j) += bar.dot(Eigen::Map<const VectorXd>(variance_.data() + lags_ - 1 - j, n_));
  for (Index t = 0; t < std::min(lags_, n_); ++t) {
    for (Index i = t; i < layout_.arch; ++i) by_mean_square += gamma[i] * h_bar[t];
    for (Index j = t; j < layout_.garch; ++j) by_mean_square += delta[j] * h_bar[t];
  }
  return by_mean_square;
}

void ArmaGarchRecursion::run_mean_back(const VectorXd& centred, double by_mean_square, VectorXd& gradient) {
  const double* alpha = centred.data() + layout_.alpha();
  const double* beta = centred.data() + layout_.beta();
  const double* e = residual_.data() + lags_;
  double* row_bar = row_bar_.data();
  const double by_residual = 2.0 * by_mean_square / static_cast<double>(observations_);
  double by_mu = 0.0;
  for (Index t = n_ - 1; t >= 0; --t) {
    double by_lags = 0.0;
    for (Index i = layout_.ar; i > 0; --i) by_lags += alpha[i - 1] * row_bar[t + i];
    if (is_missing_[static_cast<std::size_t>(t)] != 0) {  // its equation gives x, not e
      row_bar[t] = by_lags;
      continue;
    }
    double bar = residual_bar_[static_cast<std::size_t>(t)] + by_residual * counted_(t) * e[t];
    for (Index j = layout_.ma; j > 0; --j) bar -= beta[j - 1] * row_bar[t + j];
    row_bar[t] = t < held_residuals_ ? 0.0 : bar;
    by_mu -= row_bar[t] - by_lags;
  }
  const Eigen::Map<const VectorXd> bar(row_bar, n_);
  gradient(0) += by_mu;
  for (Index i = 0; i < layout_.ar; ++i)
    gradient(layout_.alpha() + i) -= bar.dot(Eigen::Map<const VectorXd>(x_.data() + lags_ - 1 - i, n_));
  for (Index j = 0; j < layout_.ma; ++j)
    gradient(layout_.beta() + j) -= bar.dot(Eigen::Map<const VectorXd>(residual_.data() + lags_ - 1 - j, n_));
}

double ArmaGarchRecursion::slope(const VectorXd& centred, VectorXd& gradient) {
  const double at = value(centred);
  gradient = VectorXd::Zero(layout_.size());
  const double by_mean_square = run_variance_back(centred, gradient);
  run_mean_back(centred, by_mean_square, gradient);
  return at;
}

}  // namespace coast::noise
