#include "coast/io/event_writers.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "coast/geo/photogrammetry.hpp"
#include "coast/geo/units.hpp"
#include "state_columns.hpp"
#include "text.hpp"

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

void write_events_opk(const std::filesystem::path& path, const std::vector<record::MarkedState>& states) {
  EventFile file(path);
  TextBuffer& text = file.text();
  text.put(fmt::format("id,{},omega_deg,phi_deg,kappa_deg,sdn_m,sde_m,sdd_m,sd_omega_deg,sd_phi_deg,sd_kappa_deg\n",
                       kTimeAndPlaceColumns));
  for (const record::MarkedState& state : states) {
    const LocalState s = local_state(state.nav);
    file.begin_row(state, s.p);
    const geo::OmegaPhiKappa angles = geo::omega_phi_kappa_from_dcm(geo::dcm_from_euler(s.attitude));
    for (const double angle : {angles.omega, angles.phi, angles.kappa}) put_column(text, angle / geo::kDegree, 9);
    for (const double sd : sd_of(state.cov.position)) put_column(text, sd, 6);
    const Eigen::Matrix3d J = geo::omega_phi_kappa_jacobian(angles);
    for (const double sd : sd_of(J * state.cov.attitude * J.transpose())) put_column(text, sd / geo::kDegree, 8);
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
