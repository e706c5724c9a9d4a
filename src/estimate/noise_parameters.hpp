#pragma once
// The free parameters of the noise; private to the room.

#include <array>
#include <vector>

#include "coast/estimate/noise_fit.hpp"

namespace coast::estimate {

/// The part of the noise affected by a parameter.
enum class NoisePart {
  kScaleHorizontal,
  kScaleVertical,
  kScaleVelocity,
  kCorrelatedHorizontal,
  kCorrelatedVertical,
  kCorrelatedTime,
  kGyroX,
  kGyroY,
  kGyroZ,
  kAccelX,
  kAccelY,
  kAccelZ,
  kCount
};
/// In the order of AxisNoise.
inline constexpr std::array kWhiteNoise{NoisePart::kGyroX,  NoisePart::kGyroY,  NoisePart::kGyroZ,
                                        NoisePart::kAccelX, NoisePart::kAccelY, NoisePart::kAccelZ};

/// One free parameter: its part and its bounds (natural units; the search uses logarithms).
struct NoiseParameter {
  NoisePart part;
  const char* name;
  double& (*value)(NoiseAdjustment&);
  double low;
  double high;
};

[[nodiscard]] std::vector<NoiseParameter> free_parameters(const NoiseFitChoice& choice, bool velocities);

}  // namespace coast::estimate
