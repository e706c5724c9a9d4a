#pragma once
// A stochastic process of one sensor axis as a linear state-space block. Any sum of blocks is an error model.

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coast/config/node.hpp"
#include "coast/geo/units.hpp"

namespace coast::noise {

enum class Sensor { kGyro, kAccel };

/// Factor by which the output of a process is multiplied to give the error of its axis.
enum class Input {
  kOne,       ///< additive error
  kOwnAxis,   ///< true signal of the same axis: scale factor
  kNextAxis,  ///< true signal of the next axis (x -> y -> z -> x): misalignment
  kPrevAxis,  ///< true signal of the previous axis: misalignment
};

/// Quantity that a sensor rounds to multiples of a step.
struct Rounding {
  enum class Of {
    kIntegral,  ///< the integral of the output; its error never exceeds half a step
    kSample,    ///< every sample separately
  } of;
  double step;  ///< [signal] s or [signal], > 0
};

/// For a recording that is the weighted sum of several IMUs: the IMU to which a process belongs, and its weight.
struct Share {
  std::string member;
  double weight = 1.0;
};

/// One process: error = (h x + white noise) * input, with x[k+1] = Phi(dt) x[k] + w[k], var w = Q_d(dt).
///
/// All values are SI; `signal` below is rad/s (gyro) or m/s^2 (accelerometer) for additive processes, 1 otherwise.
class Process {
 public:
  virtual ~Process() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;
  [[nodiscard]] virtual Input input() const { return Input::kOne; }
  [[nodiscard]] virtual int states() const = 0;
  /// Phi(dt), states x states. @param dt s, > 0
  virtual void transition(double dt, Eigen::Ref<Eigen::MatrixXd> Phi) const = 0;
  /// Q_d(dt), [signal]^2.
  virtual void driving_noise(double dt, Eigen::Ref<Eigen::MatrixXd> Q_d) const = 0;
  /// h, 1 x states: how the states add up to the error.
  virtual void output(Eigen::Ref<Eigen::RowVectorXd> h) const = 0;
  /// Covariance of x at the start of a mission.
  virtual void initial_covariance(Eigen::Ref<Eigen::MatrixXd> P) const = 0;
  /// Mean of x at the start of a mission: zero, unless known beforehand.
  virtual void initial_mean(Eigen::Ref<Eigen::VectorXd> mean) const { mean.setZero(); }
  /// Signs of the states under time reversal if the error itself keeps its sign: -1 for a rate of change.
  virtual void reversal(Eigen::Ref<Eigen::VectorXd> sign) const { sign.setOnes(); }
  /// Interval, s, of a discrete-time series that holds each value until the next. Nothing for a process in continuous time. Phi
  /// and Q_d over whole intervals are those of the series; for other intervals see the process.
  [[nodiscard]] virtual std::optional<double> sample_interval() const { return {}; }
  /// Rounding by the sensor, applied after all other errors. The filter models it only by `white_density`.
  [[nodiscard]] virtual std::optional<Rounding> rounding() const { return {}; }
  /// Density of the white part of the output, [signal]^2/Hz; zero for a process that has states only.
  [[nodiscard]] virtual geo::Psd white_density() const { return {}; }
  /// Density at frequency zero, [signal]^2/Hz, of a process with states that a navigation filter may treat as white noise: one
  /// with a correlation time below a tenth of a second, like the sensor's own filter, or a pure oscillation, like vibration.
  /// Simulation and curves use the full process. Nothing if a filter needs the states.
  [[nodiscard]] virtual std::optional<geo::Psd> as_white() const { return {}; }
  /// Allan variance of the error at averaging time tau (s, > 0), [signal]^2. Nothing for a process that multiplies the true
  /// signal, or if the variance does not exist. The Haar wavelet variance at the same scale is half of it.
  [[nodiscard]] virtual std::optional<double> allan_variance(double tau) const = 0;
  /// Hadamard variance, [signal]^2, as above.
  [[nodiscard]] virtual std::optional<double> hadamard_variance(double tau) const = 0;
  /// Set for a process of one of several merged IMUs: the output is the member's error times its weight.
  [[nodiscard]] virtual std::optional<Share> share() const { return {}; }
  /// Explanation of the values for the user; empty if none is needed.
  [[nodiscard]] virtual std::string in_words() const { return {}; }
  /// The error-model file entry of this process, in SI units.
  [[nodiscard]] virtual std::string yaml() const = 0;
};
using ProcessPtr = std::shared_ptr<const Process>;

/// Sensor and sampling rate for which an entry of the file is read.
struct EntryContext {
  Sensor sensor;
  double rate_hz;  ///< of the model file: `variance_per_sample` refers to it; 0 if the file does not state it
};

class Estimable;

/// One line of the registry: a name, help text, and the function that converts an entry to processes.
struct Registration {
  std::string_view name;
  std::string_view help;          ///< parameters with units and meaning
  std::string_view gyro_example;  ///< a valid entry for a gyro axis
  std::string_view accel_example;
  std::vector<ProcessPtr> (*make)(const config::Node& entry, const EntryContext& context);
  const Estimable* estimable = nullptr;  ///< how it is estimated from a static record; null if it cannot be
};

/// Every process that exists, in the order of the manual.
[[nodiscard]] const std::vector<Registration>& registry();
/// The estimable process of this name; "ar(3)" for an order other than 2. @throws std::invalid_argument  there is none
[[nodiscard]] const Estimable& estimable(std::string_view name);
/// @throws InputError  unknown process (names the nearest), missing or negative value, wrong unit: with file and line
[[nodiscard]] std::vector<ProcessPtr> make_processes(const config::Node& entry, const EntryContext& context);

}  // namespace coast::noise
