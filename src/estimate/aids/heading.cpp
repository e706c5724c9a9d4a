// Heading of a direction of the body: two antennas, or a compass that is corrected for declination.
//     z = atan2(u_E, u_N) + offset,  u_n = C_b_n a

#include <cmath>

#include "aids.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"

namespace coast::estimate {

namespace {

class Heading final : public Aid {
 public:
  explicit Heading(const config::Node& node)
      : axis_b_(node.vector3("baseline_m", Eigen::Vector3d::UnitX())),
        sd_(geo::kDegree * node.number_within("sd_deg", 0.3, 1e-4, 180.0)),
        offset_sd_(geo::kDegree * node.number_within("offset_sd_deg", 0.0, 0.0, 180.0)),
        interval_s_(node.number_within("interval_s", 1.0, 0.02, 600.0)) {
    if (!(axis_b_.norm() > 0.0)) throw node.at("baseline_m").error("[0, 0, 0]", "the direction from one antenna to the other");
    axis_b_.normalize();
  }

  [[nodiscard]] std::vector<AidState> states() const override {
    if (offset_sd_ == 0.0) return {};
    return {{"offset", offset_sd_, 0.0}};
  }
  [[nodiscard]] std::vector<record::AidSample> samples(const record::AidRecording& rows, const record::GnssRecording&,
                                                       record::Events&) const override {
    std::vector<record::AidSample> result = thinned(with_sd(rows, Eigen::Vector3d::Constant(sd_ / geo::kDegree)), interval_s_);
    for (record::AidSample& sample : result) {
      sample.value *= geo::kDegree;
      sample.sd *= geo::kDegree;
    }
    return result;
  }
  [[nodiscard]] std::optional<Linearised> linearise(const record::AidSample& sample, const FilterState& state,
                                                    const UpdateContext& context, int first_state) const override {
    const Eigen::Vector3d u_e = state.nav.q_b_e * axis_b_;
    const Eigen::Vector3d u_n = context.C_n_e.transpose() * u_e;
    const double horizontal = u_n.head<2>().squaredNorm();
    constexpr double kUpright = 0.1;  // of the direction: then its heading is not defined
    if (horizontal < kUpright * kUpright) return std::nullopt;
    Linearised m;
    m.kind = UpdateKind::kAid;
    const double offset = offset_sd_ > 0.0 ? state.x(first_state) : 0.0;
    m.nu = Components::Constant(1, std::remainder(sample.value.x() - std::atan2(u_n.y(), u_n.x()) - offset, 2.0 * geo::kPi));
    m.H = Eigen::MatrixXd::Zero(1, context.layout.size());
    const Eigen::Vector3d by_u = Eigen::Vector3d(-u_n.y(), u_n.x(), 0.0) / horizontal;
    m.H.block<1, 3>(0, kPsi) = -by_u.transpose() * context.C_n_e.transpose() * geo::skew(u_e);
    if (offset_sd_ > 0.0) m.H(0, first_state) = 1.0;
    m.R = ComponentCov::Constant(1, 1, sample.sd.x() * sample.sd.x());
    return m;
  }

 private:
  Eigen::Vector3d axis_b_;
  double sd_;
  double offset_sd_;
  double interval_s_;
};

}  // namespace

AidKind heading_kind() {
  return {"heading", {"heading_deg"}, {"heading_sd_deg"}, [](const config::Node& node) {
            return std::make_shared<const Heading>(node);
          }};
}

}  // namespace coast::estimate
