#pragma once
// Instants of outside events from files of receivers.

#include <filesystem>

#include "coast/record/time_mark.hpp"

namespace coast::io {

/// Reads UBX-TIM-TM2 of a u-blox receiver: both edges, in GPS time. Marks without valid time, or in the receiver's own time,
/// are counted and left out, with an event.
/// @throws InputError  not a UBX file, or no mark that can be used
[[nodiscard]] record::TimeMarkRecording read_time_marks(const std::filesystem::path& file);

}  // namespace coast::io
