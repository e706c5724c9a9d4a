#pragma once
// Phase wind-up by circular polarisation: a turn of either antenna about the line of sight is a cycle of phase.

#include <Eigen/Core>

namespace coast::carrier {

/// Phase wind-up, cycles, with the RINEX sign of phase (observed = distance over wavelength + ambiguity + wind-up). Wu et al.
/// (1993): the angle about the line of sight from the effective dipole of the yaw-steering satellite to that of the receiver,
/// the same on all frequencies.
///
/// The receiver's antenna has its dipoles along forward and left of b, x and -y, and its boresight up, -z; a clockwise turn
/// seen from above, to larger yaw, increases the wind-up.
///
/// @param r_satellite_e, r_sun_e, r_receiver_e  ECEF at one instant, m; for the Sun the direction is enough
/// @param C_b_e     attitude of the antenna, forward-right-down to ECEF
/// @param previous  wind-up at the previous epoch, 0 at the start of an arc; the returned value is the nearest to it modulo one
///                  cycle, so that whole turns are counted correctly if the change between epochs is less than half a turn
/// @note  Undefined for a satellite exactly opposite to the boresight, along z; a whole number if the Sun is on the line
///        through satellite and geocentre.
[[nodiscard]] double wind_up(const Eigen::Vector3d& r_satellite_e, const Eigen::Vector3d& r_sun_e,
                             const Eigen::Vector3d& r_receiver_e, const Eigen::Matrix3d& C_b_e, double previous);

/// Residual wind-up of a rover in differences to an upright base, cycles, -0.5 to 0.5: the wind-up minus that of the same
/// antenna rotated upright by the smallest angle. The satellite's part is the same at both ends. A turn about the vertical is
/// the same for all satellites and not included: it is absorbed by the receiver clock. At 15, 30, 45 degrees of bank satellites
/// differ by 0.014, 0.029, 0.046 cycles (rms).
/// @param to_satellite_e, up_e  unit vectors  @param C_b_e  attitude of the antenna; not upside down
[[nodiscard]] double wind_up_by_tilt(const Eigen::Vector3d& to_satellite_e, const Eigen::Vector3d& up_e,
                                     const Eigen::Matrix3d& C_b_e);

}  // namespace coast::carrier
