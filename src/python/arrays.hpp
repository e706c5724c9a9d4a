#pragma once
// Results as numpy arrays. Times are integer nanoseconds of GPS time since 1980-01-06.

#include <pybind11/pybind11.h>

#include "coast/jobs/process.hpp"

namespace coast::python {

/// time_ns, latitude and longitude (deg), height (m), velocity_n (m/s), attitude (roll, pitch, yaw, deg); sd_position_n (m),
/// sd_velocity_n (m/s), sd_attitude (deg). Vectors are n x 3.
[[nodiscard]] pybind11::dict trajectory_arrays(const std::vector<record::TrajectoryEpoch>& epochs);

/// time_ns, kind, used, dof, innovation and sd (n x 3), nis
[[nodiscard]] pybind11::dict innovation_arrays(const std::vector<estimate::InnovationRecord>& innovations);

/// By the name of the state: seconds, forward, forward_sd, smoothed, smoothed_sd.
[[nodiscard]] pybind11::dict state_arrays(const std::vector<jobs::StateTrack>& states);

}  // namespace coast::python
