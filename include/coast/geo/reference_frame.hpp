#pragma once
// Terrestrial reference frames: transforms a position from one frame and epoch to another frame and epoch. For the coordinates
// of a GNSS base station, which move by centimetres a year and differ by up to metres between frames.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace coast::geo {

/// Name of a frame, and the epoch of the coordinates in it.
struct FrameEpoch {
  std::string frame;  ///< one of `frames()`; case and spaces do not matter
  double year;        ///< decimal year, e.g. 2010.0 for 1 January 2010; 1980 to 2100
};

/// Every accepted name, frames first, then other names of the same frames:
///
/// - ITRF2020 to ITRF92: the parameters that the ITRS Centre publishes from ITRF2020 to each;
/// - ETRF2020, ETRF2014, ETRF2000: EUREF Technical Note 1 (Altamimi 2018; 2024 for ETRF2020);
/// - NAD83(2011), NAD83(PA11), NAD83(MA11) of the NGS; NAD83(CSRS) has the parameters of NAD83(2011);
/// - GDA2020: ICSM, GDA2020 Technical Manual;
/// - IGS20, IGb20, IGS14, ...: the IGS aligns each to the ITRF of that year. The alignment is of the whole network: a single
///   station differs by millimetres, and by more if its antenna was recalibrated between the two;
/// - WGS84(G2296), (G2139), (G1762), (G1674), (G1150): each treated as the ITRF that it was aligned to, correct to some
///   centimetres. WGS84 without a realisation is treated as ITRF2020, to which it has been aligned since January 2024; if an
///   older one was meant, the error is up to 1 cm (G1674, G1762, G2139) or 6 cm (G1150).
///
/// ETRS89 and NAD83 without a realisation are not accepted: realisations differ by several centimetres.
[[nodiscard]] std::vector<std::string> frames();

/// The frame that a name denotes ("igs14" is "ITRF2014"); nothing if the name is unknown.
[[nodiscard]] std::optional<std::string> frame_of(std::string_view name);

/// Transforms a position from `from` to `to`. In the source frame the point first moves with its velocity to the target epoch;
/// the result is then transformed to the target frame by 14-parameter similarities in the IERS convention (position vector;
/// IERS Conventions 2010, chapter 4):
///
///     r' = r + T + D r + R x r,    each of T, D and R = value + rate (t - t0)
///
/// The reverse transformation is the exact inverse, not the negated parameters. Frames are connected through ITRF2020; the ITRS
/// Centre's tables between two older frames are the same sums.
///
/// @param r             position, ECEF of `from.frame`, m
/// @param from          frame and epoch of r
/// @param to            target frame and epoch
/// @param velocity_mpy  velocity of the point in `from.frame`, m/year: from the station's data sheet, or `plate_velocity`.
///                      Nonlinear motion (earthquakes, post-seismic and seasonal) is not included
/// @return              position, ECEF of `to.frame`, m
/// @throws std::invalid_argument  a name is unknown (the message names the nearest), or a year outside 1980 to 2100
/// @note  Transforming there and back returns r to 1e-9 m (two roundings). Accuracy is that of the parameters: rates printed to
///        0.1 mm/year and 0.02 mas/year, which run for decades from the oldest frames; EPSG states 3 cm for GDA2020. In
///        deforming areas (NAD83 in the west, ETRF in the Aegean) the station's own velocity is needed.
/// @see   Altamimi et al. (2023), J. Geodesy 97:47, for ITRF2020; the source of each row is given in reference_frame.cpp
[[nodiscard]] Eigen::Vector3d transform(const Eigen::Vector3d& r, const FrameEpoch& from, const FrameEpoch& to,
                                        const Eigen::Vector3d& velocity_mpy);

/// Transforms a velocity from frame `from` to frame `to`: v' = v + dT/dt + dD/dt r + dR/dt x r. The Eurasian plate moves by 25
/// mm/year in ITRF2020 and less than 1 mm/year in ETRF2020.
/// @param velocity_mpy  m/year
/// @param r             position, ECEF of either frame, m
/// @throws std::invalid_argument  a name is unknown
/// @note  (D + R) v is neglected: below 1e-7 m/year for any plate.
[[nodiscard]] Eigen::Vector3d velocity_in_frame(const Eigen::Vector3d& velocity_mpy, const Eigen::Vector3d& r,
                                                std::string_view from, std::string_view to);

/// Plates that `plate_velocity` accepts, by the four letters of the ITRF2020 plate motion model: AMUR, ANTA, ARAB, AUST, CARB,
/// EURA, INDI, NAZC, NOAM, NUBI, PCFC, SOAM, SOMA.
[[nodiscard]] std::vector<std::string> plates();

/// Velocity of a point on a rigid plate: ITRF2020 plate motion model, with its origin rate bias and without the vertical
/// component, as its authors advise. Fits velocities in plate interiors to 0.25 mm/year (WRMS given there); not valid near
/// plate boundaries or in areas of glacial isostatic adjustment.
///
/// @param plate  one of `plates()`; case does not matter
/// @param r      position, ECEF, m
/// @param frame  frame of the returned velocity, one of `frames()`
/// @return       m/year; nothing if the plate is unknown
/// @throws std::invalid_argument  the frame is unknown
/// @see   Altamimi et al. (2023), Geophys. Res. Lett. 50, e2023GL106373, tables 1 and 2
[[nodiscard]] std::optional<Eigen::Vector3d> plate_velocity(std::string_view plate, const Eigen::Vector3d& r,
                                                            std::string_view frame = "ITRF2020");

}  // namespace coast::geo
