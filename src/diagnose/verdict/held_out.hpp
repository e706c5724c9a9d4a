#pragma once
// Detected effects on blocks not used to estimate their sizes; private to the room.

#include <vector>

#include "search/state.hpp"

namespace coast::diagnose {

struct Verification {
  HeldOut all;
  struct Effect {
    std::size_t first = 0;  ///< first of the coefficients selected together
    std::size_t count = 1;
    double gain = 0.0;    ///< with the other effects
    double better = 0.0;  ///< fraction of the blocks
    int blocks = 0;
    bool begins = false;  ///< at some time, not with the mission
    [[nodiscard]] bool holds() const;
  };
  std::vector<Effect> effects;  ///< in their order
  /// The one with the worst result; null if all hold.
  [[nodiscard]] const Effect* worst() const;
};
/// Two folds of alternating blocks: sizes from the score and information of one, likelihood on the other.
[[nodiscard]] Verification verify(const State& state, const Context& context);

}  // namespace coast::diagnose
