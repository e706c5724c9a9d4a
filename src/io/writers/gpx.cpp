// GPX 1.1 (Topografix): one track, one segment for each stretch of equal GNSS quality.

#include <fmt/format.h>

#include "coast/geo/earth.hpp"
#include "coast/geo/units.hpp"
#include "quality_tracks.hpp"
#include "text_trajectory.hpp"
#include "writers.hpp"

namespace coast::io {

namespace {

/// GPX's words for a fix; nothing where none of them is known to be right.
std::string_view gpx_fix(std::string_view quality) {
  if (quality == "without-gnss") return "none";
  if (quality == "unknown") return "";
  return quality == "single" || quality == "ppp" ? "3d" : "dgps";
}

class GpxWriter final : public TextTrajectory {
 public:
  GpxWriter(const std::filesystem::path& path, const WriterOptions& options)
      : TextTrajectory(path),
        geoid_height_(options.geoid_height_m),
        tracks_(options.min_step_m, [this](const auto& quality, const auto& track) { put_segment(quality, track); }) {
    text().put(
        fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<gpx version=\"1.1\" creator=\"coast\" "
                    "xmlns=\"http://www.topografix.com/GPX/1/1\">\n<metadata><desc>Elevations are above {}.</desc></metadata>\n"
                    "<trk><name>{}</name>\n",
                    geoid_height_ ? "mean sea level" : "the WGS 84 ellipsoid", xml_text(path.stem().string())));
  }
  void write(const record::TrajectoryEpoch& epoch) override { tracks_.add(epoch); }

 private:
  void finish() override {
    tracks_.finish();
    text().put("</trk>\n</gpx>\n");
  }
  void put_segment(const TrackQuality& quality, const std::vector<TrackPoint>& track) {
    text().put("<trkseg>\n");
    for (const TrackPoint& point : track) put_point(quality, point);
    text().put("</trkseg>\n");
  }

  void put_point(const TrackQuality& quality, const TrackPoint& point) {
    const geo::Geodetic p = geo::geodetic_from_ecef(point.r_e);
    text().put("<trkpt lat=\"");
    text().put_fixed(p.latitude / geo::kDegree, 9);
    text().put("\" lon=\"");
    text().put_fixed(p.longitude / geo::kDegree, 9);
    text().put("\"><ele>");
    text().put_fixed(p.height - geoid_height_.value_or(0.0), 4);
    text().put(fmt::format("</ele><time>{}</time>", utc_text(point.t)));
    // 0: heights of the trajectory are above the geoid themselves, and its own height is not known.
    if (geoid_height_.value_or(0.0) != 0.0) text().put(fmt::format("<geoidheight>{:.3f}</geoidheight>", *geoid_height_));
    if (const std::string_view fix = gpx_fix(quality.id); !fix.empty()) text().put(fmt::format("<fix>{}</fix>", fix));
    text().put("</trkpt>");
    text().end_line();
  }

  std::optional<double> geoid_height_;
  QualityTracks tracks_;
};

}  // namespace

TrajectoryFormat gpx_trajectory() {
  TrajectoryFormat format{"gpx", "GPX 1.1 track"};
  format.make = [](const std::filesystem::path& file, const WriterOptions& options) {
    return std::make_unique<GpxWriter>(file, options);
  };
  return format;
}

}  // namespace coast::io
