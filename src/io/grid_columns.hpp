#pragma once
// Columns of positions and attitudes in a projected CRS. Private to the room.

#include <string>

#include "coast/geo/rotation.hpp"
#include "coast/io/projection.hpp"
#include "coast/record/trajectory.hpp"
#include "text_buffer.hpp"

namespace coast::io {

/// "easting_m,northing_m,height_m"
[[nodiscard]] std::string grid_place_columns(const Projection& projection);
/// "sd_easting_m,sd_northing_m,sd_height_m", in the units of the CRS
[[nodiscard]] std::string grid_sd_columns(const Projection& projection);
inline constexpr std::string_view kGridHeadingColumns = "convergence_deg,heading_true_deg,heading_grid_deg";

/// North-east-down to axes of the grid: to grid north, to grid east, down.
[[nodiscard]] Eigen::Matrix3d C_n_g(double convergence);
/// [0, 360) deg
[[nodiscard]] double heading_deg(double yaw);

/// ",easting,northing,height" to 0.01 mm.
void put_grid_place(TextBuffer& text, const Projection& projection, const Eigen::Vector3d& r_e, geo::GpsTime t);
/// ",convergence,true heading,grid heading"
void put_grid_heading(TextBuffer& text, double convergence, double yaw);
/// ",sd,sd,sd"
void put_grid_sd(TextBuffer& text, const Projection& projection, double convergence, const Eigen::Matrix3d& cov_n);

}  // namespace coast::io
