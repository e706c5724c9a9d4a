#include "coast/io/event_writers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coast/geo/photogrammetry.hpp"
#include "coast/geo/units.hpp"
#include "grid_columns.hpp"
#include "state_columns.hpp"
#include "text.hpp"
#include "writers/quality_tracks.hpp"

namespace coast::io {

namespace {

class EventFile {
 public:
  explicit EventFile(const std::filesystem::path& path) : file_(path), text_(file_) {}
  [[nodiscard]] TextBuffer& text() { return text_; }
  void begin_row(const record::MarkedState& state, const geo::Geodetic& p) {
    text_.put(csv_field(state.mark.id));
    text_.put(',');
    put_time_and_place(text_, state.nav.t, p);
  }
  void begin_row(const record::MarkedState& state, const Projection& projection) {
    text_.put(csv_field(state.mark.id));
    text_.put(',');
    text_.put_integer(state.nav.t.week());
    put_column(text_, state.nav.t.sow(), 9);
    put_grid_place(text_, projection, state.nav.r_eb_e, state.nav.t);
  }
  void close() {
    text_.flush();
    file_.commit();
  }

 private:
  AtomicFile file_;
  TextBuffer text_;
};

Eigen::Vector3d sd_of(const Eigen::Matrix3d& cov) {
  return cov.diagonal().cwiseMax(0.0).cwiseSqrt();
}

/// Whether an event's name may be that of an image: it has an extension.
bool names_a_file(const record::TimeMark& mark) {
  const std::size_t dot = mark.id.rfind('.');
  return dot != std::string::npos && dot > 0 && dot + 1 < mark.id.size();
}

/// ",value,reference": numbers of EXIF have no sign.
void put_magnitude(TextBuffer& text, double value, int decimals, std::string_view positive, std::string_view negative) {
  put_column(text, std::abs(value), decimals);
  text.put(',');
  text.put(value < 0.0 ? negative : positive);
}

/// "2025:07:08,19:34:18.499"
void put_utc_columns(TextBuffer& text, geo::GpsTime t) {
  const std::string utc = utc_text(t);  // 2025-07-08T19:34:18.499Z
  std::string date = utc.substr(0, 10);
  std::ranges::replace(date, '-', ':');
  text.put(fmt::format("{},{}", date, utc.substr(11, 12)));
}

/// Horizontal direction of the view and of the top of the image together: of either alone where the other is vertical, and
/// equal to both in between.
double image_direction_deg(const Eigen::Matrix3d& C_s_n) {
  const Eigen::Vector3d direction = C_s_n * Eigen::Vector3d(1.0, 0.0, 1.0);
  return heading_deg(std::atan2(direction.y(), direction.x()));
}

}  // namespace

void write_events_csv(const std::filesystem::path& path, const std::vector<record::MarkedState>& states) {
  EventFile file(path);
  TextBuffer& text = file.text();
  text.put(fmt::format("id,{},x_m,y_m,z_m,{},{}\n", kTimeAndPlaceColumns, kMotionColumns, kCovarianceColumns));
  for (const record::MarkedState& state : states) {
    const LocalState s = local_state(state.nav);
    file.begin_row(state, s.p);
    for (const double x : state.nav.r_eb_e) put_column(text, x, 5);
    put_motion(text, s);
    put_covariance(text, state.cov, s.attitude);
    text.end_line();
  }
  file.close();
}

void write_events_opk(const std::filesystem::path& path, const std::vector<record::MarkedState>& states,
                      const Projection* projection) {
  EventFile file(path);
  TextBuffer& text = file.text();
  text.put(fmt::format("id,{},omega_deg,phi_deg,kappa_deg,{},sd_omega_deg,sd_phi_deg,sd_kappa_deg\n",
                       projection ? "gps_week,sow_s," + grid_place_columns(*projection) : std::string(kTimeAndPlaceColumns),
                       projection ? grid_sd_columns(*projection) : "sdn_m,sde_m,sdd_m"));
  for (const record::MarkedState& state : states) {
    const LocalState s = local_state(state.nav);
    if (projection)
      file.begin_row(state, *projection);
    else
      file.begin_row(state, s.p);
    const double convergence = projection ? projection->convergence(state.nav.r_eb_e, state.nav.t) : 0.0;
    const Eigen::Matrix3d C = C_n_g(convergence);
    const geo::OmegaPhiKappa angles = geo::omega_phi_kappa_from_dcm(C * geo::dcm_from_euler(s.attitude));
    for (const double angle : {angles.omega, angles.phi, angles.kappa}) put_column(text, angle / geo::kDegree, 9);
    if (projection)
      put_grid_sd(text, *projection, convergence, state.cov.position);
    else
      for (const double sd : sd_of(state.cov.position)) put_column(text, sd, 6);
    const Eigen::Matrix3d J = geo::omega_phi_kappa_jacobian(angles) * C;
    for (const double sd : sd_of(J * state.cov.attitude * J.transpose())) put_column(text, sd / geo::kDegree, 8);
    text.end_line();
  }
  file.close();
}

void write_events_grid(const std::filesystem::path& path, const std::vector<record::MarkedState>& states,
                       const Projection& projection) {
  EventFile file(path);
  TextBuffer& text = file.text();
  text.put(fmt::format("id,gps_week,sow_s,{},roll_deg,pitch_deg,{},{}\n", grid_place_columns(projection), kGridHeadingColumns,
                       grid_sd_columns(projection)));
  for (const record::MarkedState& state : states) {
    const geo::Euler attitude = local_state(state.nav).attitude;
    const double convergence = projection.convergence(state.nav.r_eb_e, state.nav.t);
    file.begin_row(state, projection);
    for (const double angle : {attitude.roll, attitude.pitch}) put_column(text, angle / geo::kDegree, 9);
    put_grid_heading(text, convergence, attitude.yaw);
    put_grid_sd(text, projection, convergence, state.cov.position);
    text.end_line();
  }
  file.close();
}

void write_events_exif(const std::filesystem::path& path, const std::vector<record::MarkedState>& states,
                       const Projection* projection, double geoid_height_m) {
  EventFile file(path);
  TextBuffer& text = file.text();
  text.put(
      "SourceFile,GPSLatitude,GPSLatitudeRef,GPSLongitude,GPSLongitudeRef,GPSAltitude,GPSAltitudeRef,GPSImgDirection,"
      "GPSImgDirectionRef,GPSDateStamp,GPSTimeStamp,GPSHPositioningError,GPSMapDatum\n");
  for (const record::MarkedState& state : states) {
    if (!names_a_file(state.mark)) continue;
    const LocalState s = local_state(state.nav);
    const bool orthometric = projection != nullptr && projection->orthometric();
    const double altitude = orthometric ? projection->at(state.nav.r_eb_e, state.nav.t).height * projection->height_metres()
                                        : s.p.height - geoid_height_m;
    text.put(csv_field(state.mark.id));
    put_magnitude(text, s.p.latitude / geo::kDegree, 9, "N", "S");
    put_magnitude(text, s.p.longitude / geo::kDegree, 9, "E", "W");
    put_magnitude(text, altitude, 3, "0", "1");
    put_column(text, image_direction_deg(geo::dcm_from_euler(s.attitude)), 3);
    text.put(",T,");
    put_utc_columns(text, state.nav.t);
    const Eigen::Vector3d sd = sd_of(state.cov.position);
    put_column(text, std::max(sd.x(), sd.y()), 3);
    text.put(",WGS-84");
    text.end_line();
  }
  file.close();
}

void write_odm_geo(const std::filesystem::path& path, const std::vector<record::MarkedState>& states) {
  EventFile file(path);
  TextBuffer& text = file.text();
  text.put("EPSG:4326\n");
  for (const record::MarkedState& state : states) {
    if (!odm_geo_names(state.mark)) continue;
    const LocalState s = local_state(state.nav);
    text.put(state.mark.id);
    const auto put = [&text](double value, int decimals) {
      text.put(' ');
      text.put_fixed(value, decimals);
    };
    put(s.p.longitude / geo::kDegree, 11);
    put(s.p.latitude / geo::kDegree, 11);
    put(s.p.height, 5);
    for (const double angle : {s.attitude.yaw, s.attitude.pitch, s.attitude.roll}) put(angle / geo::kDegree, 6);
    const Eigen::Vector3d sd = sd_of(state.cov.position);
    put(std::max(sd.x(), sd.y()), 5);
    put(sd.z(), 5);
    text.end_line();
  }
  file.close();
}

bool odm_geo_names(const record::TimeMark& mark) {
  return mark.id.find_first_of(" \t") == std::string::npos;
}

}  // namespace coast::io
