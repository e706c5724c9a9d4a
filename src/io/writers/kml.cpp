// KML 2.2 with Google's tracks, which have times, one for each stretch of equal GNSS quality. Viewers take `absolute` altitudes
// as above mean sea level: if the geoid is not known they are above the ellipsoid, the tracks are clamped to the ground, and
// the description states this.

#include <fmt/format.h>

#include "coast/geo/earth.hpp"
#include "coast/geo/units.hpp"
#include "quality_tracks.hpp"
#include "text_trajectory.hpp"
#include "writers.hpp"

namespace coast::io {

namespace {

class KmlWriter final : public TextTrajectory {
 public:
  KmlWriter(const std::filesystem::path& path, const WriterOptions& options)
      : TextTrajectory(path),
        geoid_height_(options.geoid_height_m),
        tracks_(options.min_step_m, [this](const auto& quality, const auto& track) { put_track(quality, track); }) {
    text().put(
        fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<kml xmlns=\"http://www.opengis.net/kml/2.2\" "
                    "xmlns:gx=\"http://www.google.com/kml/ext/2.2\">\n<Document>\n<name>{}</name>\n<description>{}"
                    "</description>\n",
                    xml_text(path.stem().string()),
                    geoid_height_ ? "Altitudes are above mean sea level."
                                  : "Altitudes are above the WGS 84 ellipsoid; the tracks are clamped to the ground, "
                                    "because the geoid's height is not known (gnss.geoid_height_m)."));
    for (const TrackQuality& quality : track_qualities()) put_style(quality);
  }
  void write(const record::TrajectoryEpoch& epoch) override { tracks_.add(epoch); }

 private:
  void finish() override {
    tracks_.finish();
    text().put("</Document>\n</kml>\n");
  }
  void put_style(const TrackQuality& quality) {
    const std::string rgb = quality.rgb;  // KML's order is alpha, blue, green, red
    text().put(
        fmt::format("<Style id=\"{}\"><LineStyle><color>ff{}{}{}</color><width>3</width></LineStyle><IconStyle><scale>0</scale>"
                    "</IconStyle><LabelStyle><scale>0</scale></LabelStyle></Style>\n",
                    quality.id, rgb.substr(4, 2), rgb.substr(2, 2), rgb.substr(0, 2)));
  }

  /// All times precede all places.
  void put_track(const TrackQuality& quality, const std::vector<TrackPoint>& track) {
    text().put(fmt::format("<Placemark><name>{}</name><styleUrl>#{}</styleUrl><gx:Track><altitudeMode>{}</altitudeMode>\n",
                           quality.name, quality.id, geoid_height_ ? "absolute" : "clampToGround"));
    for (const TrackPoint& point : track) {
      text().put(fmt::format("<when>{}</when>", utc_text(point.t)));
      text().end_line();
    }
    for (const TrackPoint& point : track) put_place(point.r_e);
    text().put("</gx:Track></Placemark>\n");
  }

  void put_place(const Eigen::Vector3d& r_e) {
    const geo::Geodetic p = geo::geodetic_from_ecef(r_e);
    text().put("<gx:coord>");
    text().put_fixed(p.longitude / geo::kDegree, 8);
    text().put(' ');
    text().put_fixed(p.latitude / geo::kDegree, 8);
    text().put(' ');
    text().put_fixed(p.height - geoid_height_.value_or(0.0), 3);
    text().put("</gx:coord>");
    text().end_line();
  }

  std::optional<double> geoid_height_;
  QualityTracks tracks_;
};

}  // namespace

TrajectoryFormat kml_trajectory() {
  TrajectoryFormat format{"kml", "KML tracks with times, coloured by quality"};
  format.make = [](const std::filesystem::path& file, const WriterOptions& options) {
    return std::make_unique<KmlWriter>(file, options);
  };
  return format;
}

}  // namespace coast::io
