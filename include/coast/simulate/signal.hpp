#pragma once
// Smooth functions of time from which motions are composed: smooth steps and tones.

#include <cstddef>
#include <vector>

#include "coast/simulate/jet.hpp"

namespace coast::simulate {

/// Third order, as needed from the course for the angular acceleration of a body that banks with its turn rate.
using SignalJet = Jet<3>;

/// A change of level by `change`, nominally from `start` to `start + duration`: an error function with
/// sigma = duration / 6, so 99.7 % of the change is within the nominal time. The peak slope is 2.394 change / duration.
struct Step {
  double start;     ///< s
  double duration;  ///< s, > 0
  double change;    ///< [signal]
};

/// A constant and a sum of steps. The error function is entire, so the sum is analytic; a step is truncated at 6.5 sqrt(2)
/// sigma from its middle, where its remainder and its derivatives are below 1e-15 of their peaks: further away it is exactly
/// constant.
class Steps {
 public:
  explicit Steps(double constant = 0.0, std::vector<Step> steps = {});
  [[nodiscard]] SignalJet at(double t) const;
  [[nodiscard]] double constant() const { return constant_; }
  /// How far a step of this nominal duration reaches beyond its nominal start and end, s.
  [[nodiscard]] static double reach(double duration);

 private:
  void add_to_buckets(std::size_t index);

  double constant_;
  std::vector<Step> steps_;
  // Time is divided into buckets, so that an evaluation needs only the steps in progress.
  double first_ = 0.0;           // s, start of the first bucket
  std::vector<double> settled_;  // level from the steps that end before the bucket begins
  std::vector<std::vector<std::size_t>> in_progress_;
};

/// amplitude sin(2 pi frequency t + phase)
struct Tone {
  double amplitude;  ///< [signal]
  double frequency;  ///< Hz
  double phase;      ///< rad
};

/// Steps plus tones that a common envelope switches on and off; where the envelope is zero the tones are exactly zero.
class Signal {
 public:
  Signal() = default;
  Signal(Steps level) : level_(std::move(level)) {}  // a level alone is a signal
  Signal(Steps level, Steps envelope, std::vector<Tone> tones)
      : level_(std::move(level)), envelope_(std::move(envelope)), tones_(std::move(tones)) {}
  [[nodiscard]] SignalJet at(double t) const;

 private:
  Steps level_;
  Steps envelope_;
  std::vector<Tone> tones_;
};

}  // namespace coast::simulate
