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

/// What the output of a process is multiplied with to give the error of the axis it belongs to.
enum class Input {
  kOne,       ///< additive error
  kOwnAxis,   ///< true signal of the same axis: scale factor
  kNextAxis,  ///< true signal of the next axis (x -> y -> z -> x): misalignment
  kPrevAxis,  ///< true signal of the previous axis: misalignment
};

/// What a sensor rounds to multiples of a step.
struct Rounding {
  enum class Of {
    kIntegral,  ///< the integral of the output: the error of the integral never exceeds half a step
    kSample,    ///< every sample by itself
  } of;
  double step;  ///< [signal] s or [signal], > 0
};

/// Where a recording is the weighted sum of several IMUs: whose error a process is, and what that one counts.
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
  /// Mean of x at the start of a mission: zero but for what is known beforehand.
  virtual void initial_mean(Eigen::Ref<Eigen::VectorXd> mean) const { mean.setZero(); }
  /// The signs that the states take to a clock that runs backwards, if the error itself keeps its sign: -1 for a rate of
  /// change.
  virtual void reversal(Eigen::Ref<Eigen::VectorXd> sign) const { sign.setOnes(); }
  /// Interval of a series that has values at instants of its own and holds each until the next, s. Nothing for a process in
  /// continuous time. Phi and Q_d over whole intervals are those of the series; over others see the process.
  [[nodiscard]] virtual std::optional<double> sample_interval() const { return {}; }
  /// What the sensor rounds, after all other errors. The filter sees no more of it than `white_density`.
  [[nodiscard]] virtual std::optional<Rounding> rounding() const { return {}; }
  /// Density of the white part of the output, [signal]^2/Hz; zero for a process that has states only.
  [[nodiscard]] virtual geo::Psd white_density() const { return {}; }
  /// Density at frequency zero, [signal]^2/Hz, of a process with states that a navigation filter may take for white noise: one
  /// that forgets within a tenth of a second, as the sensor's own filter, or only rings, as vibration. Simulation and curves
  /// know the difference; nothing where a filter needs the states.
  [[nodiscard]] virtual std::optional<geo::Psd> as_white() const { return {}; }
  /// Allan variance of the error at averaging time tau (s, > 0), [signal]^2. Nothing for a process that multiplies the true
  /// signal, and where the variance does not exist. The Haar wavelet variance at the same scale is half of it.
  [[nodiscard]] virtual std::optional<double> allan_variance(double tau) const = 0;
  /// Hadamard variance, [signal]^2, as above.
  [[nodiscard]] virtual std::optional<double> hadamard_variance(double tau) const = 0;
  /// Of one among several IMUs that were merged: the output is the member's error times its weight.
  [[nodiscard]] virtual std::optional<Share> share() const { return {}; }
  /// What the values say to a person; empty where they speak for themselves.
  [[nodiscard]] virtual std::string in_words() const { return {}; }
  /// The entry of an error-model file that makes this process again, in SI units.
  [[nodiscard]] virtual std::string yaml() const = 0;
};
using ProcessPtr = std::shared_ptr<const Process>;

/// What an entry of the file is read for.
struct EntryContext {
  Sensor sensor;
  double rate_hz;  ///< of the model file: `variance_per_sample` refers to it; 0 where the file does not say
};

class Estimable;

/// One line of the registry: a name, help for people, and how an entry becomes processes.
struct Registration {
  std::string_view name;
  std::string_view help;          ///< parameters with units and meaning
  std::string_view gyro_example;  ///< a valid entry for a gyro axis
  std::string_view accel_example;
  std::vector<ProcessPtr> (*make)(const config::Node& entry, const EntryContext& context);
  const Estimable* estimable = nullptr;  ///< how it is found in a static record; nothing where it is not
};

/// Every process that exists, in the order of the manual.
[[nodiscard]] const std::vector<Registration>& registry();
/// How a process of this name is estimated; "ar(3)" for an order other than 2. @throws std::invalid_argument  there is none
[[nodiscard]] const Estimable& estimable(std::string_view name);
/// @throws InputError  unknown process (names the nearest), missing or negative value, wrong unit: with file and line
[[nodiscard]] std::vector<ProcessPtr> make_processes(const config::Node& entry, const EntryContext& context);

}  // namespace coast::noise
