#pragma once
// Checks and order of broadcast ephemerides, whatever they were read from. Private to the room.

#include "coast/record/navigation.hpp"

namespace coast::io {

/// An orbit of a navigation satellite: above the ground, below 64 000 km, eccentricity below 0.5, all elements finite.
[[nodiscard]] bool is_possible(const record::KeplerEphemeris& ephemeris);
[[nodiscard]] bool is_possible(const record::TabulatedEphemeris& ephemeris);

/// The instant with this second of week that is nearest to another.
[[nodiscard]] geo::GpsTime nearest_second_of_week(geo::GpsTime to, double sow);

/// Nominal value of the user range accuracy index of GPS, QZSS and BeiDou, m.
[[nodiscard]] double accuracy_of_ura(int index);
/// Galileo's signal-in-space accuracy, m; 0 where the satellite gives none.
[[nodiscard]] double accuracy_of_sisa(int index);
/// The instant nearest to another at which it is this second of the day in Moscow, UTC + 3 h: the time of GLONASS.
[[nodiscard]] geo::GpsTime nearest_second_of_moscow_day(geo::GpsTime to, double second_of_day);
/// An instant is in the week that a message of about then states. At the turn of the week one may be ahead: within an hour of
/// it both weeks are right.
/// @param first  week of GPS that the system counts as 0  @param weeks  after which its count starts again
[[nodiscard]] bool is_stated_week(geo::GpsTime t, int stated, int first, int weeks);
inline constexpr int kGalileoFirstWeek = 1024, kGalileoWeeks = 4096;
inline constexpr int kBeidouFirstWeek = 1356, kBeidouWeeks = 8192;
inline constexpr double kGpsMinusBeidou = 14.0;  ///< s

/// A geostationary satellite of BeiDou, which sends D2 where others send D1.
[[nodiscard]] bool is_beidou_geostationary(record::Satellite satellite);

/// By satellite and time; of repeated ephemerides the first is kept.  @return number of repeated ones
[[nodiscard]] long sort_out(record::NavigationRecording& recording);

}  // namespace coast::io
