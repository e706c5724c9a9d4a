// Attitude of the body from another system: roll, pitch, yaw.

#include "aids.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"

namespace coast::estimate {

namespace {

class Attitude final : public Aid {
 public:
  explicit Attitude(const config::Node& node)
      : sd_(geo::kDegree * node.vector3("sd_deg", {0.2, 0.2, 0.5})),
        interval_s_(node.number_within("interval_s", 1.0, 0.02, 600.0)) {
    if (!(sd_.minCoeff() > 0.0))
      throw node.at("sd_deg").error("a standard deviation of zero or less", "three values above zero");
  }

  [[nodiscard]] std::vector<record::AidSample> samples(const record::AidRecording& rows, const record::GnssRecording&,
                                                       record::Events&) const override {
    std::vector<record::AidSample> result = thinned(with_sd(rows, sd_ / geo::kDegree), interval_s_);
    for (record::AidSample& sample : result) {
      sample.value *= geo::kDegree;
      sample.sd *= geo::kDegree;
    }
    return result;
  }
  // C(estimate) = exp([psi x]) C(measured):  nu = -psi. Standard deviations are about the horizontal axis forward, the one to
  // the right, and down.
  [[nodiscard]] std::optional<Linearised> linearise(const record::AidSample& sample, const FilterState& state,
                                                    const UpdateContext& context, int) const override {
    const geo::Euler euler{sample.value.x(), sample.value.y(), sample.value.z()};
    const Eigen::Quaterniond measured(context.C_n_e * geo::dcm_from_euler(euler));
    Linearised m;
    m.kind = UpdateKind::kAid;
    m.nu = -geo::rotation_vector(state.nav.q_b_e * measured.conjugate());
    m.H = Eigen::MatrixXd::Zero(3, context.layout.size());
    m.H.block<3, 3>(0, kPsi).setIdentity();
    const Eigen::Matrix3d axes = context.C_n_e * geo::dcm_from_euler({0.0, 0.0, euler.yaw});
    m.R = axes * sample.sd.cwiseAbs2().asDiagonal() * axes.transpose();
    return m;
  }

 private:
  Eigen::Vector3d sd_;  ///< roll, pitch, yaw
  double interval_s_;
};

}  // namespace

AidKind attitude_kind() {
  return {"attitude",
          {"roll_deg", "pitch_deg", "yaw_deg"},
          {"roll_sd_deg", "pitch_sd_deg", "yaw_sd_deg"},
          [](const config::Node& node) { return std::make_shared<const Attitude>(node); }};
}

}  // namespace coast::estimate
