#pragma once
// What RTCM says of the station: its place, its antenna and its receiver. Private to the room.

#include "../frames/frame.hpp"
#include "coast/record/observation.hpp"

namespace coast::io {

/// Of one reference station.
struct RtcmStation {
  std::optional<Eigen::Vector3d> r_e;  ///< antenna reference point, m
  double height = 0.0;                 ///< of that point above the marker, m
  std::string antenna, receiver;
};

/// 1005, 1006, 1007, 1008 and 1033; others change nothing, nor does one that is shorter than its contents.
void take_station(const MessageFrame& frame, RtcmStation& station);

/// The marker is below the antenna reference point.
void put_station(const RtcmStation& station, record::ObservationRecording& recording);

}  // namespace coast::io
