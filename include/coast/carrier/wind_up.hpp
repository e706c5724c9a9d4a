#pragma once
// Circular polarisation: a turn of either antenna about the line of sight is a cycle of phase.

#include <Eigen/Core>

namespace coast::carrier {

/// Phase wind-up, cycles: what polarisation adds to a phase of RINEX, which grows with the distance (observed = distance over
/// wavelength + ambiguity + wind-up). Wu et al. (1993): the angle about the line of sight from the effective dipole of the
/// satellite, which steers its yaw, to that of the receiver, the same on all frequencies.
///
/// The receiver's antenna has its dipoles along forward and left of b, x and -y, and looks up, -z; one that turns clockwise
/// seen from above, to larger yaw, winds up.
///
/// @param r_satellite_e, r_sun_e, r_receiver_e  ECEF at one instant, m; of the Sun the direction is enough
/// @param C_b_e     attitude of the antenna, forward-right-down to ECEF
/// @param previous  wind-up at the epoch before, 0 at the start of an arc: of all values a cycle apart the nearest is returned,
///                  so that no turn is lost as long as there is less than half of one between epochs
/// @note  Undefined for a satellite right behind the antenna, along z; with the Sun on the line through satellite and geocentre
///        a whole number.
[[nodiscard]] double wind_up(const Eigen::Vector3d& r_satellite_e, const Eigen::Vector3d& r_sun_e,
                             const Eigen::Vector3d& r_receiver_e, const Eigen::Matrix3d& C_b_e, double previous);

/// What is left of a rover's wind-up in differences to a base that stands upright, cycles, -0.5 to 0.5: how much more than the
/// same antenna it is wound up that has been set upright by the shortest way. The satellite's part is the same at both ends. A
/// turn about the vertical is the same for all satellites and left out: it is the business of whoever eliminates clocks. At 15,
/// 30, 45 degrees of bank satellites differ by 0.014, 0.029, 0.046 cycles (rms).
/// @param to_satellite_e, up_e  unit vectors  @param C_b_e  attitude of the antenna; not upside down
[[nodiscard]] double wind_up_by_tilt(const Eigen::Vector3d& to_satellite_e, const Eigen::Vector3d& up_e,
                                     const Eigen::Matrix3d& C_b_e);

}  // namespace coast::carrier
