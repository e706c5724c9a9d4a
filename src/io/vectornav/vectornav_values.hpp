#pragma once
// Values of several fields of VectorNav messages. Private to the room.

#include <Eigen/Core>

#include "../binary.hpp"
#include "../frames/frame_stream.hpp"
#include "coast/geo/time.hpp"
#include "vectornav_message.hpp"

namespace coast::io {

/// Three numbers of a field.
template <class T>
Eigen::Vector3d vector_at(std::string_view field, std::size_t offset = 0) {
  return {static_cast<double>(number_at<T>(field, offset)), static_cast<double>(number_at<T>(field, offset + sizeof(T))),
          static_cast<double>(number_at<T>(field, offset + 2 * sizeof(T)))};
}

/// GPS time of the measurement: TimeGps of the time group or the common one, else TimeGpsTow with TimeGpsWeek. None while
/// TimeStatus says that they are not valid, or without such a field.
[[nodiscard]] std::optional<geo::GpsTime> measurement_time(const VectorNavMessage& message);
/// A week and nanoseconds of it.
[[nodiscard]] std::optional<geo::GpsTime> week_and_nanoseconds(std::uint16_t week, std::uint64_t nanoseconds);

/// ECEF, m: PosLla, else PosEcef, of a GNSS group; none where it is not on the Earth.
[[nodiscard]] std::optional<Eigen::Vector3d> vectornav_position(const VectorNavMessage& message, VectorNavGroup group);
/// Of either receiver, else of the sensor's own filter.
[[nodiscard]] std::optional<Eigen::Vector3d> vectornav_position(const VectorNavMessage& message);

/// Damage of the file, and messages between that are no binary output.
[[nodiscard]] record::Events vectornav_file_events(const FrameCensus& census, const std::string& file);

}  // namespace coast::io
