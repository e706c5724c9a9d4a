#pragma once
// One receiver's observations of the chosen signals, by satellite and band, with the arcs of its phases. Private to the room.

#include "coast/carrier/differences.hpp"

namespace coast::carrier {

struct TrackedBand {
  char band = '1';
  double frequency = 0.0;  ///< Hz
  std::optional<double> code;
  std::optional<double> phase;  ///< m
  std::optional<double> rate;   ///< from Doppler, m/s
  double cn0 = 0.0;             ///< dB-Hz, 0 if unknown
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
  std::vector<CodeMeasurement> codes;  ///< one per satellite, for single-point positions
};

/// Signals and time span to be used; the rest is omitted.
struct Tracking {
  const std::set<record::SatelliteSystem>& systems;
  std::map<std::pair<record::SatelliteSystem, char>, char> signals;  ///< tracking code of each system and band
  geo::GpsTime from, to;
  bool ionosphere_free = false;  ///< codes for single-point positions
};
std::vector<TrackedEpoch> track(const record::ObservationRecording& receiver, const Orbits& orbits, const Tracking& wanted);

/// Phases missing for longer may have slipped undetected, s.
double longest_gap(double interval);

}  // namespace coast::carrier
