#pragma once
// A sum of estimable processes with level and drift: the model fitted to a static record.

#include <string>
#include <vector>

#include "coast/noise/estimable.hpp"

namespace coast::noise {

/// Part of the mean that is estimated together with the processes, by generalised least squares at every value of the
/// parameters.
enum class Mean { kZero, kLevel, kLevelAndDrift };
[[nodiscard]] constexpr int coefficients(Mean mean) {
  return static_cast<int>(mean);
}

/// Sum of processes, each with its part of the parameter vector u and of the state.
class SumModel {
 public:
  struct Term {
    const Estimable* process = nullptr;
    std::size_t parameter = 0;  ///< first of its parameters in u
    std::size_t parameters = 0;
    Eigen::Index state = 0;  ///< first of its states
    Eigen::Index states = 0;
  };

  SumModel() = default;
  SumModel(const std::vector<const Estimable*>& processes, Mean mean);

  [[nodiscard]] const std::vector<Term>& terms() const { return terms_; }
  [[nodiscard]] Mean mean() const { return mean_; }
  [[nodiscard]] std::size_t parameters() const { return parameters_; }
  [[nodiscard]] Eigen::Index states() const { return states_; }
  /// Whether a block for means of samples exists: all processes have one, and the total number of states is within the limit.
  [[nodiscard]] bool has_averages() const;
  [[nodiscard]] ParameterInfo parameter(std::size_t i) const;
  /// "beta 2" of the second Gauss-Markov process: unique within the model.
  [[nodiscard]] std::string parameter_name(std::size_t i) const;
  /// "WN + 2 GM + RW + level + drift".
  [[nodiscard]] std::string name() const;
  [[nodiscard]] std::vector<Interval> ranges(const SignalScale& scale) const;
  [[nodiscard]] std::vector<double> values(const std::vector<double>& u) const;

  [[nodiscard]] SampleBlock block(const std::vector<double>& u, const SampleStep& step) const;
  /// One per parameter.
  [[nodiscard]] std::vector<SampleBlock> derivatives(const std::vector<double>& u, const SampleStep& step) const;
  [[nodiscard]] std::vector<ProcessPtr> processes(const std::vector<double>& u, const Sampling& sampling) const;

 private:
  std::vector<Term> terms_;
  Mean mean_ = Mean::kLevel;
  std::size_t parameters_ = 0;
  Eigen::Index states_ = 0;
};

}  // namespace coast::noise
