#pragma once
// The functions that make the effects of converters, one file each, and what they share; private to the room.

#include "coast/diagnose/correction.hpp"
#include "coast/diagnose/sample_effect.hpp"
#include "coast/noise/error_model.hpp"

namespace coast::diagnose {

SampleEffect quantisation(Site site);
SampleEffect saturation(Site site);

/// A stretch in which an axis has more white noise than the model says.
struct RaisedNoise {
  geo::GpsTime from, to;
  double density = 0.0;  ///< in addition, [signal]^2/Hz
};
/// Raises the level of one axis on top of what the recording has. @param stretches  in order, none over another
void raise_noise(MissionInput& input, Site site, int axis, const std::vector<RaisedNoise>& stretches);

[[nodiscard]] inline noise::Sensor sensor_of(Site site) {
  return site == Site::kGyro ? noise::Sensor::kGyro : noise::Sensor::kAccel;
}

}  // namespace coast::diagnose
