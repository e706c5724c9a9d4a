#pragma once
// Columns of trajectories and of events in CSV files. Private to the room.

#include <Eigen/Core>
#include <string_view>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/record/trajectory.hpp"
#include "text_buffer.hpp"

namespace coast::io {

/// Position, velocity and attitude as in files.
struct LocalState {
  geo::Geodetic p;
  Eigen::Vector3d v_eb_n;
  geo::Euler attitude;
};
[[nodiscard]] LocalState local_state(const record::NavState& nav);

inline constexpr std::string_view kTimeAndPlaceColumns = "gps_week,sow_s,lat_deg,lon_deg,height_m";
inline constexpr std::string_view kMotionColumns = "vn_mps,ve_mps,vd_mps,roll_deg,pitch_deg,yaw_deg";
inline constexpr std::string_view kCovarianceColumns =
    "sdn_m,sde_m,sdd_m,corr_ne,corr_nd,corr_ed,"
    "sdvn_mps,sdve_mps,sdvd_mps,corr_vn_ve,corr_vn_vd,corr_ve_vd,"
    "sd_roll_deg,sd_pitch_deg,sd_yaw_deg,corr_roll_pitch,corr_roll_yaw,corr_pitch_yaw";

/// ",value" with fixed decimals.
void put_column(TextBuffer& text, double value, int decimals);
/// Without a comma in front.
void put_time_and_place(TextBuffer& text, geo::GpsTime t, const geo::Geodetic& p);
void put_motion(TextBuffer& text, const LocalState& state);
void put_covariance(TextBuffer& text, const record::NavCovariance& cov, const geo::Euler& attitude);

}  // namespace coast::io
