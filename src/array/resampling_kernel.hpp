#pragma once
// Weights that make means over one interval of means over another. Private to the room.

#include <vector>

namespace coast::array {

/// Symmetric, of finite reach, read from a table.
class ResamplingKernel {
 public:
  /// @param width  of the means to be made, in intervals of those given
  explicit ResamplingKernel(double width);

  /// In intervals of the input, from the centre to both sides.
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
