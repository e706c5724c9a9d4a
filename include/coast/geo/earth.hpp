#pragma once
// WGS 84: positions, local frames, gravity. Uses GeographicLib; no geoid or gravity grids.

#include <Eigen/Core>

namespace coast::geo {

inline constexpr double kEarthRate = 7.292115e-5;  ///< rad/s, WGS 84

/// Latitude, longitude, ellipsoidal height. A struct, not a vector: the units differ.
struct Geodetic {
  double latitude = 0.0;   ///< rad, [-pi/2, pi/2]
  double longitude = 0.0;  ///< rad, (-pi, pi]
  double height = 0.0;     ///< m above the WGS 84 ellipsoid
};

/// Position in ECEF [m]. Round trip with `geodetic_from_ecef` below 1e-8 m to 1000 km height, poles included.
[[nodiscard]] Eigen::Vector3d ecef_from_geodetic(const Geodetic& p);
[[nodiscard]] Geodetic geodetic_from_ecef(const Eigen::Vector3d& r_e);
/// C_n_e: north-east-down at p to ECEF. At a pole, north is defined by the given longitude.
[[nodiscard]] Eigen::Matrix3d C_n_e(const Geodetic& p);

/// Radii of curvature [m]: meridian M and prime vertical N.
struct Radii {
  double meridian;
  double prime_vertical;
};
[[nodiscard]] Radii radii_of_curvature(double latitude);

/// Normal gravity of WGS 84 (including centrifugal acceleration), resolved in e [m/s^2], any height.
[[nodiscard]] Eigen::Vector3d gravity_e(const Eigen::Vector3d& r_e);

/// Normal gravity near a point: value and gradient come from `gravity_e` and are recomputed when the point has moved more than
/// 50 m, so that the strapdown needs only a 3x3 product per sample. Agrees with `gravity_e` to 1e-8 m/s^2.
class LocalGravity {
 public:
  [[nodiscard]] const Eigen::Vector3d& at(const Eigen::Vector3d& r_e);
  /// Gradient dg/dr [1/s^2] used at the last point.
  [[nodiscard]] const Eigen::Matrix3d& gradient() const { return gradient_; }

 private:
  Eigen::Vector3d r0_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d g0_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d g_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d gradient_ = Eigen::Matrix3d::Zero();
};

/// Local north-east-down frame with a fixed origin: for files in local coordinates and for errors in metres.
class LocalFrame {
 public:
  explicit LocalFrame(const Geodetic& origin);
  [[nodiscard]] Eigen::Vector3d to_ned(const Eigen::Vector3d& r_e) const { return C_n_e_.transpose() * (r_e - origin_e_); }
  [[nodiscard]] Eigen::Vector3d to_ecef(const Eigen::Vector3d& ned) const { return origin_e_ + C_n_e_ * ned; }
  [[nodiscard]] const Eigen::Matrix3d& rotation() const { return C_n_e_; }

 private:
  Eigen::Vector3d origin_e_;
  Eigen::Matrix3d C_n_e_;
};

/// Geodetic from UTM (northern or southern), for tables in UTM.  @throws std::invalid_argument zone outside 1..60
[[nodiscard]] Geodetic geodetic_from_utm(int zone, bool northern, double easting, double northing, double height);

}  // namespace coast::geo
