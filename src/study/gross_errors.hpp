#pragma once
// Fixes at positions that no vehicle can have.

#include "coast/record/event.hpp"
#include "coast/record/gnss.hpp"

namespace coast::study {

/// Omits single fixes that deviate from the line between their neighbours by more than an acceleration of 30 m/s^2 and six of
/// their sigmas explain, the largest deviation first; an event gives their number. They would spoil the alignment and all fits
/// of noise, which work without a gate. Permanent jumps are no single fixes and are kept.
void leave_out_gross_errors(record::GnssRecording& gnss, record::Events& events);

}  // namespace coast::study
