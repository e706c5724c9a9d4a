#pragma once
// Effect of a shift of the GNSS time on positions and velocities; private to the room.

#include "effects.hpp"

namespace coast::diagnose {

void time_offset_position(const FixSignals& s, Columns D);
void time_offset_velocity(const FixSignals& s, Columns D);

}  // namespace coast::diagnose
