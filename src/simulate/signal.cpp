#include "coast/simulate/signal.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coast::simulate {
namespace {

constexpr double kCut = 6.5;     // of the error function's argument: erfc(6.5) = 4e-20
constexpr double kBucket = 0.5;  // s
constexpr double kSigmas = 6.0;  // nominal duration in sigmas

double half_width(const Step& step) {
  return kCut * std::numbers::sqrt2 * step.duration / kSigmas;
}
double middle(const Step& step) {
  return step.start + 0.5 * step.duration;
}

// change (1 + erf z) / 2 with z = (t - middle) / (sqrt(2) sigma); the derivatives are Hermite polynomials times exp(-z^2).
SignalJet step_jet(const Step& step, double t) {
  const double scale = kSigmas / (std::numbers::sqrt2 * step.duration);  // dz/dt
  const double z = (t - middle(step)) * scale;
  SignalJet jet;
  if (z <= -kCut) return jet;
  if (z >= kCut) return SignalJet(step.change);
  const double slope = step.change * scale * std::exp(-z * z) * std::numbers::inv_sqrtpi;
  jet.c[0] = 0.5 * step.change * std::erfc(-z);
  jet.c[1] = slope;
  jet.c[2] = -slope * scale * z;
  jet.c[3] = slope * scale * scale * (2.0 * z * z - 1.0) / 3.0;
  return jet;
}

SignalJet tone_jet(const Tone& tone, double t) {
  const double omega = 2.0 * std::numbers::pi * tone.frequency;
  const double s = tone.amplitude * std::sin(omega * t + tone.phase);
  const double c = tone.amplitude * std::cos(omega * t + tone.phase);
  SignalJet jet;
  jet.c = {s, omega * c, -0.5 * omega * omega * s, -omega * omega * omega * c / 6.0};
  return jet;
}

}  // namespace

double Steps::reach(double duration) {
  return half_width({0.0, duration, 0.0}) - 0.5 * duration;
}

Steps::Steps(double constant, std::vector<Step> steps) : constant_(constant), steps_(std::move(steps)) {
  if (steps_.empty()) return;
  first_ = middle(steps_.front()) - half_width(steps_.front());
  double last = first_;
  for (const Step& step : steps_) {
    first_ = std::min(first_, middle(step) - half_width(step));
    last = std::max(last, middle(step) + half_width(step));
  }
  const auto buckets = static_cast<std::size_t>(std::ceil((last - first_) / kBucket)) + 1;
  settled_.assign(buckets, constant_);
  in_progress_.resize(buckets);
  for (std::size_t i = 0; i < steps_.size(); ++i) add_to_buckets(i);
}

void Steps::add_to_buckets(std::size_t index) {
  const Step& step = steps_[index];
  const double begin = middle(step) - half_width(step);
  const double end = middle(step) + half_width(step);
  // One bucket of margin on either side: rounding of the quotient then never omits a step in progress.
  const auto from = static_cast<std::size_t>(std::max(0.0, std::floor((begin - first_) / kBucket) - 1.0));
  const auto to = std::min(settled_.size() - 1, static_cast<std::size_t>((end - first_) / kBucket) + 1);
  for (std::size_t b = from; b <= to; ++b) in_progress_[b].push_back(index);
  for (std::size_t b = to + 1; b < settled_.size(); ++b) settled_[b] += step.change;
}

SignalJet Steps::at(double t) const {
  if (steps_.empty() || t < first_) return SignalJet(constant_);
  const auto bucket = std::min(settled_.size() - 1, static_cast<std::size_t>((t - first_) / kBucket));
  SignalJet sum(settled_[bucket]);
  for (std::size_t i : in_progress_[bucket]) sum += step_jet(steps_[i], t);
  return sum;
}

SignalJet Signal::at(double t) const {
  SignalJet level = level_.at(t);
  if (tones_.empty()) return level;
  const SignalJet envelope = envelope_.at(t);
  if (envelope.c == SignalJet().c) return level;
  SignalJet tones;
  for (const Tone& tone : tones_) tones += tone_jet(tone, t);
  return level + envelope * tones;
}

}  // namespace coast::simulate
