#pragma once
// What is read of bags. Private to the room.

#include "bag_stream.hpp"
#include "coast/io/registry.hpp"

namespace coast::io {

[[nodiscard]] record::ImuRecording read_bag_imu(OpenBag open, const ImuFileOptions& options, Format::Near near);
[[nodiscard]] record::GnssRecording read_bag_gnss(OpenBag open, const GnssFileOptions& options, Format::Near near);
[[nodiscard]] record::Trajectory read_bag_reference(OpenBag open, const ReferenceFileOptions& options, Format::Near near);

}  // namespace coast::io
