#pragma once
// Detection of sensors of an array that fail and recover, from contradictions within the array (Stebler et al. 2011, section
// III: defective sensors are detected before strapdown).

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "coast/array/signals.hpp"

namespace coast::array {

struct DefectOptions {
  /// For the whole array. Each of six channels and K sensors has eight tests (level over three windows, noise over two,
  /// response to motion over two, repeated values), and each of these 48 K tests has an equal share. All but the last test the
  /// sensor's residual relative to the others; thresholds assume independent tests, and dependence can only lower the total
  /// rate.
  double false_alarms_per_hour = 0.1;
  double recovery_s = 5.0;       ///< a sensor without defect for this long is used again
  double noise_memory_s = 60.0;  ///< time scale, to either side, over which noise densities may change
};

enum class DefectKind : std::uint8_t {
  kBiasJump,     ///< a constant added
  kScaleChange,  ///< a factor on the channel
  kStuck,        ///< one value repeated
  kNoiseBurst,   ///< only the noise is larger
  kDropout,      ///< no values: not usable, not finite, or repeatedly exactly zero
  kSwappedAxis,  ///< follows another axis
  kUnknown,      ///< defective, but none of these kinds
};
inline constexpr int kDefectKinds = 7;
[[nodiscard]] std::string_view name_of(DefectKind kind);

struct Defect {
  std::size_t sensor = 0;
  std::uint8_t channels = 0;  ///< bit c: channel c (row c)
  DefectKind kind = DefectKind::kUnknown;
  std::size_t from = 0, to = 0;  ///< columns [from, to): from the estimated onset to the recovery
  std::size_t found = 0;         ///< the column at which a causal test exceeds its threshold
  double statistic = 0.0;        ///< of the first test above it, in standard deviations of a normal; kStuck, kDropout: samples
  /// kBiasJump: its size, in the channel's unit (of the most significant channel). kScaleChange: factor, 1 is correct.
  /// kNoiseBurst: standard deviation over the normal one. Otherwise absent.
  std::optional<double> size;
};

/// Two sensors contradict each other and no third sensor shows which is wrong; neither is excluded.
struct Disagreement {
  int channel = 0;
  std::size_t a = 0, b = 0;  ///< sensors
  std::size_t found = 0;     ///< column
  double statistic = 0.0;
};

/// Biases of a sensor relative to the array's median, constant over the columns [from, to) in which it has no defect.
struct BiasRun {
  std::size_t sensor = 0;
  std::size_t from = 0, to = 0;
  Channels bias = Channels::Zero();  ///< rad/s, m/s^2; 0 in a channel that is defective throughout the run
};

/// A sensor's own noise as used by the tests: the median over the record.
struct NoiseLevel {
  Channels sample_sd = Channels::Zero();  ///< of a sample about its block's mean: rad/s, m/s^2
  Channels block_sd = Channels::Zero();   ///< of a mean over a block, including correlation between samples
};

struct DefectThresholds {
  double per_test_per_hour = 0.0;  ///< false alarms, each test of each channel and sensor
  /// Windows in s and thresholds in standard deviations, before the increase for uncertain noise levels.
  std::vector<std::pair<double, double>> level, noise, motion;
};

struct DefectReport {
  std::vector<Defect> defects;  ///< by `from`
  std::vector<Disagreement> disagreements;
  std::vector<BiasRun> biases;  ///< by sensor, then `from`
  std::vector<NoiseLevel> noise;
  DefectThresholds thresholds;
  double block_s = 0.0;  ///< onsets and ends are resolved to one block
};

/// Parity-space tests of K sensors that measure the same six channels.
///
/// A sensor's residual is its signal minus the weighted mean of the others without defect; the common motion cancels. Over
/// blocks of 0.1 s (at least four samples) and windows of them:
///
///     level   mean of the residual minus its past level, from a local-level (Kalman) filter frozen before the window;
///             0.1, 1, 10 s                                                       (Willsky & Jones 1976, for a jump)
///     noise   mean square about the block's own mean; 0.1, 1 s                  (chi-square, correlation counted)
///     motion  regression of the residual on the motion along three axes; 1, 10 s (chi-square of 3 degrees)
///     repeats runs of one value, tested with the geometric distribution for the channel's own quantisation
///
/// The largest standardised leave-one-out residual identifies the sensor (Baarda 1968); it is removed and the rest is tested
/// again while three are left. Noise per sensor and channel follows from the K residuals about the plain mean, var = sigma_k^2
/// (1 - 2/K) + sum_j sigma_j^2/K^2, by running medians; longer windows from the residuals' Allan variances. Constant small
/// differences of mounting, scale and lag are removed from each sensor by regression over the whole record. Values at the end
/// of a sensor's range (`SensorSignals::limited`) are not tested.
///
/// What all sensors show at once (impacts and vibration that each takes in its own way) is no defect of one. Squares are
/// divided by a fitted linear function of how far the sensors lie apart at that time (the median over the sensors: one that is
/// defective does not count), of the motion's power for the response to motion; the record's own maxima say how long the tails
/// are (Gumbel 1958); and a sensor is excluded only if the others are in order without it, or without it and one more.
///
/// Thresholds follow from Gaussian maxima over overlapping windows: u with (rate of evaluations) min(1, u^2/W) P(|x| > u) = the
/// test's share. O(K samples).
///
/// @param signals  K >= 2 sensors on one grid in body axes; at least 20 s
/// @throws std::invalid_argument  fewer than two sensors, too short, dt or an option out of range
/// @note  A bias error from the first sample on is not a defect; steps within the first 5 s cannot be distinguished from it.
///        With two sensors without defect a contradiction is a Disagreement.
[[nodiscard]] DefectReport find_defects(const Signals& signals, const DefectOptions& options = {});

/// Clears the usable bits of every defect from its onset to its end.
/// @throws std::invalid_argument  the report belongs to other signals: a sensor or a column does not exist
void exclude(Signals& signals, const DefectReport& report);

}  // namespace coast::array
