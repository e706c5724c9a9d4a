#pragma once
// Thresholds of the tests, and their increase where all sensors lie apart. Private to the room.

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

/// Factor by which squares exceed those by noise alone where the sensors lie apart by a spread x: max(1, constant + slope x).
struct Inflation {
  double constant = 1.0;
  double slope = 0.0;

  [[nodiscard]] double at(double spread) const;
};

/// The sensors' spread in a window, and in a second about each of its blocks.
struct SpreadOfWindow {
  double now;
  double about;

  [[nodiscard]] bool apart() const { return about > 2.0; }  ///< not as usual
};
/// One statistic of a window in order: its ratio to its median by noise alone.
struct RatioAtSpread {
  SpreadOfWindow spread;
  double ratio;
};
/// Line through the medians of groups by spread, by relative errors; both coefficients at least zero. Each group has half of
/// what is above the one before: what is rare and wide counts as much as what is usual.
[[nodiscard]] Inflation fit_inflation(std::vector<RatioAtSpread> ratios);

/// Factor on a squared threshold for a statistic that grows with the sensors' spread, and whose tail in this record is longer
/// than that of normal noise: impacts and vibration that each sensor takes in its own way. The tail's factors are at least 1;
/// one is for windows in which the sensors lie together as usual, one for those in which they lie apart, which may be few.
struct Growth {
  Inflation inflation;
  double together = 1.0;
  double apart = 1.0;

  [[nodiscard]] double tail(const SpreadOfWindow& spread) const { return spread.apart() ? apart : together; }
};

struct TailFit {
  std::size_t piece = 1;   ///< windows in a piece
  double chance = 0.0;     ///< false alarms accepted in a piece
  double threshold = 1.0;  ///< of the ratio, for normal noise
};
/// Largest ratios, over the inflation, of pieces of the record; for `fit_tails` those of squared normals.
struct LargestRatios {
  std::vector<double> together, apart;
};
/// @param ratios  in order of time
[[nodiscard]] LargestRatios largest_ratios(const std::vector<RatioAtSpread>& ratios, const Inflation& inflation,
                                           std::size_t piece);
/// Extreme values (Gumbel 1958): largest ratios have a double exponential distribution, whose place and width follow from the
/// values that 30 and 60 % of them do not exceed (a defect that lasts less than a third of the record does not count), and
/// whose quantile at `chance` is the threshold that the record itself asks for. With fewer than 12 pieces of a sensor those of
/// all are taken together; with fewer than 12 in all the factor is 1.
/// @param growth  [sensor] inflations; their tails are set
void fit_tails(const std::vector<LargestRatios>& sensors, const std::vector<TailFit>& fits, std::vector<Growth>& growth);
/// Median over the sensors of each coefficient.
[[nodiscard]] Growth usual_growth(const std::vector<Growth>& sensors);

}  // namespace coast::array
