#include "common/keys.hpp"

#include <fmt/format.h>

#include "coast/geo/units.hpp"

namespace coast::jobs {

geo::Geodetic geodetic_from(const config::Node& node) {
  const Eigen::Vector3d v = node.vector3();
  if (std::abs(v.x()) > 90.0)
    throw node.error("a latitude beyond 90 deg", "[latitude_deg, longitude_deg, height_m]",
                     std::abs(v.y()) <= 90.0 ? "Is the longitude first?" : "");
  return {geo::kDegree * v.x(), geo::kDegree * v.y(), v.z()};
}

}  // namespace coast::jobs
