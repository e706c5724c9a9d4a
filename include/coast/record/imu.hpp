#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "coast/geo/time.hpp"
#include "coast/record/event.hpp"

namespace coast::record {

/// Increments over (t - dt, t].
struct ImuSample {
  geo::GpsTime t;          ///< end of the interval
  double dt = 0.0;         ///< s, > 0
  Eigen::Vector3d dtheta;  ///< integral of omega_ib, rad
  Eigen::Vector3d dv;      ///< integral of f_ib, m/s
};

/// White noise of an IMU over a period, relative to its mean: factors on the densities [power] of the error model.
struct NoiseLevel {
  geo::GpsTime from, to;
  Eigen::Vector3d gyro = Eigen::Vector3d::Ones();  ///< sensor's axes
  Eigen::Vector3d accel = Eigen::Vector3d::Ones();
};

/// For a recording that is the weighted sum of several IMUs (its members): the measurements of each member, as means over
/// blocks, in sensor axes like the shares of the error model (the recording itself may since have been rotated to body axes).
struct MemberBlocks {
  struct Means {
    Eigen::Vector3d gyro;   ///< rad/s
    Eigen::Vector3d accel;  ///< m/s^2
  };
  struct Block {
    geo::GpsTime from, to;
    std::vector<std::optional<Means>> means;  ///< one per member; nothing if it is not usable over the whole block
  };
  std::string source;  ///< file, for messages
  std::vector<std::string> names;
  std::vector<Block> blocks;  ///< in order, not overlapping
};

/// One IMU as recorded, in the sensor's own axes unless stated otherwise. Strictly increasing in time.
struct ImuRecording {
  std::string source;  ///< file, for messages
  std::vector<ImuSample> samples;
  std::vector<float> temperature;  ///< degC, one per sample, or empty
  double rate_hz = 0.0;            ///< number of samples divided by the time without gaps
  std::vector<NoiseLevel> noise;   ///< in order, each begins where the previous one ends; empty: constant noise
  MemberBlocks members;            ///< for a synthetic IMU with separate member data; empty otherwise
  Events events;                   ///< repairs and gaps found on reading
};

}  // namespace coast::record
