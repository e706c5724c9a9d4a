#pragma once
// What was found on blocks that its sizes were not estimated from; private to the room.

#include "search.hpp"

namespace coast::diagnose {

struct Verification {
  HeldOut all;
  struct Effect {
    double gain = 0.0;    ///< the others in
    double better = 0.0;  ///< share of the blocks
    int blocks = 0;
    bool begins = false;  ///< at some time, not with the mission
    [[nodiscard]] bool holds() const;
  };
  std::vector<Effect> effects;  ///< as they were taken
};
/// Two folds of alternating blocks: sizes from the score and information of one, likelihood on the other.
[[nodiscard]] Verification verify(const Search& search);

/// Of what was taken the one without which artificial outages drift least, where with all of it they drift farther than with
/// nothing: it explains fixes by what the sensors did not do.
/// @return  its index
[[nodiscard]] std::optional<std::size_t> what_spoils_outages(const Search& search);

}  // namespace coast::diagnose
