#include "coast/estimate/carrier_observations.hpp"

#include <algorithm>

#include "coast/carrier/coupling.hpp"
#include "coast/ins/reversal.hpp"

namespace coast::estimate {

namespace {

/// Clock errors by the receiver's displayed time.
class ReceiverClock {
 public:
  explicit ReceiverClock(const std::vector<carrier::PpkEpoch>& epochs) {
    for (const carrier::PpkEpoch& epoch : epochs)
      if (epoch.quality != record::FixQuality::kUnknown) known_.push_back({epoch.shown, epoch.shown - epoch.t});
  }
  [[nodiscard]] double error_at(geo::GpsTime shown) const {
    if (known_.empty()) return 0.0;
    const auto after = std::ranges::lower_bound(known_, shown, {}, &Known::shown);
    if (after == known_.end()) return known_.back().error;
    if (after == known_.begin()) return after->error;
    const Known& before = *std::prev(after);
    return before.error + (shown - before.shown) / (after->shown - before.shown) * (after->error - before.error);
  }

 private:
  struct Known {
    geo::GpsTime shown;
    double error = 0.0;  ///< s
  };
  std::vector<Known> known_;
};

}  // namespace

CarrierObservations carrier_observations(carrier::PpkSolution solution, const carrier::PpkOptions& options) {
  CarrierObservations observations;
  observations.options = options;
  // Over minutes the smoother averages phases to less than the effect of the atmosphere over the shortest baselines.
  const bool air = options.differences.air.troposphere;
  observations.options.air = carrier::AirStates{air, air, solution.air.unbounded};
  observations.options.noise = solution.noise;
  observations.interval_s = solution.interval_s;
  observations.most_unknowns = carrier::most_unknowns(solution.differences, observations.options, solution.interval_s);
  const ReceiverClock clock(solution.epochs);
  observations.differences = std::make_shared<const std::vector<carrier::DifferenceEpoch>>(std::move(solution.differences));
  for (const carrier::DifferenceEpoch& epoch : *observations.differences) {
    const geo::GpsTime t = epoch.t - clock.error_at(epoch.t);
    if (observations.epochs.empty() || t > observations.epochs.back().t) observations.epochs.push_back({t, &epoch});
  }
  return observations;
}

CarrierObservations reversed(CarrierObservations observations, geo::GpsTime mirror) {
  std::ranges::reverse(observations.epochs);
  for (CarrierObservations::Epoch& epoch : observations.epochs) epoch.t = ins::mirrored(epoch.t, mirror);
  return observations;
}

}  // namespace coast::estimate
