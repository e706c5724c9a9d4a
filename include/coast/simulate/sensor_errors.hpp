#pragma once
// Realisations of stochastic sensor errors.

#include <cstdint>
#include <memory>

#include "coast/noise/error_model.hpp"
#include "coast/noise/process.hpp"
#include "coast/record/imu.hpp"

namespace coast::simulate {

/// One realisation of one process, interval by interval. Its states are propagated exactly, by the process's own Phi(dt) and
/// Q_d(dt), from its initial mean and a draw from its initial covariance; the mean over an interval is that of the states at
/// its two ends. For a continuous random walk of density q this neglects white noise of variance q dt / 12 per sample, compared
/// with the q dt by which the walk itself changes. A series with its own sample interval is stepped by that interval, for any
/// dt, and each value is weighted by the time for which it is held. Rounding is not a process in time: here it is white noise,
/// if anything.
class Realisation {
 public:
  Realisation(noise::ProcessPtr process, std::uint64_t seed);
  ~Realisation();
  Realisation(Realisation&&) noexcept;
  Realisation& operator=(Realisation&&) noexcept;

  /// Mean over the next dt seconds of h x + white noise, before it is multiplied by the process's input.
  /// @param dt s, > 0
  [[nodiscard]] double next(double dt);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// measured = truth + error: white noise, biases, scale factors, misalignments and all other processes of the model; finally
/// the sum is rounded if the model has rounding; for a rounded integral the remainder is carried from sample to sample.
///
/// @param truth  error-free increments in sensor axes
/// @param seed   of the run; each process of each axis draws from its own stream, independent of all others
[[nodiscard]] record::ImuRecording with_errors(const record::ImuRecording& truth, const noise::ImuErrorModel& model,
                                               std::uint64_t seed);

}  // namespace coast::simulate
