#pragma once
// One function per format file in this folder; they are listed in src/io/registry.cpp.

#include "coast/io/registry.hpp"

namespace coast::io {

[[nodiscard]] Format rtcm3_format();
[[nodiscard]] Format ubx_format();
[[nodiscard]] Format sbf_format();
[[nodiscard]] Format ulog_format();
[[nodiscard]] Format rosbag_format();
[[nodiscard]] Format mcap_format();
[[nodiscard]] Format rosbag2_format();
[[nodiscard]] Format dataflash_format();
[[nodiscard]] Format vectornav_format();
[[nodiscard]] Format waypoint_imr_format();
[[nodiscard]] Format sbet_format();
[[nodiscard]] Format novatel_format();
[[nodiscard]] Format rtklib_pos_format();
[[nodiscard]] Format nav_format();
[[nodiscard]] Format kf_gins_format();
[[nodiscard]] Format csv_format();
[[nodiscard]] Format binary_format();

/// The head as lines without comments, split at white space, at most `most` rows; empty if a field is not a number.
[[nodiscard]] std::vector<std::vector<double>> numeric_rows(const FileHead& head, std::size_t most);

}  // namespace coast::io
