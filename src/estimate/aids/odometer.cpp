// Odometer: speed of wheels, or a count of their pulses.
//     z = (1 + k) |v + C (omega x p)|
// and where the wheels do not turn, 0 = v + C (omega x p). The speed over ground of a point of the axle that does not steer.
// Without its direction it needs no mounting angles; that the vehicle neither slides sideways nor lifts off is the business of
// the non-holonomic constraint.

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "aids.hpp"
#include "coast/geo/rotation.hpp"
#include "odometer_fit.hpp"

namespace coast::estimate {

namespace {

enum class OdometerUnit { kMetresPerSecond, kKilometresPerHour, kMilesPerHour, kKnots, kPulses };
constexpr std::array kSpeedOf{1.0, 1.0 / 3.6, 0.44704, 1852.0 / 3600.0, 1.0};
constexpr double kSlowest = 0.5;  // m/s: below it a speed has no direction in the filter's state

// Wheel sensors show zero below some speed too: a standstill is where they do so for a while. Between zero and the slowest
// speed that has a direction nothing is measured.
std::vector<record::AidSample> without_slow_motion(const std::vector<record::AidSample>& samples) {
  constexpr double kWhile = 1.0;  // s before and behind
  std::vector<record::AidSample> kept;
  for (std::size_t i = 0, turned = 0, turns = 0; i < samples.size(); ++i) {
    const record::AidSample& sample = samples[i];
    if (sample.value.x() != 0.0) {
      turned = i + 1;  // index of the last one that is not zero, and 1
      if (std::abs(sample.value.x()) >= kSlowest) kept.push_back(sample);
      continue;
    }
    for (turns = std::max(turns, i); turns < samples.size() && samples[turns].value.x() == 0.0;) ++turns;
    const bool stood = turned == 0 || sample.t - samples[turned - 1].t >= kWhile;
    const bool will_stand = turns == samples.size() || samples[turns].t - sample.t >= kWhile;
    if (stood && will_stand) kept.push_back(sample);
  }
  return kept;
}

class Odometer final : public Aid {
 public:
  explicit Odometer(const config::Node& node)
      : point_b_(node.vector3("point_m", Eigen::Vector3d::Zero())),
        sd_(node.number_within("sd_mps", 0.1, 1e-4, 10.0)),
        interval_s_(node.number_within("interval_s", 0.2, 0.01, 60.0)),
        scale_sd_(node.number_within("scale_sd", 0.01, 0.0, 1.0)) {
    const auto unit = node.choice("unit", {"m/s", "km/h", "mph", "kn", "pulses"}, 0);
    unit_ = static_cast<OdometerUnit>(unit);
    to_si_ = kSpeedOf.at(unit);
    // Read only if present: a default in the resolved file would state them.
    if (node.find("scale")) scale_ = node.number_within("scale", 1.0, 1e-6, 1e3);
    if (node.find("delay_s")) delay_s_ = node.number_within("delay_s", 0.0, -60.0, 60.0);
  }

  [[nodiscard]] std::vector<AidState> states() const override {
    if (scale_sd_ == 0.0) return {};
    return {{"scale", scale_sd_, 0.0}};
  }

  [[nodiscard]] std::vector<record::AidSample> samples(const record::AidRecording& rows, const record::GnssRecording& gnss,
                                                       record::Events& told) const override {
    record::AidRecording in_si = rows;
    for (record::AidSample& row : in_si.samples) row.value *= to_si_;
    const bool counts = unit_ == OdometerUnit::kPulses;
    const TravelledDistance distance = counts ? distance_by_count(in_si) : distance_by_speed(in_si);
    const OdometerFit fit = fit_odometer(distance, gnss, scale_, delay_s_);
    if (!fit.seen && counts && !scale_)
      throw InputError({rows.source, 0, "pulses of unknown length, and no fixes in motion to find it with",
                        "the length of a pulse", "Give `scale:`, metres per pulse."});
    refuse_misfit(fit, rows);
    tell(fit, rows, told);
    std::vector<record::AidSample> result = counts ? by_count(in_si, fit.scale) : by_speed(in_si);
    for (record::AidSample& sample : result) sample.t = sample.t - fit.delay_s;
    if (!counts)
      for (record::AidSample& sample : result) sample.value *= fit.scale;  // the stated sigma is that of a true speed
    return without_slow_motion(result);
  }

  [[nodiscard]] std::optional<Linearised> linearise(const record::AidSample& sample, const FilterState& state,
                                                    const UpdateContext& context, int first_state) const override {
    const Eigen::Matrix3d C_b_e = state.nav.q_b_e.toRotationMatrix();
    const Eigen::Vector3d of_arm = C_b_e * context.omega_eb_b.cross(point_b_);
    const Eigen::Vector3d v_e = state.nav.v_eb_e + of_arm;
    const double speed = v_e.norm();
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(3, context.layout.size());
    H.block<3, 3>(0, kVel).setIdentity();
    H.block<3, 3>(0, kPsi) = -geo::skew(of_arm);
    add_rate(-C_b_e * geo::skew(point_b_), context, H);
    Linearised m;
    m.kind = UpdateKind::kAid;
    if (sample.value.x() == 0.0) {
      m.nu = -v_e;
      m.H = std::move(H);
      m.R = sample.sd.x() * sample.sd.x() * Eigen::Matrix3d::Identity();
      return m;
    }
    if (speed < kSlowest) return std::nullopt;
    const double gain = 1.0 + (scale_sd_ > 0.0 ? state.x(first_state) : 0.0);
    const Eigen::RowVector3d along = gain * v_e.transpose() / speed;
    m.nu = Components::Constant(1, std::abs(sample.value.x()) - gain * speed);
    m.H = along * H;
    if (scale_sd_ > 0.0) m.H(0, first_state) = speed;
    m.R = ComponentCov::Constant(1, 1, sample.sd.x() * sample.sd.x());
    return m;
  }

 private:
  // Means of the rows of an interval, at their mean time.
  [[nodiscard]] std::vector<record::AidSample> by_speed(const record::AidRecording& rows) const {
    std::vector<record::AidSample> result;
    for (std::size_t i = 0; i < rows.samples.size();) {
      const record::AidSample& first = rows.samples[i];
      record::AidSample mean{first.t, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
      double since = 0.0, stated = 0.0, count = 0.0;
      for (; i < rows.samples.size() && rows.samples[i].t - first.t < interval_s_; ++i, count += 1.0) {
        since += rows.samples[i].t - first.t;
        mean.value += rows.samples[i].value;
        stated += rows.samples[i].sd.x() * to_si_;
      }
      mean.t = first.t + since / count;
      mean.value /= count;
      mean.sd.x() = stated > 0.0 ? stated / count : sd_;  // errors of neighbours are common: no division by the root
      result.push_back(mean);
    }
    return result;
  }

  // Differences of the count; each is off by up to one pulse.
  [[nodiscard]] std::vector<record::AidSample> by_count(const record::AidRecording& rows, double metres_per_pulse) const {
    std::vector<record::AidSample> result;
    const std::vector<record::AidSample>& s = rows.samples;
    for (std::size_t from = 0, to = 1; to < s.size(); ++to) {
      const double span = s[to].t - s[from].t;
      const double pulses = s[to].value.x() - s[from].value.x();
      if (pulses < 0.0 || s[to].t - s[to - 1].t > kLongestOdometerGap) {  // the counter was reset, or rows are missing
        from = to;
        continue;
      }
      if (span < interval_s_ - 1e-3) continue;
      const double quantum = metres_per_pulse / (span * std::sqrt(6.0));
      result.push_back(
          {s[from].t + 0.5 * span, {metres_per_pulse * pulses / span, 0.0, 0.0}, {std::hypot(sd_, quantum), 0.0, 0.0}});
      from = to;
    }
    return result;
  }

  // With a scale and a delay that have been fitted to something else, later outages would follow that.
  static void refuse_misfit(const OdometerFit& fit, const record::AidRecording& rows) {
    constexpr double kLargest = 0.2, kSmall = 0.05;
    const bool explains = fit.misfit < kSmall || fit.misfit < 0.5 * fit.spread;
    if (!fit.seen || (explains && fit.misfit < kLargest)) return;
    throw InputError(
        {rows.source, 0,
         fmt::format("over {} stretches between fixes the distances of the odometer differ from theirs by {:.0f} %, "
                     "whatever its scale and delay",
                     fit.stretches, 100.0 * fit.misfit),
         "wheel speeds or pulses of the vehicle that carries the antenna",
         "Check column, unit, week and time scale. With `scale` and `delay_s` stated it is used as it is."});
  }

  void tell(const OdometerFit& fit, const record::AidRecording& rows, record::Events& told) const {
    if (scale_ && delay_s_) return;
    if (!fit.seen) {
      told.push_back({record::Event::Severity::kWarning, "odometer_unchecked",
                      fmt::format("{}: too few fixes in motion to find scale and delay of the odometer: {:g} and {:g} s are "
                                  "used. Give `scale:` and `delay_s:`.",
                                  rows.source, fit.scale, fit.delay_s),
                      std::nullopt, 1});
      return;
    }
    constexpr double kLongestDelay = 1.0;  // s: longer ones are no delays of a bus
    const bool shifted = std::abs(fit.delay_s) > kLongestDelay;
    told.push_back(
        {shifted ? record::Event::Severity::kWarning : record::Event::Severity::kInfo, "odometer_found",
         fmt::format("{}: from {} stretches between fixes, the odometer's scale is {:.5g}{} and its rows are {:.3f} s {} "
                     "(`scale: {:.5g}`, `delay_s: {:.3f}`).{}",
                     rows.source, fit.stretches, fit.scale, unit_ == OdometerUnit::kPulses ? " m per pulse" : "",
                     std::abs(fit.delay_s), fit.delay_s < 0.0 ? "early" : "late", fit.scale, fit.delay_s,
                     shifted ? " Are its times UTC where GPS time is meant, or the other way round?" : ""),
         std::nullopt, 1});
  }

  Eigen::Vector3d point_b_;
  double sd_;
  double interval_s_;
  double scale_sd_;
  OdometerUnit unit_ = OdometerUnit::kMetresPerSecond;
  double to_si_ = 1.0;
  std::optional<double> scale_;
  std::optional<double> delay_s_;
};

}  // namespace

AidKind odometer_kind() {
  return {"odometer", {"speed_mps"}, {"speed_sd_mps"}, [](const config::Node& node) {
            return std::make_shared<const Odometer>(node);
          }};
}

}  // namespace coast::estimate
