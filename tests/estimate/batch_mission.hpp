#pragma once
// Missions filtered forward, with everything that both smoothers take.

#include <fmt/format.h>

#include "coast/estimate/batch_smoother.hpp"
#include "estimate/mission.hpp"

namespace coast::test {

/// So quiet that every linearisation is the same to 1e-7: attitudes to microradians. One process of each kind of unknown:
/// driven, constant, known at the start, and one that moves by itself.
/// @param ug  white noise of the accelerometers, ug/sqrt(Hz)
[[nodiscard]] inline std::string still_model(double ug) {
  return fmt::format(R"(schema: coast.imu_error_model/1
gyro:
  all: [{{process: white_noise, density: 2e-5, unit: deg/sqrt(h)}}, {{process: random_constant, sigma: 1e-3, unit: deg/h}},
        {{process: gauss_markov, sigma: 1e-3, unit: deg/h, correlation_time_s: 30}},
        {{process: random_walk, density: 1e-3, unit: deg/h/sqrt(h)}}, {{process: scale_factor, sigma: 0.05, unit: ppm}},
        {{process: rate_ramp, coefficient: 1e-3, unit: deg/h/h}}]
accel:
  all: [{{process: white_noise, density: {}, unit: ug/sqrt(Hz)}}, {{process: random_constant, sigma: 50, unit: ug}},
        {{process: gauss_markov, sigma: 20, unit: ug, correlation_time_s: 20}}]
)",
                     ug);
}
inline constexpr StartSd kStillStart{.position = 0.05, .velocity = 2e-3, .tilt = 1e-6, .heading = 1e-6};

[[nodiscard]] inline RecordingOptions still_recording(double duration) {
  RecordingOptions options;
  options.duration = duration;
  options.gnss.rate_hz = 1.3;
  options.gnss.phase = 0.0137;
  options.gnss.lever_arm_b = {0.5, 0.2, -1.0};
  options.gnss.velocity_sd = Eigen::Vector3d(0.02, 0.02, 0.03);
  return options;
}

[[nodiscard]] inline estimate::FilterOptions still_options() {
  estimate::FilterOptions options;
  options.gate_probability = 0.0;
  options.auxiliary.lever_arm_sd_m = 0.01;
  options.auxiliary.correlated_gnss = {.horizontal_m = 0.02, .vertical_m = 0.03, .time_s = 20.0};
  return options;
}

/// A mission with a drawn start; what is changed in the recording or the start before run() counts.
struct Filtered {
  Filtered(const std::string& yaml, const RecordingOptions& recording_options, const estimate::FilterOptions& filter_options,
           std::uint64_t seed, const StartSd& sd)
      : model(error_model(yaml)), options(filter_options) {
    recording = make_recording(recording_options, &model, seed);
    float_between(recording.gnss, 4, 7);  // a lasting error ends there and another begins
    begin(seed, sd);
  }
  void begin(std::uint64_t seed, const StartSd& sd) {
    filter = std::make_unique<estimate::ForwardFilter>(recording.mission(), model, options);
    std::mt19937_64 random(seed);
    start = drawn_start(*filter, recording.truth(mission_start()), sd, random);
  }
  void run() {
    estimate::FilterOutputs outputs;
    outputs.knots = &knots;
    outputs.measurements = [this](const estimate::Measurement& what, bool used) {
      measurements.push_back({knots.size(), what, used});
    };
    (void)filter->run(start, outputs);
  }
  [[nodiscard]] estimate::BatchSolution batch(const estimate::BatchOptions& batch_options = {}) const {
    return smooth_batch(recording.mission(), filter->layout(), options, start, knots, measurements, batch_options);
  }
  [[nodiscard]] std::vector<estimate::SmoothedKnot> smoothed() const { return smooth(knots, filter->layout()); }

  noise::ImuErrorModel model;
  estimate::FilterOptions options;
  Recording recording;
  std::unique_ptr<estimate::ForwardFilter> filter;
  estimate::FilterState start;
  estimate::KnotStore knots;
  std::vector<estimate::KnotMeasurement> measurements;
};

}  // namespace coast::test
