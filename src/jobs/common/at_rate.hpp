#pragma once

#include <optional>

#include "coast/geo/time.hpp"

namespace coast::jobs {

/// Picks epochs of a trajectory for a lower rate: the first, and each that follows the last picked one by an interval or more.
class AtRate {
 public:
  /// @param rate_hz  absent: every epoch
  explicit AtRate(std::optional<double> rate_hz) : rate_hz_(rate_hz) {}
  [[nodiscard]] bool due(geo::GpsTime t) {
    constexpr double kRounding = 1e-6;  // s
    if (rate_hz_ && started_ && t - last_ < 1.0 / *rate_hz_ - kRounding) return false;
    started_ = true;
    last_ = t;
    return true;
  }

 private:
  std::optional<double> rate_hz_;
  bool started_ = false;
  geo::GpsTime last_;
};

}  // namespace coast::jobs
