#pragma once
// What a GNSS receiver measured.

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "coast/geo/time.hpp"
#include "coast/record/event.hpp"
#include "coast/record/satellite.hpp"
#include "coast/record/time_mark.hpp"

namespace coast::record {

/// One signal of one satellite.
struct Observation {
  Satellite satellite;
  Signal signal;
  std::optional<double> code_m;        ///< pseudorange
  std::optional<double> phase_cycles;  ///< grows with range
  std::optional<double> doppler_hz;    ///< positive when the satellite approaches
  std::optional<double> cn0_dbhz;
  bool lost_lock = false;   ///< a cycle slip is possible since the previous epoch
  bool half_cycle = false;  ///< the phase may be off by half a cycle
};

struct ObservationEpoch {
  geo::GpsTime t;                         ///< of the receiver's clock
  std::vector<Observation> observations;  ///< by satellite, then by signal
};

/// One receiver and its antenna.
struct ObservationRecording {
  std::string source;
  std::string marker;
  std::string receiver;
  std::string antenna;                             ///< IGS name and radome, as in ANTEX
  std::optional<Eigen::Vector3d> approximate_r_e;  ///< marker, ECEF, m; as stated in the file, may be wrong
  Eigen::Vector3d antenna_offset_enu =
      Eigen::Vector3d::Zero();           ///< antenna reference point from the marker: east, north, up, m
  std::map<int, int> glonass_channels;   ///< frequency number by slot, if stated
  std::vector<ObservationEpoch> epochs;  ///< strictly increasing in time
  std::vector<TimeMark> marks;           ///< outside events that RINEX records between epochs, in the order of time
  Events events;
};

}  // namespace coast::record
