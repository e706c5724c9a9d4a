// Height from air pressure, a height sensor or a map.
//     z = h + offset + drift

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "aids.hpp"
#include "coast/geo/earth.hpp"
#include "coast/geo/units.hpp"

namespace coast::estimate {

namespace {

// International standard atmosphere (ISO 2533) below 11 km.
double height_of_pressure(double hectopascal) {
  return 44330.77 * (1.0 - std::pow(hectopascal / 1013.25, 0.190263));
}

class Height final : public Aid {
 public:
  explicit Height(const config::Node& node)
      : point_b_(node.vector3("point_m", Eigen::Vector3d::Zero())),
        sd_(node.number_within("sd_m", 0.3, 1e-4, 1e3)),
        pressure_(node.choice("unit", {"m", "hPa"}, 0) == 1),
        offset_sd_(node.number_within("offset_sd_m", 2.0, 0.0, 1e4)),
        drift_sd_(node.number_within("drift_sd_m", 2.0, 0.0, 1e3)),
        drift_time_s_(node.number_within("drift_time_s", 1800.0, 1.0, 1e6)),
        interval_s_(node.number_within("interval_s", 1.0, 0.02, 600.0)) {}

  [[nodiscard]] std::vector<AidState> states() const override {
    std::vector<AidState> states;
    if (offset_sd_ > 0.0) states.push_back({"offset", offset_sd_, 0.0});
    if (drift_sd_ > 0.0) states.push_back({"drift", drift_sd_, drift_time_s_});
    return states;
  }

  [[nodiscard]] std::vector<record::AidSample> samples(const record::AidRecording& rows, const record::GnssRecording& gnss,
                                                       record::Events& told) const override {
    record::AidRecording metres = rows;
    if (pressure_)
      for (record::AidSample& row : metres.samples) {
        if (!(row.value.x() > 200.0 && row.value.x() < 1200.0))
          throw InputError(
              {rows.source, 0, fmt::format("a pressure of {:g} hPa", row.value.x()), "200 to 1200 hPa", "unit: m?"});
        row.value.x() = height_of_pressure(row.value.x());
        row.sd.x() = 0.0;
      }
    std::vector<record::AidSample> result = thinned(with_sd(metres, Eigen::Vector3d::Constant(sd_)), interval_s_);
    if (offset_sd_ == 0.0) return result;
    const double zero = zero_of(result, gnss);
    for (record::AidSample& sample : result) sample.value.x() -= zero;
    told.push_back(
        {record::Event::Severity::kInfo, "height_zero_found",
         fmt::format("{}: heights are {:+.1f} m from those of the fixes (median), which is taken out", rows.source, zero),
         std::nullopt, 1});
    return result;
  }

  [[nodiscard]] std::optional<Linearised> linearise(const record::AidSample& sample, const FilterState& state,
                                                    const UpdateContext& context, int first_state) const override {
    const AntennaPrediction predicted = point_position(state, context, point_b_);
    Linearised m;
    m.kind = UpdateKind::kAid;
    m.H = -context.C_n_e.col(2).transpose() * predicted.H;
    double errors = 0.0;
    const int count = (offset_sd_ > 0.0 ? 1 : 0) + (drift_sd_ > 0.0 ? 1 : 0);
    for (int i = 0; i < count; ++i) {
      errors += state.x(first_state + i);
      m.H(0, first_state + i) = 1.0;
    }
    m.nu = Components::Constant(1, sample.value.x() - geo::geodetic_from_ecef(predicted.value_e).height - errors);
    m.R = ComponentCov::Constant(1, 1, sample.sd.x() * sample.sd.x());
    return m;
  }

 private:
  // Median difference from the fixes, each with the sample nearest in time.
  [[nodiscard]] static double zero_of(const std::vector<record::AidSample>& samples, const record::GnssRecording& gnss) {
    std::vector<double> differences;
    for (const record::GnssFix& fix : gnss.fixes) {
      const auto next = std::ranges::lower_bound(samples, fix.t, {}, &record::AidSample::t);
      constexpr double kNear = 2.0;  // s
      if (next == samples.end() || next->t - fix.t > kNear) continue;
      differences.push_back(next->value.x() - geo::geodetic_from_ecef(fix.r_ea_e).height);
    }
    if (differences.empty()) return 0.0;
    const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
    std::nth_element(differences.begin(), middle, differences.end());
    return *middle;
  }

  Eigen::Vector3d point_b_;
  double sd_;
  bool pressure_;
  double offset_sd_;
  double drift_sd_;
  double drift_time_s_;
  double interval_s_;
};

}  // namespace

AidKind height_kind() {
  return {
      "height", {"height_m"}, {"height_sd_m"}, [](const config::Node& node) { return std::make_shared<const Height>(node); }};
}

}  // namespace coast::estimate
