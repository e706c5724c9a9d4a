// GeoJSON (RFC 7946): a line for each stretch of equal GNSS quality. Heights are above the ellipsoid, as the RFC asks. The
// times of its points stand in `coordTimes`, as viewers know them.

#include <fmt/format.h>

#include "coast/geo/earth.hpp"
#include "coast/geo/units.hpp"
#include "quality_tracks.hpp"
#include "text_trajectory.hpp"
#include "writers.hpp"

namespace coast::io {

namespace {

class GeoJsonWriter final : public TextTrajectory {
 public:
  GeoJsonWriter(const std::filesystem::path& path, const WriterOptions& options)
      : TextTrajectory(path),
        tracks_(options.min_step_m, [this](const auto& quality, const auto& track) { put_feature(quality, track); }) {
    text().put("{\"type\": \"FeatureCollection\", \"features\": [");
  }
  void write(const record::TrajectoryEpoch& epoch) override { tracks_.add(epoch); }

 private:
  void finish() override {
    tracks_.finish();
    text().put("\n]}\n");
  }
  void put_feature(const TrackQuality& quality, const std::vector<TrackPoint>& track) {
    const bool line = track.size() > 1;  // a line has two points at least
    text().put(first_ ? "\n" : ",\n");
    first_ = false;
    text().put(
        fmt::format("{{\"type\": \"Feature\", \"properties\": {{\"quality\": \"{}\", \"stroke\": \"#{}\", \"coordTimes\": [",
                    quality.name, quality.rgb));
    for (std::size_t i = 0; i < track.size(); ++i) {
      text().put(fmt::format("{}\"{}\"", i == 0 ? "" : ",", utc_text(track[i].t)));
      if (i % kPerLine == kPerLine - 1) text().end_line();
    }
    text().put(fmt::format("]}}, \"geometry\": {{\"type\": \"{}\", \"coordinates\": {}", line ? "LineString" : "Point",
                           line ? "[" : ""));
    for (std::size_t i = 0; i < track.size(); ++i) {
      if (i > 0) text().put(',');
      put_place(track[i].r_e);
      if (i % kPerLine == kPerLine - 1) text().end_line();
    }
    text().put(line ? "]}}" : "}}");
  }

  void put_place(const Eigen::Vector3d& r_e) {
    const geo::Geodetic p = geo::geodetic_from_ecef(r_e);
    text().put('[');
    text().put_fixed(p.longitude / geo::kDegree, 9);
    text().put(',');
    text().put_fixed(p.latitude / geo::kDegree, 9);
    text().put(',');
    text().put_fixed(p.height, 4);
    text().put(']');
  }

  static constexpr std::size_t kPerLine = 8;  // lines of a bounded length, so that text goes to the file in blocks
  bool first_ = true;
  QualityTracks tracks_;
};

}  // namespace

TrajectoryFormat geojson_trajectory() {
  TrajectoryFormat format{"geojson", "GeoJSON lines"};
  format.make = [](const std::filesystem::path& file, const WriterOptions& options) {
    return std::make_unique<GeoJsonWriter>(file, options);
  };
  return format;
}

}  // namespace coast::io
