#include "coast/noise/arma_garch_filter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "arma_garch_checks.hpp"

namespace coast::noise {

namespace {

/// The newest first, the oldest last.
void push_newest(std::vector<double>& lags, double value) {
  if (lags.empty()) return;
  std::copy_backward(lags.begin(), lags.end() - 1, lags.end());
  lags.front() = value;
}

double sum_of_products(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace

ArmaGarchFilter::ArmaGarchFilter(const ArmaGarch& model, std::optional<double> start_variance)
    : model_(model),
      mean_(model.mean()),
      start_variance_(start_variance.value_or(model.innovation_variance())),
      x_(model.alpha.size()),
      residual_(model.beta.size()),
      square_(model.gamma.size()),
      variance_(model.delta.size()) {
  check_arma_garch(model);
  if (!(start_variance_ > 0.0))
    throw std::invalid_argument(fmt::format("ArmaGarchFilter: a start variance of {}, above 0 expected", start_variance_));
  reset();
}

void ArmaGarchFilter::reset() {
  unsettled_ = 0;
  std::ranges::fill(x_, 0.0);
  std::ranges::fill(residual_, 0.0);
  std::ranges::fill(square_, start_variance_);
  std::ranges::fill(variance_, start_variance_);
  predict();
}

void ArmaGarchFilter::predict() {
  next_.mean = mean_ + sum_of_products(model_.alpha, x_) + sum_of_products(model_.beta, residual_);
  next_.variance = model_.gamma0 + sum_of_products(model_.gamma, square_) + sum_of_products(model_.delta, variance_);
}

void ArmaGarchFilter::advance(double x, double residual, double square) {
  push_newest(x_, x);
  push_newest(residual_, residual);
  push_newest(square_, square);
  push_newest(variance_, next_.variance);
  predict();
}

void ArmaGarchFilter::observe(double y) {
  const double residual = y - next_.mean;
  const bool is_settled = unsettled_ == 0;
  if (!is_settled) --unsettled_;
  advance(y - mean_, residual, is_settled ? residual * residual : next_.variance);
}

void ArmaGarchFilter::miss() {
  unsettled_ = kArmaGarchSettling;
  advance(next_.mean - mean_, 0.0, next_.variance);
}

}  // namespace coast::noise
