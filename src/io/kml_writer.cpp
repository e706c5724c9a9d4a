// KML 2.2 with Google's tracks, which have times. Viewers interpret `absolute` altitudes as above mean sea level.

#include <fmt/format.h>

#include <array>
#include <optional>
#include <vector>

#include "coast/geo/units.hpp"
#include "text_buffer.hpp"

namespace coast::io {

namespace {

std::string escaped(std::string_view text) {
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

struct TrackStyle {
  const char* id;
  const char* name;
  const char* colour;  ///< aabbggrr
};

constexpr TrackStyle kWithoutGnss{"without-gnss", "without GNSS", "ff3c3cdc"};

/// In RTKLIB's order of qualities.
constexpr std::array<TrackStyle, 7> kStyles{{{"unknown", "GNSS", "fff0783c"},
                                             {"fixed", "fixed", "ff50b428"},
                                             {"float", "float", "ff1e96f0"},
                                             {"sbas", "SBAS", "ffc878c8"},
                                             {"dgps", "DGPS", "ffdcb43c"},
                                             {"single", "single", "ff14d2f0"},
                                             {"ppp", "PPP", "ffb4c828"}}};

const TrackStyle& style_of(const record::TrajectoryEpoch& epoch) {
  return epoch.gnss ? kStyles[static_cast<std::size_t>(epoch.gnss->quality)] : kWithoutGnss;
}

/// "2025-07-08T19:34:18.499Z", rounded to a millisecond first: second 60 is only for a leap second.
std::string utc(geo::GpsTime t) {
  constexpr std::int64_t kMillisecond = 1'000'000;
  const geo::Calendar c =
      geo::GpsTime::from_nanoseconds((t.nanoseconds() + kMillisecond / 2) / kMillisecond * kMillisecond).utc();
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:06.3f}Z", c.year, c.month, c.day, c.hour, c.minute, c.second);
}

class KmlWriter final : public TrajectoryWriter {
 public:
  KmlWriter(const std::filesystem::path& path, std::string_view name, std::optional<double> geoid_height, double min_step)
      : file_(path), text_(file_), geoid_height_(geoid_height), min_step_(min_step) {
    text_.put(
        fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<kml xmlns=\"http://www.opengis.net/kml/2.2\" "
                    "xmlns:gx=\"http://www.google.com/kml/ext/2.2\">\n<Document>\n<name>{}</name>\n<description>{}"
                    "</description>\n",
                    escaped(name),
                    geoid_height ? "Altitudes are above mean sea level."
                                 : "Altitudes are above the WGS 84 ellipsoid; the tracks are clamped to the ground, "
                                   "because the geoid's height is not known (gnss.geoid_height_m)."));
    put_style(kWithoutGnss);
    for (const TrackStyle& style : kStyles) put_style(style);
  }

  void write(const record::TrajectoryEpoch& epoch) override {
    const TrackStyle& style = style_of(epoch);
    const Point point{epoch.nav.t, epoch.nav.r_eb_e};
    if (style_ != nullptr && &style != style_) {
      track_.push_back(point);  // one track begins at the end of the previous one
      put_track();
    }
    style_ = &style;
    pending_.reset();
    if (track_.empty() || (point.r_e - track_.back().r_e).norm() >= min_step_)
      track_.push_back(point);
    else
      pending_ = point;
  }
  void close() override {
    if (pending_) track_.push_back(*pending_);  // the last track ends at the end of the mission
    put_track();
    text_.put("</Document>\n</kml>\n");
    text_.flush();
    file_.commit();
  }

 private:
  struct Point {
    geo::GpsTime t;
    Eigen::Vector3d r_e;
  };

  void put_style(const TrackStyle& style) {
    text_.put(
        fmt::format("<Style id=\"{}\"><LineStyle><color>{}</color><width>3</width></LineStyle><IconStyle><scale>0</scale>"
                    "</IconStyle><LabelStyle><scale>0</scale></LabelStyle></Style>\n",
                    style.id, style.colour));
  }

  /// All times precede all places.
  void put_track() {
    if (track_.empty()) return;
    text_.put(fmt::format("<Placemark><name>{}</name><styleUrl>#{}</styleUrl><gx:Track><altitudeMode>{}</altitudeMode>\n",
                          style_->name, style_->id, geoid_height_ ? "absolute" : "clampToGround"));
    for (const Point& point : track_) {
      text_.put(fmt::format("<when>{}</when>", utc(point.t)));
      text_.end_line();
    }
    for (const Point& point : track_) put_place(point.r_e);
    text_.put("</gx:Track></Placemark>\n");
    track_.clear();
  }

  void put_place(const Eigen::Vector3d& r_e) {
    const geo::Geodetic p = geo::geodetic_from_ecef(r_e);
    text_.put("<gx:coord>");
    text_.put_fixed(p.longitude / geo::kDegree, 8);
    text_.put(' ');
    text_.put_fixed(p.latitude / geo::kDegree, 8);
    text_.put(' ');
    text_.put_fixed(p.height - geoid_height_.value_or(0.0), 3);
    text_.put("</gx:coord>");
    text_.end_line();
  }

  AtomicFile file_;
  TextBuffer text_;
  std::optional<double> geoid_height_;
  double min_step_;
  const TrackStyle* style_ = nullptr;  ///< of the current track
  std::vector<Point> track_;
  std::optional<Point> pending_;  ///< the last epoch, too close to the previous point
};

}  // namespace

std::unique_ptr<TrajectoryWriter> make_kml_writer(const std::filesystem::path& path, std::string_view name,
                                                  std::optional<double> geoid_height_m, double min_step_m) {
  return std::make_unique<KmlWriter>(path, name, geoid_height_m, min_step_m);
}

}  // namespace coast::io
