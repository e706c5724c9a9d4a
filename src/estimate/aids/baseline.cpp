// Vector from one antenna to another of the same vehicle, from carrier phases with a moving base.
//     z = C_b_n b

#include "aids.hpp"
#include "coast/geo/rotation.hpp"

namespace coast::estimate {

namespace {

class Baseline final : public Aid {
 public:
  explicit Baseline(const config::Node& node)
      : baseline_b_(node.at("baseline_m").vector3()),
        sd_(node.vector3("sd_m", {0.01, 0.01, 0.02})),
        east_first_(node.choice("frame", {"ned", "enu"}, 0) == 1),
        interval_s_(node.number_within("interval_s", 1.0, 0.02, 600.0)) {
    if (!(baseline_b_.norm() > 0.0))
      throw node.at("baseline_m").error("[0, 0, 0]", "the vector between the antennas, body axes");
    if (!(sd_.minCoeff() > 0.0)) throw node.at("sd_m").error("a standard deviation of zero or less", "three values above zero");
  }

  [[nodiscard]] std::vector<record::AidSample> samples(const record::AidRecording& rows, const record::GnssRecording&,
                                                       record::Events&) const override {
    std::vector<record::AidSample> result = thinned(with_sd(rows, sd_), interval_s_);
    if (!east_first_) return result;
    for (record::AidSample& sample : result) {
      sample.value = Eigen::Vector3d(sample.value.y(), sample.value.x(), -sample.value.z());
      std::swap(sample.sd.x(), sample.sd.y());
    }
    return result;
  }
  [[nodiscard]] std::optional<Linearised> linearise(const record::AidSample& sample, const FilterState& state,
                                                    const UpdateContext& context, int) const override {
    const Eigen::Vector3d b_e = state.nav.q_b_e * baseline_b_;
    Linearised m;
    m.kind = UpdateKind::kAid;
    m.nu = sample.value - context.C_n_e.transpose() * b_e;
    m.H = Eigen::MatrixXd::Zero(3, context.layout.size());
    m.H.block<3, 3>(0, kPsi) = -context.C_n_e.transpose() * geo::skew(b_e);
    m.R = sample.sd.cwiseAbs2().asDiagonal();
    return m;
  }

 private:
  Eigen::Vector3d baseline_b_;
  Eigen::Vector3d sd_;  ///< N, E, D
  bool east_first_;
  double interval_s_;
};

}  // namespace

AidKind baseline_kind() {
  return {"baseline", {"north_m", "east_m", "down_m"}, {"sdn_m", "sde_m", "sdd_m"}, [](const config::Node& node) {
            return std::make_shared<const Baseline>(node);
          }};
}

}  // namespace coast::estimate
