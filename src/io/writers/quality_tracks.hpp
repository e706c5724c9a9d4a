#pragma once
// A trajectory as lines on a map: one for each stretch of equal GNSS quality, thinned. Private to the room.

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coast/geo/time.hpp"
#include "coast/record/trajectory.hpp"

namespace coast::io {

/// What a position is based on, as it is shown.
struct TrackQuality {
  const char* id;
  const char* name;
  const char* rgb;  ///< colour, six hexadecimal digits
};
/// All of them; the first is that of epochs without GNSS.
[[nodiscard]] const std::vector<TrackQuality>& track_qualities();

struct TrackPoint {
  geo::GpsTime t;
  Eigen::Vector3d r_e;
};

/// Collects points and gives each finished track to a function. Where one ends the next begins.
class QualityTracks {
 public:
  using Put = std::function<void(const TrackQuality&, const std::vector<TrackPoint>&)>;
  /// @param min_step_m  least distance between points, but for the first and last of a track
  QualityTracks(double min_step_m, Put put) : min_step_m_(min_step_m), put_(std::move(put)) {}
  void add(const record::TrajectoryEpoch& epoch);
  /// After the last epoch.
  void finish();

 private:
  void put_track();

  double min_step_m_;
  Put put_;
  const TrackQuality* quality_ = nullptr;  ///< of the current track
  std::vector<TrackPoint> track_;
  std::optional<TrackPoint> pending_;  ///< the last epoch, too close to the previous point
};

/// "2025-07-08T19:34:18.499Z", rounded to a millisecond first: second 60 is only for a leap second.
[[nodiscard]] std::string utc_text(geo::GpsTime t);
/// Text between tags of XML.
[[nodiscard]] std::string xml_text(std::string_view text);

}  // namespace coast::io
