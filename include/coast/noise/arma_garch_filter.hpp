#pragma once

#include <optional>
#include <vector>

#include "coast/noise/arma_garch.hpp"

namespace coast::noise {

/// One-step prediction of an ARMA-GARCH series, sample by sample. Nothing is allocated after construction.
///
/// Before the first sample y is its mean, e is 0, e^2 and s2 are the start variance: if that is the mean square of the
/// residuals, this is ArmaGarchStart::kConditional.
class ArmaGarchFilter {
 public:
  /// Prediction of the next sample, given all before it.
  struct Prediction {
    double mean = 0.0;      ///< E[y[t] | past] [signal]: Stebler et al. (2011), eq. (14)
    double variance = 0.0;  ///< s2[t] [signal^2], known before y[t]: eqs. (9) and (13)
  };

  /// @param start_variance  [signal^2], > 0; if absent, the unconditional variance of e
  /// @throws std::invalid_argument  the model has a defect, or the start variance is zero or less
  explicit ArmaGarchFilter(const ArmaGarch& model, std::optional<double> start_variance = {});

  [[nodiscard]] const Prediction& prediction() const { return next_; }
  void observe(double y);  ///< adds the sample that was predicted
  void miss();   ///< sample missing: y is its prediction, e is 0, e^2 its expectation, e^2 also for the next kArmaGarchSettling
  void reset();  ///< to the state before the first sample

 private:
  void advance(double x, double residual, double square);
  void predict();

  ArmaGarch model_;
  double mean_;
  double start_variance_;
  std::vector<double> x_;         ///< y - mean, newest first
  std::vector<double> residual_;  ///< newest first
  std::vector<double> square_;
  std::vector<double> variance_;
  int unsettled_ = 0;  ///< number of following samples whose squares are not used in the variance
  Prediction next_;
};

}  // namespace coast::noise
