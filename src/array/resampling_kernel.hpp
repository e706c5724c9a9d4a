#pragma once
// Weights for means over one interval from means over another. Private to the room.

#include <vector>

namespace coast::array {

/// Symmetric, of finite length, interpolated from a table.
class ResamplingKernel {
 public:
  /// @param width  of the output means, in intervals of the input
  explicit ResamplingKernel(double width);

  /// Half length, in intervals of the input.
  [[nodiscard]] double reach() const { return reach_; }
  /// Not normalised. @param u  distance of the centres in intervals of the input, |u| <= reach
  [[nodiscard]] double operator()(double u) const {
    const double at = (u < 0.0 ? -u : u) * per_interval_;
    const auto i = static_cast<std::size_t>(at);
    const double fraction = at - static_cast<double>(i);
    return table_[i] + fraction * (table_[i + 1] - table_[i]);
  }

 private:
  double reach_ = 0.0;
  double per_interval_ = 0.0;
  std::vector<double> table_;
};

}  // namespace coast::array
