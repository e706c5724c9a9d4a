#pragma once
// Delay and probability of defect detection: defects injected into simulated arrays, and false alarms in clean hours.

#include <functional>

#include "coast/array/defects.hpp"

namespace coast::array {

/// Four (or more) MEMS IMUs on one rigid body that turns and shakes: intermittent common motion of three sines per channel
/// (rates to 1 rad/s, forces to 3 m/s^2 about gravity, 0.05 to 1.5 Hz); first-order autoregressive noise, with a level that
/// differs between sensors (a factor of 2.7) and varies slowly by a third; random-walk biases; constant alignment and scale
/// errors of 0.002.
struct ArraySimulation {
  std::size_t sensors = 4;
  double dt = 0.01;  ///< s
  double duration_s = 90.0;
  double gyro_sd = 0.005;            ///< rad/s, per sample, of the median sensor
  double accelerometer_sd = 0.05;    ///< m/s^2
  double autocorrelation = 0.3;      ///< of neighbouring samples
  double gyro_walk = 2e-5;           ///< rad/s/sqrt(s)
  double accelerometer_walk = 2e-4;  ///< m/s^2/sqrt(s)
};
/// @throws std::invalid_argument  fewer than one sensor, dt or duration not above zero
[[nodiscard]] Signals simulate_array(const ArraySimulation& simulation, std::uint64_t seed);

/// Defect injected into one sensor over columns [from, to).
struct Injection {
  DefectKind kind = DefectKind::kBiasJump;
  std::size_t sensor = 0;
  int channel = 0;
  std::size_t from = 0, to = 0;
  /// kBiasJump: added value, channel's unit. kScaleChange: factor. kNoiseBurst: standard deviation of the added noise.
  /// kDropout: 0 clears the usable bits of all channels, else their values are set to zero. Otherwise unused; kSwappedAxis
  /// swaps with the next axis.
  double size = 0.0;
};
/// @throws std::invalid_argument  kUnknown, or a sensor, channel or column that does not exist
void inject(Signals& signals, const Injection& injection, std::uint64_t seed);

struct DefectStudyOptions {
  DefectOptions detection;
  ArraySimulation simulation;
  double defect_s = 20.0;  ///< duration of a defect; it begins between 30 % and 60 % of the record
  double clean_hours = 20.0;
  double clean_piece_s = 600.0;
};

/// All injections of one kind and strength.
struct DefectStudyRow {
  DefectKind kind = DefectKind::kBiasJump;
  double strength =
      0.0;  ///< jump over the sensor's sd of a sample; relative change of scale; sd of a burst over the normal one
  std::size_t injections = 0;
  std::size_t detected = 0;                       ///< right sensor and channel, found during the defect
  std::size_t wrong_sensor = 0;                   ///< runs in which another sensor was reported defective
  std::size_t right_kind = 0;                     ///< of the detected
  double median_delay_s = 0.0, delay_95_s = 0.0;  ///< from onset to detection; of the detected defects
  double median_onset_error_s = 0.0;              ///< absolute, of `from`
};

struct DefectStudyResult {
  std::vector<DefectStudyRow> rows;  ///< by kind, then strength
  double clean_hours = 0.0;
  std::size_t false_alarms = 0;  ///< defects reported in the clean hours
  double stated_false_alarms = 0.0;
};

/// Injection i of a kind has strength number i modulo the number of strengths, its own sensor, channel and time, and a record
/// with the seed first_seed + i. Runs on all threads; the result is the same for any number of them.
/// @param progress  fraction; called from any thread
[[nodiscard]] DefectStudyResult run_defect_study(const DefectStudyOptions& options, std::size_t injections_per_kind,
                                                 std::uint64_t first_seed, const std::function<void(double)>& progress = {});

}  // namespace coast::array
