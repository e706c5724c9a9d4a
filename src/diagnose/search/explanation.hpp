#pragma once
// Assumed errors of a mission that are not in the configured model, as a value; private to the room.

#include <memory>
#include <optional>
#include <vector>

#include "coast/estimate/noise_fit.hpp"
#include "evidence/noise_scan.hpp"
#include "evidence/turn_on.hpp"

namespace coast::diagnose {

using ImuPtr = std::shared_ptr<const record::ImuRecording>;

/// Equal explanations linearised about the same run have the same run.
struct Explanation {
  ImuPtr imu;                                      ///< as recorded, or corrected for converters
  std::vector<SelectedEffect> effects;             ///< selected mean effects
  std::vector<EffectPtr> suggested;                ///< lines and relations, with columns after those of the catalogue
  std::optional<estimate::NoiseAdjustment> noise;  ///< of the stated noise
  std::vector<AddedNoise> random;                  ///< selected random effects
  /// Biases at the start of which another effect explains a part: they then have the error model's prior.
  std::vector<TurnOn> shared;

  [[nodiscard]] bool operator==(const Explanation& other) const;
  [[nodiscard]] std::size_t hash() const;
  [[nodiscard]] bool is_suggested(const Effect& effect) const;
  [[nodiscard]] bool is_shared(const TurnOn& bias) const;
  [[nodiscard]] Explanation with(const SelectedEffect& effect) const;
  /// @param count  number of effects from `first` on
  [[nodiscard]] Explanation without(std::size_t first, std::size_t count = 1) const;
  /// Adds the fitted noise and the random effects to the mission's model.
  void add_noise(MissionInput& input) const;
};

/// Combines two hashes.
[[nodiscard]] std::size_t combined(std::size_t a, std::size_t b);

}  // namespace coast::diagnose
