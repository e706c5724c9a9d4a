#pragma once
// Shorter stand-ins of long records. Private to the room.

#include <optional>

#include "coast/noise/likelihood.hpp"

namespace coast::noise {

/// Means of blocks, enough of them to hold what slow processes tell; nothing where the record is short already or the sum has
/// no averages.
[[nodiscard]] std::optional<Likelihood> on_block_means(const Likelihood& likelihood, double most_values);

/// Likelihood of a long record from two short ones: block means for slow processes, the record's beginning for fast ones. It
/// is for searching only: both know a little of the same.
class ShortLikelihood {
 public:
  /// Of a short record it is the likelihood itself.
  explicit ShortLikelihood(const Likelihood& likelihood);
  [[nodiscard]] bool is_whole() const { return whole_; }
  [[nodiscard]] double value(const std::vector<double>& u) const;
  /// Maximised over level and drift, not restricted.
  [[nodiscard]] double at_mean(const std::vector<double>& u) const;
  [[nodiscard]] LikelihoodSlope slope(const std::vector<double>& u) const;

 private:
  bool whole_ = true;
  std::vector<Likelihood> parts_;
};

}  // namespace coast::noise
