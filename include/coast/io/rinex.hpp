#pragma once
// RINEX: observations and broadcast navigation messages, versions 2.1x, 3.0x and 4.0x (IGS/RTCM RINEX WG: RINEX 2.11, 3.05,
// 4.01). Files may be gzip-compressed; observation files also Hatanaka-compressed (Hatanaka 2008: CRINEX 1.0 and 3.0). The same
// functions read files of receivers (registry.hpp), recognised by their content.

#include <filesystem>
#include <optional>
#include <vector>

#include "coast/record/navigation.hpp"
#include "coast/record/observation.hpp"

namespace coast::io {

/// Signals have RINEX 3 names; RINEX 2 types are mapped to them (P2 and L2 are tracked as W, or P of GLONASS). Epochs are
/// converted from the time scale of TIME OF FIRST OBS to GPS time. A zero or blank is a missing measurement. Counted and left
/// out, with an event: numbers that cannot be read or are impossible, satellites that occur twice in an epoch, epochs that
/// repeat or go back in time, an epoch cut off by the end of the file, cycle-slip records. A power failure (flag 1) is a loss
/// of lock of all signals. UBX: those of UBX-RXM-RAWX; a loss of lock where the time of lock is shorter than before, or than
/// the interval, or where half a cycle has been resolved.
/// RTCM 3: MSM4 to MSM7, 1002, 1004, 1010, 1012, all messages of one time as one epoch; a loss of lock where the time of lock
/// is shorter than before, or than the interval.
/// @param near  GPS time less than half a week from the first epoch, for files that do not state the week (RTCM 3)
/// @throws InputError  not a RINEX observation file, an incomplete header, an epoch line that cannot be read, with line; a file
///                     of a receiver without observations, or without a message that states the week where `near` is not given
[[nodiscard]] record::ObservationRecording read_observations(const std::filesystem::path& file,
                                                             std::optional<geo::GpsTime> near = std::nullopt);

/// Every ephemeris of GPS (LNAV), Galileo (I/NAV and F/NAV), BeiDou (D1, D2), QZSS, GLONASS and SBAS. Messages that the orbit
/// computation does not support (CNAV, NavIC, system time) are counted, repeated ones are kept once, impossible ones (an
/// eccentricity above 0.5, an orbit below the ground) are left out and counted. UBX: LNAV, I/NAV, F/NAV,
/// GLONASS and D1, D2 of BeiDou of UBX-RXM-SFRBX. RTCM 3: 1019, 1020, 1042, 1044, 1045, 1046.
/// @throws InputError  not a RINEX navigation file, or nothing in it that can be used; a file of a receiver without navigation
///                     messages, or without a message that states the week
[[nodiscard]] record::NavigationRecording read_navigation(const std::filesystem::path& file);
/// Joins several files, e.g. one per system or one per day. The ionosphere model is that of the first file.
/// @throws InputError  as above, for any of them
[[nodiscard]] record::NavigationRecording read_navigation(const std::vector<std::filesystem::path>& files);
/// Half way from the first ephemeris to the last: a time that decides between weeks. None without ephemerides.
[[nodiscard]] std::optional<geo::GpsTime> middle_of(const record::NavigationRecording& navigation);

/// RINEX versions for writing: 3.05 and 4.01.
enum class RinexVersion { kThree, kFour };

/// Observations in GPS time; a signal's code, phase, Doppler and C/N0 if any of its observations has them. Repairs made when
/// the recording was read are kept.
/// @throws OutputError
void write_observations(const std::filesystem::path& file, const record::ObservationRecording& recording,
                        RinexVersion version = RinexVersion::kThree);
/// @throws OutputError
void write_navigation(const std::filesystem::path& file, const record::NavigationRecording& navigation,
                      RinexVersion version = RinexVersion::kThree);

}  // namespace coast::io
