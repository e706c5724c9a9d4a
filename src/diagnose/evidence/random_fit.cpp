#include "evidence/random_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "coast/parallel.hpp"

namespace coast::diagnose {

namespace {

constexpr double kLogStep = 1.0;  // of a root

/// Gain in log-likelihood from forward runs with the effect.
class GainOfRoot {
 public:
  GainOfRoot(const AddedNoise& noise, const FilteredMission& run) : noise_(noise), run_(run) {}
  [[nodiscard]] double operator()(double log_root) const {
    MissionInput with = run_.input;
    AddedNoise noise = noise_;
    noise.root = std::exp(log_root);
    noise.add_to(with);
    if (with.setup.start)
      with.setup.start_sensor_errors = sensor_states_in(layout_of(with), run_.layout, run_.input.setup.start_sensor_errors);
    const std::optional<estimate::FilterResult> result = forward(std::move(with));
    return result ? result->log_likelihood - run_.log_likelihood : kBroken;
  }

 private:
  const AddedNoise& noise_;
  const FilteredMission& run_;
};

/// Gains at a root and one step to either side.
struct Bracket {
  double log_root, gain, low, high;
};
Bracket uphill(const GainOfRoot& gain_at, double log_root) {
  constexpr int kMost = 8;
  Bracket b{log_root, 0.0, 0.0, 0.0};
  coast::parallel_invoke([&] { b.gain = gain_at(log_root); }, [&] { b.low = gain_at(log_root - kLogStep); },
                         [&] { b.high = gain_at(log_root + kLogStep); });
  for (int i = 0; i < kMost && std::max(b.low, b.high) > b.gain; ++i) {
    const bool up = b.high > b.low;
    b.log_root += up ? kLogStep : -kLogStep;
    double& ahead = up ? b.high : b.low;
    (up ? b.low : b.high) = b.gain;
    b.gain = ahead;
    ahead = gain_at(up ? b.log_root + kLogStep : b.log_root - kLogStep);
  }
  return b;
}

/// The log-likelihood as function of the logarithm of the correlation time, and the change of the root with it.
struct OverTime {
  double time = 0.0;        ///< of the vertex
  double log_sd = 0.0;      ///< of the time
  double root_slope = 0.0;  ///< of the root's logarithm
};
OverTime over_time(const FittedEffect& shorter, const FittedEffect& best, const FittedEffect& longer) {
  constexpr double kFlat = 0.01;  // below this curvature the time is unknown within a factor of a thousand
  const double down = std::log(shorter.noise.time / best.noise.time), up = std::log(longer.noise.time / best.noise.time);
  // Through (down, a), (0, 0), (up, b): y = p x + q x^2.
  const double a = (shorter.gain - best.gain) / down, b = (longer.gain - best.gain) / up;
  const double q = std::min((b - a) / (up - down), -kFlat);
  const double p = a - q * down;
  return {best.noise.time * std::exp(std::clamp(-0.5 * p / q, down, up)), 1.0 / std::sqrt(-2.0 * q),
          std::log(longer.noise.root / shorter.noise.root) / (up - down)};
}

/// The same effect at another correlation time.
FittedEffect at_time(const FittedEffect& fit, double time, const FilteredMission& run) {
  AddedNoise noise = fit.noise;
  noise.time = time;
  return fitted_effect(noise, run);
}

/// The fits at all tested times, and the best of them.
struct FitsInTime {
  std::vector<std::optional<FittedEffect>> fits;
  std::size_t best = 0;
};
FitsInTime uphill_in_time(const FittedEffect& fit, const FilteredMission& run) {
  const std::vector<double>& times = fit.noise.effect->times;
  FitsInTime at{std::vector<std::optional<FittedEffect>>(times.size()),
                static_cast<std::size_t>(std::ranges::find(times, fit.noise.time) - times.begin())};
  at.fits[at.best] = fit;
  for (bool uphill = true; uphill;) {
    uphill = false;
    for (std::size_t k = at.best > 0 ? at.best - 1 : 0; k < std::min(at.best + 2, times.size()); ++k) {
      if (!at.fits[k]) at.fits[k] = at_time(fit, times[k], run);
      if (at.fits[k]->gain <= at.fits[at.best]->gain) continue;
      at.best = k;
      uphill = true;
      break;
    }
  }
  return at;
}

}  // namespace

FittedEffect fitted_effect(const AddedNoise& from, const FilteredMission& run) {
  const GainOfRoot gain_at(from, run);
  Bracket b = uphill(gain_at, std::log(from.root));
  FittedEffect fitted{.noise = from, .log_sd = kLogStep, .gain = b.gain};
  const double curvature = (2.0 * b.gain - b.low - b.high) / (kLogStep * kLogStep);
  if (curvature > 0.0 && std::min(b.low, b.high) > kBroken) {
    fitted.log_sd = 1.0 / std::sqrt(curvature);
    const double vertex = b.log_root + 0.5 * (b.high - b.low) / (curvature * kLogStep);
    const double at_vertex = gain_at(vertex);
    if (at_vertex > b.gain) {
      b.log_root = vertex;
      fitted.gain = at_vertex;
    }
  }
  fitted.noise.root = std::exp(b.log_root);
  return fitted;
}

FittedEffect fitted_in_time(const FittedEffect& fit, const FilteredMission& run) {
  const std::vector<double>& times = fit.noise.effect->times;
  const FitsInTime at = uphill_in_time(fit, run);
  const FittedEffect& best = *at.fits[at.best];
  if (times.size() < 2) return best;
  // At an end of the table one more step tests whether the likelihood decreases there.
  const FittedEffect shorter = at.best > 0 ? *at.fits[at.best - 1] : at_time(fit, times[0] * times[0] / times[1], run);
  const FittedEffect longer = at.best + 1 < times.size()
                                  ? *at.fits[at.best + 1]
                                  : at_time(fit, times[at.best] * times[at.best] / times[at.best - 1], run);
  const OverTime over = over_time(shorter, best, longer);
  FittedEffect between = at_time(fit, over.time, run);
  if (!(between.gain > best.gain)) between = best;
  between.log_sd = std::hypot(between.log_sd, over.root_slope * over.log_sd);
  between.log_time_sd = over.log_sd;
  return between;
}

// The correlation time is chosen too.
double evidence_of(const FittedEffect& fit) {
  return fit.gain - price_of_random_effect(fit.log_sd) - std::log(static_cast<double>(fit.noise.effect->times.size()));
}

double price_of_random_effect(double log_sd) {
  constexpr double kRange = 9.21;  // of the root's logarithm: four decades are equally plausible
  constexpr double kRootTwoPi = 2.5066;
  const double choices = 3.0 * static_cast<double>(noise_catalogue().size());  // axes of each
  return std::log(choices) + std::max(0.0, std::log(kRange / (kRootTwoPi * log_sd)));
}

Eigen::VectorXd sensor_states_in(const estimate::StateLayout& to, const estimate::StateLayout& from, const Eigen::VectorXd& x) {
  Eigen::VectorXd states = Eigen::VectorXd::Zero(to.sensor_end());
  if (x.size() < from.sensor_end()) return states;
  states.head(estimate::kNav) = x.head(estimate::kNav);
  std::vector<const estimate::StateLayout::SensorBlock*> left;
  for (const estimate::StateLayout::SensorBlock& block : from.sensors()) left.push_back(&block);
  for (const estimate::StateLayout::SensorBlock& block : to.sensors()) {
    const auto same = std::ranges::find_if(left, [&](const estimate::StateLayout::SensorBlock* other) {
      return other->process->name() == block.process->name() && other->size == block.size && other->axis == block.axis &&
             other->sensor == block.sensor;
    });
    if (same == left.end()) continue;
    states.segment(block.offset, block.size) = x.segment((*same)->offset, (*same)->size);
    left.erase(same);
  }
  return states;
}

estimate::StateLayout layout_of(const MissionInput& input) {
  return {input.setup.model, input.setup.C_s_b, input.setup.filter.auxiliary};
}

}  // namespace coast::diagnose
