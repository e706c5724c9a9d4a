#pragma once
// RINEX: observations and broadcast navigation messages, versions 2.1x, 3.0x and 4.0x (IGS/RTCM RINEX WG: RINEX 2.11, 3.05,
// 4.01). Files may be gzip-compressed and, observations, Hatanaka-compressed (Hatanaka 2008: CRINEX 1.0 and 3.0).

#include <filesystem>
#include <vector>

#include "coast/record/navigation.hpp"
#include "coast/record/observation.hpp"

namespace coast::io {

/// Signals have the names of RINEX 3; those of a RINEX 2 file get what its own types imply (P2 and L2 are tracked as W, or P of
/// GLONASS). Epochs in the time scale of the file's TIME OF FIRST OBS become GPS time. A zero or blank is no measurement.
/// Counted and left out, with an event: numbers that cannot be read or cannot be, satellites that stand twice in an epoch,
/// epochs that repeat or go back, an epoch that the end of the file cuts off, cycle-slip records. A power failure (flag 1) is a
/// loss of lock of all signals.
/// @throws InputError  no RINEX observation file, a header without what is needed, an epoch line that cannot be read; with line
[[nodiscard]] record::ObservationRecording read_observations(const std::filesystem::path& file);

/// Every ephemeris of GPS (LNAV), Galileo (I/NAV and F/NAV), BeiDou (D1, D2), QZSS, GLONASS and SBAS. Messages that the orbit
/// computation does not know (CNAV, NavIC, system time) are counted, repeated ones are kept once, impossible ones (an
/// eccentricity above 0.5, an orbit below the ground) are left out and counted.
/// @throws InputError  no RINEX navigation file, or nothing in it that can be used
[[nodiscard]] record::NavigationRecording read_navigation(const std::filesystem::path& file);
/// Several files as one: one of each system, one of each day. The first file's ionosphere stands.
/// @throws InputError  as above, of any of them
[[nodiscard]] record::NavigationRecording read_navigation(const std::vector<std::filesystem::path>& files);

/// Versions of RINEX that are written: 3.05 and 4.01.
enum class RinexVersion { kThree, kFour };

/// Observations in GPS time; a signal's code, phase, Doppler and C/N0 where any of its observations has them. What was
/// repaired when the recording was read stays repaired.
/// @throws OutputError
void write_observations(const std::filesystem::path& file, const record::ObservationRecording& recording,
                        RinexVersion version = RinexVersion::kThree);
/// @throws OutputError
void write_navigation(const std::filesystem::path& file, const record::NavigationRecording& navigation,
                      RinexVersion version = RinexVersion::kThree);

}  // namespace coast::io
