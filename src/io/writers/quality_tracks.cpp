#include "quality_tracks.hpp"

#include <fmt/format.h>

namespace coast::io {

const std::vector<TrackQuality>& track_qualities() {
  // After the first in RTKLIB's order of qualities.
  static const std::vector<TrackQuality> table{{"without-gnss", "without GNSS", "dc3c3c"},
                                               {"unknown", "GNSS", "3c78f0"},
                                               {"fixed", "fixed", "28b450"},
                                               {"float", "float", "f0961e"},
                                               {"sbas", "SBAS", "c878c8"},
                                               {"dgps", "DGPS", "3cb4dc"},
                                               {"single", "single", "f0d214"},
                                               {"ppp", "PPP", "28c8b4"}};
  return table;
}

void QualityTracks::add(const record::TrajectoryEpoch& epoch) {
  const TrackQuality& quality = track_qualities()[epoch.gnss ? 1 + static_cast<std::size_t>(epoch.gnss->quality) : 0];
  const TrackPoint point{epoch.nav.t, epoch.nav.r_eb_e};
  if (quality_ != nullptr && &quality != quality_) {
    track_.push_back(point);
    put_track();
  }
  quality_ = &quality;
  pending_.reset();
  if (track_.empty() || (point.r_e - track_.back().r_e).norm() >= min_step_m_)
    track_.push_back(point);
  else
    pending_ = point;
}

void QualityTracks::finish() {
  if (pending_) track_.push_back(*pending_);  // the last track ends at the end of the mission
  put_track();
}

void QualityTracks::put_track() {
  if (track_.empty()) return;
  put_(*quality_, track_);
  track_.clear();
}

std::string utc_text(geo::GpsTime t) {
  constexpr std::int64_t kMillisecond = 1'000'000;
  const geo::Calendar c =
      geo::GpsTime::from_nanoseconds((t.nanoseconds() + kMillisecond / 2) / kMillisecond * kMillisecond).utc();
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:06.3f}Z", c.year, c.month, c.day, c.hour, c.minute, c.second);
}

std::string xml_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

}  // namespace coast::io
