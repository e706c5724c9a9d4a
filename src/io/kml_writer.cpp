// KML 2.2: one line with altitudes above the ellipsoid. Viewers take `absolute` altitudes as above mean sea level; the
// description says which they are.

#include <fmt/format.h>

#include <optional>

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

class KmlWriter final : public TrajectoryWriter {
 public:
  KmlWriter(const std::filesystem::path& path, std::string_view name, double min_step)
      : file_(path), text_(file_), min_step_(min_step) {
    text_.put(fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<kml xmlns=\"http://www.opengis.net/kml/2.2\">\n<Document>\n"
        "<name>{0}</name>\n<Style id=\"line\"><LineStyle><color>ff3c78f0</color><width>3</width></LineStyle></Style>\n"
        "<Placemark><name>{0}</name><description>Altitudes are above the WGS 84 ellipsoid.</description>"
        "<styleUrl>#line</styleUrl>\n<LineString><altitudeMode>absolute</altitudeMode><coordinates>\n",
        escaped(name)));
  }

  void write(const record::TrajectoryEpoch& epoch) override {
    const Eigen::Vector3d& r = epoch.nav.r_eb_e;
    pending_ = r;
    if (last_ && (r - *last_).norm() < min_step_) return;
    put_point(r);
  }
  void close() override {
    if (pending_ && *pending_ != *last_) put_point(*pending_);  // the line ends where the mission ends
    text_.put("</coordinates></LineString></Placemark>\n</Document>\n</kml>\n");
    text_.flush();
    file_.commit();
  }

 private:
  void put_point(const Eigen::Vector3d& r) {
    const geo::Geodetic p = geo::geodetic_from_ecef(r);
    text_.put_fixed(p.longitude / geo::kDegree, 8);
    text_.put(',');
    text_.put_fixed(p.latitude / geo::kDegree, 8);
    text_.put(',');
    text_.put_fixed(p.height, 3);
    text_.end_line();
    last_ = r;
  }

  AtomicFile file_;
  TextBuffer text_;
  double min_step_;
  std::optional<Eigen::Vector3d> last_, pending_;
};

}  // namespace

std::unique_ptr<TrajectoryWriter> make_kml_writer(const std::filesystem::path& path, std::string_view name, double min_step_m) {
  return std::make_unique<KmlWriter>(path, name, min_step_m);
}

}  // namespace coast::io
