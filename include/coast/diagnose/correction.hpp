#pragma once
// Recordings and setup with found effects taken out.

#include <optional>
#include <vector>

#include "coast/diagnose/hypotheses.hpp"
#include "coast/diagnose/noise_effect.hpp"
#include "coast/diagnose/sample_effect.hpp"
#include "coast/study/mission.hpp"

namespace coast::diagnose {

/// A hypothesis taken for true, with its size.
struct Taken {
  Eigen::Index hypothesis = 0;
  std::optional<geo::GpsTime> from = {};  ///< the whole mission where absent
  std::optional<geo::GpsTime> to = {};
  double value = 0.0;
  [[nodiscard]] bool holds(geo::GpsTime t) const { return (!from || t >= *from) && (!to || t < *to); }
};

/// The same without a recording at hand: how files name it.
struct NamedEffect {
  const Effect* effect = nullptr;        ///< of the catalogue, or `suggested`; null: a random one
  const NoiseEffect* noise = nullptr;    ///< is added to the noise level; `value` is the root of its variance
  const SampleEffect* sample = nullptr;  ///< of a converter
  Eigen::Index axis = 0;
  double value = 0.0;
  std::optional<double> from_s;  ///< seconds of week
  std::optional<double> to_s;
  EffectPtr suggested = {};
};

/// What is filtered.
struct MissionInput {
  record::ImuRecording imu;  ///< body axes
  record::GnssRecording gnss;
  study::Setup setup;
};

/// The input as it would have been without the effects. Effects that the configuration has a place for, and that last the whole
/// mission, go there.
/// @param path    trajectory that rates, forces and directions are taken along, at IMU epochs; fixes outside it stay as they
/// are
/// @param layout  of the filter that made it
[[nodiscard]] MissionInput without(const std::vector<Taken>& taken, const MissionInput& input, const Hypotheses& hypotheses,
                                   const std::vector<record::NavState>& path, const estimate::Mission& mission,
                                   const estimate::StateLayout& layout);

/// The input without effects that somebody names. Takes a run for the trajectory that they are taken out along.
/// @throws InputError  an effect that this recording cannot have: no temperature
[[nodiscard]] MissionInput without(const std::vector<NamedEffect>& effects, const MissionInput& input,
                                   const study::Progress& progress);

}  // namespace coast::diagnose
