#pragma once
// What was found on blocks that its sizes were not estimated from; private to the room.

#include "search.hpp"

namespace coast::diagnose {

struct Verification {
  HeldOut all;
  std::vector<double> gain;  ///< of each effect taken, the others in
};
/// Two folds of alternating blocks: sizes from the score and information of one, likelihood on the other.
[[nodiscard]] Verification verify(const Search& search);

}  // namespace coast::diagnose
