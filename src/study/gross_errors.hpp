#pragma once
// Fixes that no vehicle can have been at.

#include "coast/record/event.hpp"
#include "coast/record/gnss.hpp"

namespace coast::study {

/// Leaves out single fixes that lie off the line between their neighbours by more than an acceleration of 30 m/s^2 and six of
/// their sigmas explain, the farthest first; an event counts them. They would spoil the alignment and every fit of noise, which
/// work without a gate. Jumps that stay are no single fixes and stay.
void leave_out_gross_errors(record::GnssRecording& gnss, record::Events& events);

}  // namespace coast::study
