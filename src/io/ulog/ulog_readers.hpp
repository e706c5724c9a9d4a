#pragma once
// Readers of what a flight log of PX4 holds. Private to the room; registered by formats/ulog.cpp.

#include "coast/io/registry.hpp"

namespace coast::io {

[[nodiscard]] record::ImuRecording read_ulog_imu(const ImuFileOptions& options, Format::Near near);
[[nodiscard]] record::GnssRecording read_ulog_gnss(const GnssFileOptions& options, Format::Near near);

}  // namespace coast::io
