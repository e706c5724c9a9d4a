#pragma once
// `events` of a run file: instants of a camera or another device.

#include "coast/jobs/run_file.hpp"

namespace coast::jobs {

/// events: {file: images.csv, delay_s: 0.012, camera: {lever_arm_m: [..], boresight_deg: [roll, pitch, yaw]}, ..}
/// @throws InputError  a key that is missing, unknown or out of range; with file and line
[[nodiscard]] EventOptions read_events(const config::Node& events);

/// Reads the marks; one without a name is called by its number, counted from 1 in the order of time.
/// @param near  an instant of the mission
/// @throws InputError  as io::read_time_marks
[[nodiscard]] record::TimeMarkRecording read_named_marks(const EventOptions& events, geo::GpsTime near);

}  // namespace coast::jobs
