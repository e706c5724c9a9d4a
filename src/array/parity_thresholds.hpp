#pragma once
// Thresholds of the tests, and their increase with motion. Private to the room.

#include <array>
#include <vector>

namespace coast::array {

inline constexpr std::array<std::size_t, 3> kLevelWindows{1, 10, 100};  // blocks
inline constexpr std::array<std::size_t, 2> kNoiseWindows{1, 10};
inline constexpr std::array<std::size_t, 2> kMotionWindows{10, 100};
inline constexpr int kTestsPerChannel = 8;  ///< these and repeated values

/// u with (evaluations per hour) min(1, u^2/W) P = share, P = P(|x| > u) (two-sided) or P(x > u): maxima of a normal averaged
/// over windows of W one evaluation apart occur in clumps of W/u^2 (Aldous 1989, for a triangular correlation).
/// @param per_hour  false alarms  @param step_s  from evaluation to evaluation
[[nodiscard]] double normal_threshold(double per_hour, double step_s, std::size_t window, bool two_sided);
/// x likewise for a chi-square of nu degrees of freedom, whose tail is treated as the normal's of equal probability.
[[nodiscard]] double chi2_threshold(double nu, double per_hour, double step_s, std::size_t window);
/// A squared threshold q for a statistic whose scale has the relative standard deviation epsilon: the probability averaged
/// over a normal error of the scale, exp(-q/2 + (q epsilon)^2/2), is kept by q (1 + q epsilon^2).
[[nodiscard]] double for_uncertain_scale(double q, double epsilon);

/// Factor by which squares exceed those by noise alone at motion of power x: max(1, constant + slope x).
struct MotionInflation {
  double constant = 1.0;
  double slope = 0.0;

  [[nodiscard]] double at(double power) const;
};

/// One statistic of a window in order: its ratio to its median by noise alone, and the power of the motion.
struct RatioAtPower {
  double power;
  double ratio;
};
/// Line through the medians of up to six groups of equal size by power; both coefficients at least zero.
[[nodiscard]] MotionInflation fit_inflation(std::vector<RatioAtPower> ratios);

}  // namespace coast::array
