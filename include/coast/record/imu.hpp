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

/// By what an IMU's white noise differs from its mean for a while: factors on the densities [power] of the error model.
struct NoiseLevel {
  geo::GpsTime from, to;
  Eigen::Vector3d gyro = Eigen::Vector3d::Ones();  ///< sensor's axes
  Eigen::Vector3d accel = Eigen::Vector3d::Ones();
};

/// Where a recording is the weighted sum of several IMUs, its members: what each of them measured by itself, in means over
/// blocks, in the sensor's axes, in which the error model's shares are (a recording may have been turned to body axes since).
struct MemberBlocks {
  struct Means {
    Eigen::Vector3d gyro;   ///< rad/s
    Eigen::Vector3d accel;  ///< m/s^2
  };
  struct Block {
    geo::GpsTime from, to;
    std::vector<std::optional<Means>> means;  ///< one per member; nothing where it may not be used all along
  };
  std::string source;  ///< file, for messages
  std::vector<std::string> names;
  std::vector<Block> blocks;  ///< in order, none over another
};

/// One IMU as recorded, in the sensor's own axes unless a function says otherwise. Strictly increasing in time.
struct ImuRecording {
  std::string source;  ///< file, for messages
  std::vector<ImuSample> samples;
  std::vector<float> temperature;  ///< degC, one per sample, or empty
  double rate_hz = 0.0;            ///< samples over the time without gaps
  std::vector<NoiseLevel> noise;   ///< in order, one where the other ends; empty: the same all the time
  MemberBlocks members;            ///< of a synthetic IMU whose members are told apart; empty otherwise
  Events events;                   ///< repairs and gaps found on reading
};

}  // namespace coast::record
