#include "grid_columns.hpp"

#include <fmt/format.h>

#include <cmath>

#include "coast/geo/units.hpp"
#include "state_columns.hpp"

namespace coast::io {

std::string grid_place_columns(const Projection& projection) {
  const GridColumns& names = projection.columns();
  return fmt::format("{},{},{}", names.easting, names.northing, names.height);
}

std::string grid_sd_columns(const Projection& projection) {
  const GridColumns& names = projection.columns();
  return fmt::format("sd_{},sd_{},sd_{}", names.easting, names.northing, names.height);
}

Eigen::Matrix3d C_n_g(double convergence) {
  const double c = std::cos(convergence), s = std::sin(convergence);
  Eigen::Matrix3d C;
  C << c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0;
  return C;
}

double heading_deg(double yaw) {
  constexpr double kTurn = 360.0;
  const double degrees = yaw / geo::kDegree;
  const double heading = degrees - kTurn * std::floor(degrees / kTurn);
  return heading < kTurn ? heading : 0.0;  // of -1e-15
}

void put_grid_place(TextBuffer& text, const Projection& projection, const Eigen::Vector3d& r_e, geo::GpsTime t) {
  const GridPosition p = projection.at(r_e, t);
  for (const double value : {p.easting, p.northing, p.height}) put_column(text, value, 5);
}

void put_grid_heading(TextBuffer& text, double convergence, double yaw) {
  put_column(text, convergence / geo::kDegree, 9);
  put_column(text, heading_deg(yaw), 9);
  put_column(text, heading_deg(yaw - convergence), 9);
}

void put_grid_sd(TextBuffer& text, const Projection& projection, double convergence, const Eigen::Matrix3d& cov_n) {
  const Eigen::Matrix3d C = C_n_g(convergence);
  const Eigen::Vector3d sd = (C * cov_n * C.transpose()).diagonal().cwiseMax(0.0).cwiseSqrt();
  put_column(text, sd.y() / projection.metres(), 6);
  put_column(text, sd.x() / projection.metres(), 6);
  put_column(text, sd.z() / projection.height_metres(), 6);
}

}  // namespace coast::io
