#pragma once
// Realisations of stochastic sensor errors.

#include <cstdint>
#include <memory>

#include "coast/noise/error_model.hpp"
#include "coast/noise/process.hpp"
#include "coast/record/imu.hpp"

namespace coast::simulate {

/// One realisation of one process, interval by interval. Its states are stepped exactly, by the process's own Phi(dt) and
/// Q_d(dt), from its initial mean and a draw of its initial covariance; the mean over an interval is that of the states at its
/// two ends. What this leaves out of a continuous walk of density q is white, with variance q dt / 12 a sample against the q dt
/// by which the walk itself moves in that time. A series with a sample interval of its own is stepped by that, whatever dt, and
/// each of its values counts for as long as it is held. Rounding is no process in time: it is white noise here, if anything.
class Realisation {
 public:
  Realisation(noise::ProcessPtr process, std::uint64_t seed);
  ~Realisation();
  Realisation(Realisation&&) noexcept;
  Realisation& operator=(Realisation&&) noexcept;

  /// Mean over the next dt seconds of h x + white noise, before it is multiplied with the process's input.
  /// @param dt s, > 0
  [[nodiscard]] double next(double dt);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// measured = truth + error: white noise, biases, scale factors, misalignments and whatever else the model lists; last of all
/// the sum is rounded where the model says so, a rounded integral with the residue carried on from sample to sample.
///
/// @param truth  error-free increments in sensor axes
/// @param seed   of the run; each process of each axis draws from a stream of its own that depends on nothing else
[[nodiscard]] record::ImuRecording with_errors(const record::ImuRecording& truth, const noise::ImuErrorModel& model,
                                               std::uint64_t seed);

}  // namespace coast::simulate
