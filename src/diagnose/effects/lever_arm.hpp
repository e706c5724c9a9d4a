#pragma once
// Effect of a shift of the antenna on the body on positions and velocities; private to the room.

#include "effects.hpp"

namespace coast::diagnose {

void lever_arm_position(const FixSignals& s, Columns D);
void lever_arm_velocity(const FixSignals& s, Columns D);

}  // namespace coast::diagnose
