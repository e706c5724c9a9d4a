// A point known from elsewhere at which the vehicle was: control points, a dock, the start and the end of a survey.
//     z = r + C p

#include <fmt/format.h>

#include <cmath>

#include "aids.hpp"
#include "coast/geo/earth.hpp"
#include "coast/geo/units.hpp"

namespace coast::estimate {

namespace {

class KnownPosition final : public Aid {
 public:
  explicit KnownPosition(const config::Node& node)
      : point_b_(node.vector3("point_m", Eigen::Vector3d::Zero())), sd_(node.vector3("sd_m", {0.05, 0.05, 0.05})) {
    if (!(sd_.minCoeff() > 0.0)) throw node.at("sd_m").error("a standard deviation of zero or less", "three values above zero");
  }

  [[nodiscard]] std::vector<record::AidSample> samples(const record::AidRecording& rows, const record::GnssRecording&,
                                                       record::Events&) const override {
    std::vector<record::AidSample> result = with_sd(rows, sd_);
    for (record::AidSample& sample : result) {
      const Eigen::Vector3d& row = sample.value;
      if (std::abs(row.x()) > 90.0 || std::abs(row.y()) > 360.0 || std::abs(row.z()) > 1e5)
        throw InputError({rows.source, 0, fmt::format("a point at {}, {}, {}", row.x(), row.y(), row.z()),
                          "latitude and longitude in degrees, height above the ellipsoid in metres", ""});
      sample.value = geo::ecef_from_geodetic({row.x() * geo::kDegree, row.y() * geo::kDegree, row.z()});
    }
    return result;
  }
  [[nodiscard]] std::optional<Linearised> linearise(const record::AidSample& sample, const FilterState& state,
                                                    const UpdateContext& context, int) const override {
    AntennaPrediction predicted = point_position(state, context, point_b_);
    Linearised m;
    m.kind = UpdateKind::kAid;
    m.nu = sample.value - predicted.value_e;
    m.H = std::move(predicted.H);
    m.R = context.C_n_e * sample.sd.cwiseAbs2().asDiagonal() * context.C_n_e.transpose();
    return m;
  }

 private:
  Eigen::Vector3d point_b_;
  Eigen::Vector3d sd_;  ///< N, E, D
};

}  // namespace

AidKind position_kind() {
  return {"position", {"lat_deg", "lon_deg", "height_m"}, {"sdn_m", "sde_m", "sdd_m"}, [](const config::Node& node) {
            return std::make_shared<const KnownPosition>(node);
          }};
}

}  // namespace coast::estimate
