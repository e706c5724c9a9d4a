#include <algorithm>
#include <cmath>

#include "coast/carrier/differences.hpp"
#include "coast/carrier/signals.hpp"

namespace coast::carrier {

namespace {

using record::ObservationRecording;
using record::Satellite;
using record::SatelliteSystem;

/// Epochs with code and phase by band, tracking and satellite.
using Counts = std::map<std::pair<SatelliteSystem, char>, std::map<char, std::map<Satellite, long>>>;

Counts count(const ObservationRecording& recording, const std::set<SatelliteSystem>& systems) {
  Counts counts;
  for (const record::ObservationEpoch& epoch : recording.epochs)
    for (const record::Observation& o : epoch.observations)
      if (o.code_m && o.phase_cycles && systems.contains(o.satellite.system) &&
          carrier_frequency(o.satellite.system, o.signal.band))
        ++counts[{o.satellite.system, o.signal.band}][o.signal.tracking][o.satellite];
  return counts;
}

double total(const std::map<Satellite, long>& of) {
  double sum = 0.0;
  for (const auto& [satellite, n] : of) sum += static_cast<double>(n);
  return sum;
}

/// Fraction of both receivers' epochs with satellites that both track with these signals.
double common(const std::map<Satellite, long>& rover, double all_rover, const std::map<Satellite, long>& base,
              double all_base) {
  double shares = 0.0;
  for (const auto& [satellite, n] : rover)
    if (const auto found = base.find(satellite); found != base.end())
      shares += std::min(static_cast<double>(n) / all_rover, static_cast<double>(found->second) / all_base);
  return shares;
}

}  // namespace

SignalChoice choose_signals(const ObservationRecording& rover, const ObservationRecording& base,
                            const std::set<SatelliteSystem>& systems) {
  constexpr double kEqual = 0.01;  // equal signals are preferred up to this loss of observations: their biases cancel
  const Counts rovers = count(rover, systems), bases = count(base, systems);
  SignalChoice choice;
  for (const auto& [band, rover_signals] : rovers) {
    const auto found = bases.find(band);
    if (found == bases.end()) continue;
    double most_rover = 0.0, most_base = 0.0;
    for (const auto& [tracking, counts] : rover_signals) most_rover = std::max(most_rover, total(counts));
    for (const auto& [tracking, counts] : found->second) most_base = std::max(most_base, total(counts));
    double best = 0.0;
    for (const auto& [rover_tracking, rover_counts] : rover_signals)
      for (const auto& [base_tracking, base_counts] : found->second) {
        const double shared = common(rover_counts, most_rover, base_counts, most_base);
        const double worth = shared > 0.0 && rover_tracking == base_tracking ? shared + kEqual : shared;
        if (!(worth > best)) continue;
        best = worth;
        choice[band] = {rover_tracking, base_tracking};
      }
  }
  // Galileo's E5 is E5a and E5b together: in addition to both it has no new information.
  const auto e5a = choice.find({SatelliteSystem::kGalileo, '5'}), e5b = choice.find({SatelliteSystem::kGalileo, '7'});
  if (e5a != choice.end() && e5b != choice.end()) choice.erase({SatelliteSystem::kGalileo, '8'});
  return choice;
}

}  // namespace coast::carrier
