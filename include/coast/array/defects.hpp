#pragma once
// Sensors of an array that fail and recover, found where the array contradicts itself (Stebler et al. 2011, section III:
// defective sensors are detected before strapdown).

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "coast/array/signals.hpp"

namespace coast::array {

struct DefectOptions {
  /// Of the whole array. Each of six channels and K sensors has eight tests (level over three windows, noise over two, response
  /// to motion over two, repeated values), and each of these 48 K tests an equal share. All but the last watch the sensor's
  /// residual against the others; with thresholds for an independent share each, dependence can only lower the sum.
  double false_alarms_per_hour = 0.1;
  double recovery_s = 5.0;       ///< in order for so long: taken back
  double noise_memory_s = 60.0;  ///< noise densities may change over this time to either side
};

enum class DefectKind : std::uint8_t {
  kBiasJump,     ///< a constant more
  kScaleChange,  ///< a factor on the channel
  kStuck,        ///< one value repeated
  kNoiseBurst,   ///< more noise, nothing else
  kDropout,      ///< no values: not usable, not finite, or exactly zero again and again
  kSwappedAxis,  ///< follows another axis
  kUnknown,      ///< found wrong, in none of these ways
};
inline constexpr int kDefectKinds = 7;
[[nodiscard]] std::string_view name_of(DefectKind kind);

struct Defect {
  std::size_t sensor = 0;
  std::uint8_t channels = 0;  ///< bit c: row c
  DefectKind kind = DefectKind::kUnknown;
  std::size_t from = 0, to = 0;  ///< columns [from, to): from the estimated onset to where it is in order again
  std::size_t found = 0;         ///< the column at which a test that knows no later sample exceeds its threshold
  double statistic = 0.0;  ///< of the first test beyond it, in standard deviations of a normal; of kStuck, kDropout: samples
  /// kBiasJump: how much, in the channel's unit (of the channel where it is surest). kScaleChange: factor, 1 is in order.
  /// kNoiseBurst: standard deviation over the usual one. Otherwise absent.
  std::optional<double> size;
};

/// Two sensors contradict each other and no third one says which is wrong; nobody is excluded.
struct Disagreement {
  int channel = 0;
  std::size_t a = 0, b = 0;  ///< sensors
  std::size_t found = 0;     ///< column
  double statistic = 0.0;
};

/// Biases of a sensor relative to the array's median, constant over the columns [from, to) in which it is in order.
struct BiasRun {
  std::size_t sensor = 0;
  std::size_t from = 0, to = 0;
  Channels bias = Channels::Zero();  ///< rad/s, m/s^2; 0 in a channel that is never in order in the run
};

/// What was taken for a sensor's own noise: the median over the record.
struct NoiseLevel {
  Channels sample_sd = Channels::Zero();  ///< of a sample about its block's mean: rad/s, m/s^2
  Channels block_sd = Channels::Zero();   ///< of a mean over a block, correlation between samples counted
};

struct DefectThresholds {
  double per_test_per_hour = 0.0;  ///< false alarms, each test of each channel and sensor
  /// Windows in s and thresholds in standard deviations, before what uncertain noise levels add.
  std::vector<std::pair<double, double>> level, noise, motion;
};

struct DefectReport {
  std::vector<Defect> defects;  ///< by `from`
  std::vector<Disagreement> disagreements;
  std::vector<BiasRun> biases;  ///< by sensor, then `from`
  std::vector<NoiseLevel> noise;
  DefectThresholds thresholds;
  double block_s = 0.0;  ///< onsets and ends are dated to one block
};

/// Parity-space tests of K sensors that measure the same six channels.
///
/// A sensor's residual is its signal against the weighted mean of the others that are in order; the common motion drops out.
/// Over blocks of 0.1 s (at least four samples) and windows of them:
///
///     level   mean of the residual against its own past, the past a local-level (Kalman) filter frozen before the window;
///             0.1, 1, 10 s                                                       (Willsky & Jones 1976, for a jump)
///     noise   mean square about the block's own mean; 0.1, 1 s                  (chi-square, correlation counted)
///     motion  regression of the residual on the motion along three axes; 1, 10 s (chi-square of 3 degrees)
///     repeats runs of one value against the geometric law of the channel's own quantisation
///
/// The largest standardised leave-one-out residual names the sensor (Baarda 1968); it leaves the set and the rest is tested
/// again while three are left. Noise per sensor and channel follows from the K residuals about the plain mean, var =
/// sigma_k^2 (1 - 2/K) + sum_j sigma_j^2/K^2, by running medians; longer windows from the residuals' Allan variances. Constant
/// small differences of mounting, scale and lag are regressed out of each sensor over the whole record; what dynamics leave
/// beyond that widens the thresholds by a fitted line in the motion's power.
///
/// Thresholds are of Gaussian maxima over windows that overlap, u with (rate of evaluations) min(1, u^2/W) P(|x| > u) = the
/// test's share. O(K samples).
///
/// @param signals  K >= 2 sensors on one grid in body axes; at least 20 s
/// @throws std::invalid_argument  fewer than two sensors, too short, dt or an option out of range
/// @note  A bias that is wrong from the first sample on is a bias; steps within the first 5 s cannot be told from one. With two
///        sensors in order a contradiction is a Disagreement.
[[nodiscard]] DefectReport find_defects(const Signals& signals, const DefectOptions& options = {});

/// Clears the usable bits of every defect from its onset to its end.
/// @throws std::invalid_argument  the report is of other signals: a sensor or a column does not exist
void exclude(Signals& signals, const DefectReport& report);

}  // namespace coast::array
