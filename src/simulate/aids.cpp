#include "coast/simulate/aids.hpp"

#include <fmt/format.h>

#include <cmath>

#include "coast/geo/earth.hpp"
#include "coast/geo/units.hpp"
#include "coast/simulate/random.hpp"

namespace coast::simulate {

namespace {

using Kind = AidOptions::Kind;

std::string three(const Eigen::Vector3d& v) {
  return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v.x(), v.y(), v.z());
}

void read_odometer(const config::Node& node, AidOptions& o) {
  o.sd = node.number_within("sd_mps", 0.02, 0.0, 10.0);
  o.scale = node.number_within("scale", 1.0, 0.01, 100.0);
  if (node.find("metres_per_pulse")) o.metres_per_pulse = node.number_within("metres_per_pulse", 0.02, 1e-4, 100.0);
  if (const auto slips = node.find("slips"))
    for (const config::Node& item : slips->items())
      o.slips.push_back({{item.at("elapsed_s").number(), item.number_within("duration_s", 5.0, 0.01, 1e5)},
                         item.number_within("share", 0.1, -1.0, 10.0)});
}

void read_heading(const config::Node& node, AidOptions& o) {
  o.sd = geo::kDegree * node.number_within("sd_deg", 0.2, 0.0, 180.0);
  o.offset = geo::kDegree * node.number_within("offset_deg", 0.0, -360.0, 360.0);
  o.baseline_b = node.vector3("baseline_m", o.baseline_b);
  if (!(o.baseline_b.norm() > 0.0)) throw node.at("baseline_m").error("[0, 0, 0]", "a direction in the body");
}

void read_height(const config::Node& node, AidOptions& o) {
  o.sd = node.number_within("sd_m", 0.2, 0.0, 1e3);
  o.offset = node.number_within("offset_m", 0.0, -1e4, 1e4);
  const auto drift = node.find("drift");
  if (!drift) return;
  o.drift_sd = drift->number_within("sd_m", 1.0, 0.0, 1e3);
  o.drift_time_s = drift->number_within("correlation_time_s", 600.0, 1e-3, 1e9);
}

/// Readings one after the other, with the state that some of them have.
class Reader {
 public:
  Reader(const AnalyticTrajectory& motion, const AidOptions& options, std::uint64_t seed, std::size_t index)
      : motion_(motion),
        options_(options),
        white_(stream_seed(seed, {20, index, 1})),
        walk_(stream_seed(seed, {20, index, 2})),
        drift_(options.drift_sd * walk_()) {}

  /// @param t  s since the start of the mission, ascending
  double at(double t) {
    switch (options_.kind) {
      case Kind::kOdometer:
        return options_.metres_per_pulse ? pulses(t) : speed(t);
      case Kind::kHeading:
        return heading(t) / geo::kDegree;
      case Kind::kHeight:
        break;
    }
    return height(t);
  }

 private:
  [[nodiscard]] double shown_speed(double t) const {
    double speed = at_point(motion_.at(t), options_.point_b).v_eb_e.norm() / options_.scale;
    for (const AidOptions::Slip& slip : options_.slips)
      if (slip.when.contains(t)) speed *= 1.0 + slip.share;
    return speed;
  }
  // Wheels that stand show zero; a motion stops to within rounding.
  double speed(double t) {
    const double shown = shown_speed(t), noise = options_.sd * white_();
    constexpr double kStanding = 1e-3;  // m/s
    return shown > kStanding ? std::max(0.0, shown + noise) : 0.0;
  }
  // Counts of the distance, by the midpoint rule in steps of at most 5 ms.
  double pulses(double t) {
    constexpr double kStep = 0.005;
    const auto steps = std::max(1L, std::lround(std::ceil((t - counted_to_) / kStep)));
    const double step = (t - counted_to_) / static_cast<double>(steps);
    for (long i = 0; i < steps; ++i) distance_ += step * shown_speed(counted_to_ + (static_cast<double>(i) + 0.5) * step);
    counted_to_ = t;
    return std::floor(distance_ / *options_.metres_per_pulse);
  }
  double heading(double t) {
    const Kinematics body = motion_.at(t);
    const Eigen::Vector3d u_n =
        geo::C_n_e(geo::geodetic_from_ecef(body.r_eb_e)).transpose() * (body.C_b_e * options_.baseline_b);
    const double value = std::atan2(u_n.y(), u_n.x()) + options_.offset + options_.sd * white_();
    return value < 0.0 ? value + 2.0 * geo::kPi : value;
  }
  double height(double t) {
    const double phi = std::exp(-(t - drifted_to_) / options_.drift_time_s);
    drift_ = phi * drift_ + std::sqrt(1.0 - phi * phi) * options_.drift_sd * walk_();
    drifted_to_ = t;
    const Kinematics point = at_point(motion_.at(t), options_.point_b);
    return geo::geodetic_from_ecef(point.r_eb_e).height + options_.offset + drift_ + options_.sd * white_();
  }

  const AnalyticTrajectory& motion_;
  const AidOptions& options_;
  Normal white_, walk_;
  double drift_;
  double drifted_to_ = 0.0;
  double counted_to_ = 0.0;
  double distance_ = 0.0;
};

}  // namespace

AidOptions AidOptions::from(const config::Node& node) {
  AidOptions o;
  o.kind = static_cast<Kind>(node.at("kind").choice({"odometer", "heading", "height"}));
  o.rate_hz = node.number_within("rate_hz", 10.0, 0.01, 1000.0);
  o.delay_s = node.number_within("delay_s", 0.0, -10.0, 10.0);
  o.point_b = node.vector3("point_m", o.point_b);
  if (o.kind == Kind::kOdometer) read_odometer(node, o);
  if (o.kind == Kind::kHeading) read_heading(node, o);
  if (o.kind == Kind::kHeight) read_height(node, o);
  return o;
}

std::string AidOptions::name() const {
  return kind == Kind::kOdometer ? "odometer" : kind == Kind::kHeading ? "heading" : "height";
}

std::string AidOptions::column() const {
  if (kind == Kind::kOdometer) return metres_per_pulse ? "pulses" : "speed_mps";
  return kind == Kind::kHeading ? "heading_deg" : "height_m";
}

std::string AidOptions::run_keys() const {
  constexpr double kLeast = 1e-3;  // of a standard deviation that must not be zero
  switch (kind) {
    case Kind::kOdometer:
      return fmt::format(
          "point_m: {}, sd_mps: {:.17g}{}", three(point_b), std::max(sd, kLeast),
          metres_per_pulse ? ", unit: pulses, columns: {time: [gps_week, sow_s], value: pulses}, time: {kind: week_sow}" : "");
    case Kind::kHeading:
      return fmt::format("baseline_m: {}, sd_deg: {:.17g}, offset_sd_deg: {}", three(baseline_b),
                         std::max(sd, kLeast) / geo::kDegree, offset == 0.0 ? 0 : 5);
    case Kind::kHeight:
      break;
  }
  return fmt::format("point_m: {}, sd_m: {:.17g}, drift_sd_m: {:.17g}, drift_time_s: {:.17g}", three(point_b),
                     std::max(sd, kLeast), drift_sd, drift_time_s);
}

record::AidRecording aid_rows(const AnalyticTrajectory& motion, geo::GpsTime start, const AidOptions& options,
                              std::uint64_t seed, std::size_t index) {
  record::AidRecording rows;
  rows.source = "simulated";
  Reader reader(motion, options, seed, index);
  for (long k = 0;; ++k) {
    const double t = static_cast<double>(k) / options.rate_hz;
    if (t > motion.duration()) return rows;
    rows.samples.push_back({start + (t + options.delay_s), {reader.at(t), 0.0, 0.0}, Eigen::Vector3d::Zero()});
  }
}

}  // namespace coast::simulate
