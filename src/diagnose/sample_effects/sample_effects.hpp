#pragma once
// The functions that create the effects of converters, one file each, and shared functions; private to the room.

#include "coast/diagnose/correction.hpp"
#include "coast/diagnose/sample_effect.hpp"
#include "coast/noise/error_model.hpp"

namespace coast::diagnose {

SampleEffect quantisation(Site site);
SampleEffect saturation(Site site);

/// A stretch in which an axis has more white noise than in the model.
struct RaisedNoise {
  geo::GpsTime from, to;
  double density = 0.0;  ///< additional, [signal]^2/Hz
};
/// Raises the noise level of one axis above that of the recording. @param stretches  in order, without overlap
void raise_noise(MissionInput& input, Site site, int axis, const std::vector<RaisedNoise>& stretches);

[[nodiscard]] inline noise::Sensor sensor_of(Site site) {
  return site == Site::kGyro ? noise::Sensor::kGyro : noise::Sensor::kAccel;
}

}  // namespace coast::diagnose
