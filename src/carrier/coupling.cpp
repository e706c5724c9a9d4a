#include "coast/carrier/coupling.hpp"

#include <algorithm>

#include "fixing.hpp"
#include "receiver_track.hpp"

namespace coast::carrier {

struct Coupling::Parts {
  Parts(const PpkOptions& ppk, double interval)
      : options(ppk), filter(RelativeFilter::coupled(ppk, interval)), fixing(ppk.fixing) {}

  const PpkOptions& options;
  RelativeFilter filter;
  AmbiguityFixing fixing;
  IntegerHold hold;
};

Coupling::Coupling(const PpkOptions& options, double interval_s) : parts_(std::make_unique<Parts>(options, interval_s)) {}
Coupling::~Coupling() = default;
Coupling::Coupling(Coupling&&) noexcept = default;
Coupling& Coupling::operator=(Coupling&&) noexcept = default;

CoupledEpoch Coupling::step(RelativeState prior, const DifferenceEpoch& epoch) {
  RelativeFilter& filter = parts_->filter;
  FloatEpoch updated = filter.step_from(std::move(prior), epoch);
  CoupledEpoch coupled;
  coupled.shortfall = updated.shortfall;
  coupled.usable = updated.updated;
  if (updated.updated) {
    std::set<std::size_t> satellites;
    for (const Row& row : updated.dd.rows) satellites.insert(row.satellite);
    coupled.satellites = static_cast<int>(satellites.size());
    coupled.unknowns = filter.state().unknowns();
    coupled.nis = updated.nis;
    if (parts_->options.fixing.wanted) {
      const FixedSolution fixed = parts_->fixing.fix(epoch, updated, filter.state());
      coupled.fixed = fixed.fixed;
      coupled.ratio = fixed.ratio;
      coupled.shortfall = fixed.shortfall;
      if (fixed.fixed) {
        HeldIntegers integers = held(parts_->hold.agreed(fixed.pairs), filter.state());
        coupled.H_integers = std::move(integers.H);
        coupled.nu_integers = std::move(integers.nu);
      }
    }
    coupled.H = std::move(updated.H);
    coupled.nu = std::move(updated.nu);
  }
  coupled.changes = filter.take_changes();
  return coupled;
}

std::size_t most_unknowns(const std::vector<DifferenceEpoch>& epochs, const PpkOptions& options, double interval_s) {
  constexpr std::size_t kForAll = 3;  // zenith delay, inter-frequency biases of two bands
  const AirStates air = options.air.value_or(AirStates{});
  std::map<Unknown, geo::GpsTime> seen;
  std::size_t most = 0;
  for (const DifferenceEpoch& epoch : epochs) {
    for (const SatelliteDifference& s : epoch.satellites) {
      if (air.ionosphere) seen[{Unknown::Kind::kIonosphere, s.satellite, '0', 0}] = epoch.t;
      for (const BandDifference& band : s.bands)
        if (band.phase) seen[{Unknown::Kind::kAmbiguity, s.satellite, band.band, band.arc}] = epoch.t;
    }
    std::erase_if(seen, [&](const auto& of) { return epoch.t - of.second > longest_unseen(of.first, interval_s); });
    most = std::max(most, seen.size());
  }
  return most + kForAll;
}

}  // namespace coast::carrier
