#pragma once
// Results as numpy arrays. Times are integer nanoseconds of GPS time since 1980-01-06.

#include <pybind11/pybind11.h>

#include "coast/jobs/process.hpp"

namespace coast::python {

/// time_ns, latitude and longitude (deg), height (m), velocity_n (m/s), attitude (roll, pitch, yaw, deg); sd_position_n (m),
/// sd_velocity_n (m/s), sd_attitude (deg). Vectors are n x 3.
[[nodiscard]] pybind11::dict trajectory_arrays(const std::vector<record::TrajectoryEpoch>& epochs);

/// time_ns, r_eb_e (m), v_eb_e (m/s), C_b_e (n x 9, row by row), latitude and longitude (deg), height (m), velocity_n (m/s),
/// attitude (roll, pitch, yaw, deg).
[[nodiscard]] pybind11::dict state_arrays(const std::vector<record::NavState>& states);

/// time_ns of the end of each interval, dt (s), dtheta (rad), dv (m/s).
[[nodiscard]] pybind11::dict imu_arrays(const record::ImuRecording& imu);

/// time_ns, r_ea_e (m), sd_position_n (m), quality (as RTKLIB numbers it), satellites (0 where unknown).
[[nodiscard]] pybind11::dict fix_arrays(const record::GnssRecording& gnss);

/// time_ns, kind, used, dof, innovation and sd (n x 3), nis
[[nodiscard]] pybind11::dict innovation_arrays(const std::vector<estimate::InnovationRecord>& innovations);

/// By the name of the state: seconds, forward, forward_sd, smoothed, smoothed_sd.
[[nodiscard]] pybind11::dict track_arrays(const std::vector<jobs::StateTrack>& states);

}  // namespace coast::python
