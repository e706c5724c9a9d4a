#pragma once
// Usual names of findings; private to the room.

#include "search/state.hpp"

namespace coast::diagnose {

/// A relation with the signals of an effect of the catalogue, which was not selected because its size is implausible,
/// gets that effect's name.
void name_relations(const State& state, std::vector<Finding>& findings);

/// An effect cancelled later by an equal jump of opposite sign lasted until then: a wrong fix.
void join_entries_with_exits(std::vector<Finding>& findings);

/// All times of an effect that repeats are one finding: the first one, with the others as its further times.
/// @param findings  in order of decreasing gain
void join_times(std::vector<Finding>& findings);

/// Converts sine and cosine to amplitude and phase. The effects for these are appended to `suggested`.
void join_quadratures(std::vector<Finding>& findings, std::vector<EffectPtr>& suggested);

/// Assigns noise of an axis that a converter's mark explains to the mark.
void fold_residues(Account& account);

}  // namespace coast::diagnose
