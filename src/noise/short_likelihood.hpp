#pragma once
// Shorter approximations of long records. Private to the room.

#include <optional>

#include "coast/noise/likelihood.hpp"

namespace coast::noise {

/// Means of blocks, enough of them to keep the information on slow processes; none if the record is short already or the sum
/// cannot be averaged.
[[nodiscard]] std::optional<Likelihood> on_block_means(const Likelihood& likelihood, double most_values);

/// Likelihood of a long record from two short ones: block means for slow processes, the first samples for fast ones. It
/// is for searching only: some information is in both.
class ShortLikelihood {
 public:
  /// For a short record it is the likelihood itself.
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
