#pragma once
// Terrestrial reference frames: a position given in one frame at one epoch, brought to another frame and epoch.
// For the coordinates of a GNSS base station, which move by centimetres a year and differ by up to metres between frames.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace coast::geo {

/// A frame by name and the epoch at which coordinates in it hold.
struct FrameEpoch {
  std::string frame;  ///< one of `frames()`; case and spaces do not matter
  double year;        ///< decimal year, e.g. 2010.0 for 1 January 2010; 1980 to 2100
};

/// Every name understood, frames first, then other names of the same frames:
///
/// - ITRF2020 to ITRF92: the parameters that the ITRS Centre publishes from ITRF2020 to each;
/// - ETRF2020, ETRF2014, ETRF2000: EUREF Technical Note 1 (Altamimi 2018; 2024 for ETRF2020);
/// - NAD83(2011), NAD83(PA11), NAD83(MA11) of the NGS; NAD83(CSRS) has the parameters of NAD83(2011);
/// - GDA2020: ICSM, GDA2020 Technical Manual;
/// - IGS20, IGb20, IGS14, ...: the IGS aligns each to the ITRF of that year. The alignment is of the whole network: a single
///   station differs by millimetres, and by more where its antenna was calibrated anew between the two;
/// - WGS84(G2296), (G2139), (G1762), (G1674), (G1150): each taken for the ITRF that it was aligned to, which holds within some
///   centimetres. WGS84 without a realisation is taken for ITRF2020, to which it has been aligned since January 2024; where
///   in truth an older one was meant, that is wrong by up to 1 cm (G1674, G1762, G2139) or 6 cm (G1150).
///
/// ETRS89 and NAD83 alone are left out on purpose: which realisation is meant matters by several centimetres.
[[nodiscard]] std::vector<std::string> frames();

/// The frame that a name stands for ("igs14" is "ITRF2014"); nothing where the name is unknown.
[[nodiscard]] std::optional<std::string> frame_of(std::string_view name);

/// The position at `to` of a point given at `from`. In the source frame the point first moves with its velocity; the result
/// then goes over to the target frame, at the target epoch, by 14-parameter similarities in the convention of the IERS
/// (position vector; IERS Conventions 2010, chapter 4):
///
///     r' = r + T + D r + R x r,    each of T, D and R = value + rate (t - t0)
///
/// The way back is its exact inverse, not the negated parameters. Frames are joined over ITRF2020; the ITRS Centre's tables
/// between two older ones are the same sums.
///
/// @param r             position, ECEF of `from.frame`, m
/// @param from          frame and epoch of r
/// @param to            frame and epoch wanted
/// @param velocity_mpy  velocity of the point in `from.frame`, m/year: from the station's sheet, or `plate_velocity`. Motion
///                      that is not linear (earthquakes and what follows them, seasons) is not in it
/// @return              position, ECEF of `to.frame`, m
/// @throws std::invalid_argument  a name is unknown (the message names the nearest), or a year outside 1980 to 2100
/// @note  There and back to 1e-9 m (two roundings). Accuracy is that of the parameters: rates printed to 0.1 mm/year and
///        0.02 mas/year, which run for decades from the oldest frames; EPSG states 3 cm for GDA2020. Where the ground deforms
///        (NAD83 in the west, ETRF in the Aegean) the velocity must come from the station.
/// @see   Altamimi et al. (2023), J. Geodesy 97:47, for ITRF2020; the sources of each row stand in reference_frame.cpp
[[nodiscard]] Eigen::Vector3d transform(const Eigen::Vector3d& r, const FrameEpoch& from, const FrameEpoch& to,
                                        const Eigen::Vector3d& velocity_mpy);

/// A velocity given in frame `from`, in frame `to`: v' = v + dT/dt + dD/dt r + dR/dt x r. The Eurasian plate moves by 25
/// mm/year in ITRF2020 and rests within 1 mm/year in ETRF2020.
/// @param velocity_mpy  m/year
/// @param r             where, ECEF of either frame, m
/// @throws std::invalid_argument  a name is unknown
/// @note  What is neglected is (D + R) v, below 1e-7 m/year for any plate.
[[nodiscard]] Eigen::Vector3d velocity_in_frame(const Eigen::Vector3d& velocity_mpy, const Eigen::Vector3d& r,
                                                std::string_view from, std::string_view to);

/// Plates that `plate_velocity` knows, by the four letters of the ITRF2020 plate motion model: AMUR, ANTA, ARAB, AUST, CARB,
/// EURA, INDI, NAZC, NOAM, NUBI, PCFC, SOAM, SOMA.
[[nodiscard]] std::vector<std::string> plates();

/// Velocity of a point that rides on a rigid plate: ITRF2020 plate motion model, with its origin rate bias and without the
/// vertical component, as its authors advise. Fits the velocities in the middle of plates to 0.25 mm/year (their WRMS); near
/// a plate's edge, or where the ground rises after the ice, it is not valid.
///
/// @param plate  one of `plates()`; case does not matter
/// @param r      where, ECEF, m
/// @param frame  frame that the velocity is wanted in, one of `frames()`
/// @return       m/year; nothing where the plate is unknown
/// @throws std::invalid_argument  the frame is unknown
/// @see   Altamimi et al. (2023), Geophys. Res. Lett. 50, e2023GL106373, tables 1 and 2
[[nodiscard]] std::optional<Eigen::Vector3d> plate_velocity(std::string_view plate, const Eigen::Vector3d& r,
                                                            std::string_view frame = "ITRF2020");

}  // namespace coast::geo
