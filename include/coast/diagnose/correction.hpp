#pragma once
// Recordings and setup corrected for detected effects.

#include <optional>
#include <vector>

#include "coast/diagnose/hypotheses.hpp"
#include "coast/diagnose/noise_effect.hpp"
#include "coast/diagnose/sample_effect.hpp"
#include "coast/study/mission.hpp"

namespace coast::diagnose {

/// A selected effect with its size.
struct SelectedEffect {
  Eigen::Index hypothesis = 0;
  std::optional<geo::GpsTime> from = {};  ///< if absent: the whole mission
  std::optional<geo::GpsTime> to = {};
  double value = 0.0;
  [[nodiscard]] bool holds(geo::GpsTime t) const { return (!from || t >= *from) && (!to || t < *to); }
  bool operator==(const SelectedEffect&) const = default;
};

/// The same as named in files, independent of a recording.
struct NamedEffect {
  const Effect* effect = nullptr;        ///< of the catalogue, or `suggested`; null for a random effect
  const NoiseEffect* noise = nullptr;    ///< random effect, added to the noise model; `value` is the root of its variance
  const SampleEffect* sample = nullptr;  ///< effect of a converter
  Eigen::Index axis = 0;
  double value = 0.0;
  std::optional<double> from_s;  ///< seconds of week
  std::optional<double> to_s;
  EffectPtr suggested = {};
};

/// Input of the filter.
struct MissionInput {
  record::ImuRecording imu;  ///< body axes
  record::GnssRecording gnss;
  study::Setup setup;
};

/// The input corrected for the effects. Effects that can be stated in the configuration, and that last the whole mission, are
/// corrected there.
/// @param path    trajectory at IMU epochs that gives rates, forces and directions; fixes outside it are not changed
/// @param layout  layout of the filter that computed the path
[[nodiscard]] MissionInput without(const std::vector<SelectedEffect>& effects, const MissionInput& input,
                                   const Hypotheses& hypotheses, const std::vector<record::NavState>& path,
                                   const estimate::Mission& mission, const estimate::StateLayout& layout);

/// The input corrected for named effects. Needs a filter run for the trajectory used in the correction.
/// @throws InputError  an effect that this recording does not support: no temperature
[[nodiscard]] MissionInput without(const std::vector<NamedEffect>& effects, const MissionInput& input,
                                   const study::Progress& progress);

}  // namespace coast::diagnose
