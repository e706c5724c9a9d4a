#pragma once
// What is read of DataFlash logs. Private to the room.

#include "coast/io/registry.hpp"

namespace coast::io {

[[nodiscard]] record::ImuRecording read_dataflash_imu(const ImuFileOptions& options, Format::Near near);
[[nodiscard]] record::GnssRecording read_dataflash_gnss(const GnssFileOptions& options, Format::Near near);

}  // namespace coast::io
