#include "coast/carrier/ppk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "coast/parallel.hpp"
#include "coast/record/error.hpp"
#include "doppler_displacement.hpp"
#include "pass.hpp"
#include "phase_velocity.hpp"
#include "quantile.hpp"

namespace coast::carrier {

namespace {

/// Distributes the progress over stages of about equal duration.
class Stages {
 public:
  Stages(const std::function<void(double)>& progress, int count) : progress_(progress), count_(count) {}
  std::function<void(double)> next() {
    const int done = done_++;
    return [this, done](double share) {
      if (progress_) progress_((done + share) / count_);
    };
  }

 private:
  const std::function<void(double)>& progress_;
  int count_;
  int done_ = 0;
};

/// The value exceeded by one in twenty: single points have outliers.
double upper_end(const std::vector<double>& values) {
  return values.empty() ? 0.0 : quantile(values, 0.95);
}

/// Atmosphere states required by the baseline.
AirStates air_states(const std::vector<DifferenceEpoch>& epochs, bool ionosphere_free) {
  constexpr double kFar = 10e3;     // m
  constexpr double kAbove = 150.0;  // m
  std::vector<double> lengths, heights;
  for (const DifferenceEpoch& epoch : epochs) {
    if (!epoch.alone || !epoch.age_s) continue;
    const Eigen::Vector3d baseline_e = epoch.alone->r_e - epoch.r_base_e;
    lengths.push_back(baseline_e.norm());
    heights.push_back(std::abs(baseline_e.dot(epoch.r_base_e.normalized())));
  }
  const bool far = upper_end(lengths) > kFar;
  return {far || ionosphere_free, far || upper_end(heights) > kAbove, ionosphere_free};
}

/// Three stretches of the mission, at its beginning, middle and end: enough for a handful of sds. All of it, if it is short.
std::vector<DifferenceEpoch> sample(const std::vector<DifferenceEpoch>& epochs) {
  constexpr std::size_t kStretches = 3, kLength = 400;
  if (epochs.size() <= kStretches * kLength) return epochs;
  std::vector<DifferenceEpoch> parts;
  for (std::size_t k = 0; k < kStretches; ++k) {
    const auto begin = epochs.begin() + static_cast<std::ptrdiff_t>(k * (epochs.size() - kLength) / (kStretches - 1));
    parts.insert(parts.end(), begin, begin + kLength);
  }
  return parts;
}

void check(const record::ObservationRecording& rover, const record::ObservationRecording& base, const PpkSolution& solution,
           const std::vector<DifferenceEpoch>& epochs) {
  if (solution.signals.empty())
    throw InputError({base.source, 0, fmt::format("no signal whose code and phase {} has too", rover.source),
                      "two receivers that track the same band of the same system",
                      "Look at the observation types in both headers."});
  if (std::ranges::none_of(epochs, [](const DifferenceEpoch& e) { return e.age_s.has_value(); }))
    throw InputError(
        {base.source, 0,
         fmt::format("epochs from {} to {}", geo::to_string(base.epochs.front().t), geo::to_string(base.epochs.back().t)),
         fmt::format("some within {} to {}, the time of {}", geo::to_string(rover.epochs.front().t),
                     geo::to_string(rover.epochs.back().t), rover.source),
         "Give the base's file of the same time."});
  if (std::ranges::none_of(epochs, [](const DifferenceEpoch& e) { return e.seen > 0; }))
    throw InputError({rover.source, 0, "no satellite whose orbit is known", "ephemerides of the same hours",
                      "Give the navigation file of the same day."});
}

}  // namespace

std::string_view in_words(Shortfall shortfall) {
  switch (shortfall) {
    case Shortfall::kNone:
      return "nothing";
    case Shortfall::kNoBase:
      return "no epoch of the base near enough";
    case Shortfall::kNoPosition:
      return "not even a single-point position";
    case Shortfall::kFewSatellites:
      return "fewer than four satellites that both receivers track";
    case Shortfall::kContradiction:
      return "observations that contradict each other";
    case Shortfall::kFewAmbiguities:
      return "fewer than four ambiguities that can be integers";
    case Shortfall::kLowSuccessRate:
      return "ambiguities too uncertain for integers";
    case Shortfall::kLowRatio:
      return "two sets of integers nearly as good";
    case Shortfall::kBadGeometry:
      return "satellites placed too badly for centimetres";
    case Shortfall::kSeparated:
      return "forward and backward differ beyond their sigmas";
  }
  return "";
}

PpkSolution solve_ppk(const record::ObservationRecording& rover, const record::ObservationRecording& base, const Orbits& orbits,
                      const BasePosition& base_position, const PpkOptions& options,
                      const std::function<void(double)>& progress) {
  PpkSolution solution;
  solution.interval_s = interval_of(rover);
  solution.signals = choose_signals(rover, base, options.differences.systems);
  std::vector<DifferenceEpoch> epochs =
      form_differences(rover, base, solution.signals, orbits, base_position, options.differences);
  check(rover, base, solution, epochs);
  PpkOptions settled = options;
  if (!options.air) settled.air = air_states(epochs, options.differences.air.ionosphere_free);
  const bool combined = options.order == PassOrder::kCombined;
  const bool backward = options.order == PassOrder::kBackward;
  Stages stages(progress, (options.noise ? 0 : 1) + (combined ? 2 : 1));
  if (!options.noise) {
    constexpr NoiseScale kLenient{1.5, 2.0, 1.0};  // so that noise is not considered an outlier before it is known
    settled.noise = kLenient;
    const std::vector<DifferenceEpoch> parts = sample(epochs);
    const std::vector<PpkEpoch> first = solve_pass(parts, settled, solution.interval_s, backward, {}, stages.next()).epochs;
    settled.noise = estimate_noise(first, *settled.noise);
    settled.noise->displacement = displacement_noise(parts, first);
  }
  solution.noise = *settled.noise;
  solution.air = *settled.air;
  const auto pass = [&](bool in_reverse, const KnownIntegers& known, const std::function<void(double)>& told) {
    return solve_pass(epochs, settled, solution.interval_s, in_reverse, known, told);
  };
  if (combined) {
    const auto both = [&](const KnownIntegers& known) {
      std::pair<Pass, Pass> passes;
      const std::function<void(double)> told = stages.next();
      coast::parallel_invoke([&] { passes.first = pass(false, known, told); }, [&] { passes.second = pass(true, known, {}); });
      return passes;
    };
    auto [there, back] = both({});
    split_arcs(epochs, there.ambiguities, back.ambiguities);
    const KnownIntegers known(there.ambiguities, back.ambiguities);
    if (!known.empty()) std::tie(there, back) = both(known);
    solution.epochs = combine(there.epochs, back.epochs);
  } else {
    solution.epochs = pass(backward, {}, stages.next()).epochs;
  }
  add_phase_velocities(epochs, solution.noise, options.differences, solution.epochs);
  if (!options.noise) solution.noise.rate = estimate_rate_noise(epochs, solution.epochs, options.differences);
  solution.differences = std::move(epochs);
  return solution;
}

}  // namespace coast::carrier
