#pragma once
// One receiver's observations of the chosen signals, by satellite and band, with the arcs of its phases. Private to the room.

#include "coast/carrier/differences.hpp"

namespace coast::carrier {

struct TrackedBand {
  char band = '1';
  double frequency = 0.0;  ///< Hz
  std::optional<double> code;
  std::optional<double> phase;  ///< m
  double cn0 = 0.0;             ///< dB-Hz, 0 where unknown
  bool half_cycle = false;
  int arc = 0;
};

struct TrackedSatellite {
  record::Satellite satellite;
  SatelliteState state;  ///< at transmission
  std::vector<TrackedBand> bands;
};

struct TrackedEpoch {
  geo::GpsTime t;
  std::vector<TrackedSatellite> satellites;
  std::vector<CodeMeasurement> codes;  ///< one of each satellite, for single-point positions
};

/// @param signals  tracking wanted of each system and band  @param from, to  what is not needed outside is left out
std::vector<TrackedEpoch> track(const record::ObservationRecording& receiver, const Orbits& orbits,
                                const std::map<std::pair<record::SatelliteSystem, char>, char>& signals, geo::GpsTime from,
                                geo::GpsTime to);

/// Median step between epochs, s; 0 with fewer than two.
double interval_of(const record::ObservationRecording& receiver);
/// Phases missing for longer may have slipped unseen, s.
double longest_gap(double interval);

}  // namespace coast::carrier
