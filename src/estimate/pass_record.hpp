#pragma once
// A pass of the filter as a linear system, for the scores of its noise; private to the room.

#include <vector>

#include "coast/estimate/forward_filter.hpp"
#include "coast/estimate/knot.hpp"

namespace coast::estimate {

/// A knot with its interval.
struct RecordedKnot {
  Knot knot;                              ///< without data needed only for a continuation: covariance, remainder
  std::vector<Measurement> measurements;  ///< of its updates, in their order
  AxisNoise white;                        ///< of the interval
  Eigen::Matrix3Xd P_gnss;                ///< rows of P_post of the correlated GNSS error; empty if there is none
  Eigen::Matrix3d C_n_e;
};

/// Its memory is reused for the next pass.
class PassRecord {
 public:
  /// @param filter  must outlive the record's use; its gate must be open, so that every measurement becomes an update
  FilterResult run(const ForwardFilter& filter, const FilterState& start);
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] const RecordedKnot& operator[](std::size_t i) const { return knots_[i]; }

 private:
  void add(const Knot& knot, const AxisNoise& white, const std::optional<int>& gnss_error);

  std::vector<RecordedKnot> knots_;
  std::size_t size_ = 0;
  std::vector<Measurement> pending_;
};

}  // namespace coast::estimate
