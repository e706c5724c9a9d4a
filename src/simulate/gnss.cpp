#include "coast/simulate/gnss.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "coast/simulate/random.hpp"

namespace coast::simulate {
namespace {

void require(bool holds, const char* what, double value, const char* expected) {
  if (!holds) throw std::invalid_argument(fmt::format("GnssOptions::{} is {}, expected {}", what, value, expected));
}

void check(const GnssOptions& o) {
  require(o.rate_hz >= 0.001 && o.rate_hz <= 1000.0, "rate_hz", o.rate_hz, "0.001 to 1000");
  require(o.phase >= 0.0, "phase", o.phase, "at least 0");
  require(o.sd.minCoeff() >= 0.0, "sd", o.sd.minCoeff(), "at least 0");
  if (o.correlated) {
    require(o.correlated->sd.minCoeff() >= 0.0, "correlated.sd", o.correlated->sd.minCoeff(), "at least 0");
    require(o.correlated->correlation_time > 0.0, "correlated.correlation_time", o.correlated->correlation_time, "above 0");
  }
  if (o.velocity_sd) require(o.velocity_sd->minCoeff() > 0.0, "velocity_sd", o.velocity_sd->minCoeff(), "above 0");
}

Eigen::Vector3d stated_sd(const GnssOptions& o) {
  if (o.stated_sd) return *o.stated_sd;
  if (!o.correlated) return o.sd;
  return (o.sd.cwiseAbs2() + o.correlated->sd.cwiseAbs2()).cwiseSqrt();
}

// Random streams of the run's seed: from 3 on, after gyro and accelerometer.
class PositionError {
 public:
  PositionError(const GnssOptions& options, std::uint64_t seed)
      : options_(options), white_(stream_seed(seed, {3})), walk_(stream_seed(seed, {4})) {
    if (!options.correlated) return;
    correlated_ = options.correlated->sd.cwiseProduct(draw(walk_));
    const double beta_dt = 1.0 / (options.rate_hz * options.correlated->correlation_time);
    phi_ = std::exp(-beta_dt);
    drive_ = std::sqrt(-std::expm1(-2.0 * beta_dt));
  }

  Eigen::Vector3d next() {
    Eigen::Vector3d error = options_.sd.cwiseProduct(draw(white_)) + correlated_;
    if (options_.correlated) correlated_ = phi_ * correlated_ + drive_ * options_.correlated->sd.cwiseProduct(draw(walk_));
    return error;
  }

  static Eigen::Vector3d draw(Normal& normal) {
    const double n = normal();
    const double e = normal();
    return {n, e, normal()};
  }

 private:
  const GnssOptions& options_;
  Normal white_, walk_;
  Eigen::Vector3d correlated_ = Eigen::Vector3d::Zero();
  double phi_ = 0.0;
  double drive_ = 0.0;
};

DegradedGnss quality_at(const GnssOptions& options, double t) {
  for (const DegradedGnss& degraded : options.degraded)
    if (degraded.when.contains(t)) return degraded;
  return {{}, record::FixQuality::kFixed, 1.0, 1.0};
}

}  // namespace

record::GnssRecording gnss_fixes(const AnalyticTrajectory& motion, geo::GpsTime start, const GnssOptions& options,
                                 std::uint64_t seed) {
  check(options);
  const Eigen::Vector3d stated = stated_sd(options);
  require(stated.minCoeff() > 0.0, "stated_sd", stated.minCoeff(), "above 0");
  PositionError position_error(options, seed);
  Normal velocity_noise(stream_seed(seed, {5}));
  record::GnssRecording recording;
  recording.source = "simulated";
  for (long k = 0;; ++k) {
    const double t = options.phase + static_cast<double>(k) / options.rate_hz;
    if (t > motion.duration()) return recording;
    const Eigen::Vector3d error_n = position_error.next();
    const Eigen::Vector3d velocity_error = PositionError::draw(velocity_noise);
    const double valid = t - options.time_offset;
    const bool withheld =
        std::any_of(options.gaps.begin(), options.gaps.end(), [&](const Interval& gap) { return gap.contains(t); });
    if (withheld || valid < 0.0 || valid > motion.duration()) continue;

    const Kinematics antenna = at_point(motion.at(valid), options.lever_arm_b);
    const Eigen::Matrix3d C_n_e = geo::C_n_e(geo::geodetic_from_ecef(antenna.r_eb_e));
    const DegradedGnss quality = quality_at(options, t);
    record::GnssFix fix;
    fix.t = start + t;
    fix.r_ea_e = antenna.r_eb_e + C_n_e * (quality.sd_factor * error_n);
    fix.position_cov_n = (quality.stated_sd_factor * stated).cwiseAbs2().asDiagonal();
    fix.quality = quality.quality;
    if (options.velocity_sd) {
      const Eigen::Vector3d sd = *options.velocity_sd;
      const Eigen::Vector3d v_ea_n = C_n_e.transpose() * antenna.v_eb_e + quality.sd_factor * sd.cwiseProduct(velocity_error);
      fix.velocity = record::GnssFix::Velocity{v_ea_n, (quality.stated_sd_factor * sd).cwiseAbs2().asDiagonal()};
    }
    recording.fixes.push_back(fix);
  }
}

}  // namespace coast::simulate
