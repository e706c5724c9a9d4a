#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "coast/record/event.hpp"

namespace coast::record {

/// One IMU sample as received: the device's counter, and the computer's time of arrival.
struct Packet {
  std::int64_t counter = 0;           ///< of the device, incremented with every sample; may wrap
  double arrival_s = 0.0;             ///< computer's time, s since any epoch, the same for all devices
  std::optional<double> master_s;     ///< GPS time stamped by the device, s of week; master device only
  std::optional<std::int64_t> pulse;  ///< number of the sync pulse that triggered this sample
  std::size_t row = 0;                ///< row in `rates` and `forces` of the recording
};

/// Packets of one IMU in order of arrival, in its own axes.
struct PacketRecording {
  std::string source;  ///< file, for messages
  std::vector<Packet> packets;
  std::vector<Eigen::Vector3d> rates;   ///< rad/s, mean over the interval that ends with the sample
  std::vector<Eigen::Vector3d> forces;  ///< m/s^2
  Events events;
};

}  // namespace coast::record
