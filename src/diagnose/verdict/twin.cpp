#include "coast/diagnose/twin.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/ins/strapdown.hpp"
#include "coast/simulate/random.hpp"
#include "coast/simulate/sensor_errors.hpp"

namespace coast::diagnose {

namespace {

/// Increments that propagate a trajectory's attitude and velocity from epoch to epoch by the filter's own mechanisation.
class InverseStrapdown {
 public:
  explicit InverseStrapdown(const record::NavState& start) : at_(start) {}

  /// @param guess  an approximate increment, over the whole step to the target
  ins::RawIncrement to(const record::NavState& target, ins::RawIncrement guess) {
    constexpr int kRounds = 3;  // each reduces the error to a thousandth: coning and the rotation within the step are small
    ins::Strapdown end = at_;
    for (int i = 0; i <= kRounds; ++i) {
      end = at_;
      end.step(ins::compensate_two_sample(previous_, guess));
      if (i == kRounds) break;
      const Eigen::AngleAxisd turn(end.state().q_b_e.conjugate() * target.q_b_e);
      guess.dtheta += turn.angle() * turn.axis();
      guess.dv += end.state().q_b_e.conjugate() * (target.v_eb_e - end.state().v_eb_e);
    }
    end.set_time(target.t);
    at_ = end;
    previous_ = guess;
    return guess;
  }
  [[nodiscard]] const record::NavState& state() const { return at_.state(); }

 private:
  ins::Strapdown at_;
  ins::RawIncrement previous_;
};

struct ErrorFree {
  record::ImuRecording imu;             ///< body axes
  std::vector<record::NavState> truth;  ///< at the ends of its samples, and before the first
};

ErrorFree error_free(const std::vector<record::NavState>& path, const record::ImuRecording& recorded) {
  ErrorFree result;
  result.imu.source = "twin of " + recorded.source;
  result.imu.rate_hz = recorded.rate_hz;
  InverseStrapdown inverse(path.front());
  result.truth.push_back(path.front());
  auto target = path.begin() + 1;
  for (std::size_t i = 0; i < recorded.samples.size() && target != path.end(); ++i) {
    const record::ImuSample& sample = recorded.samples[i];
    if (!(sample.t > path.front().t)) continue;
    while (target != path.end() && target->t < sample.t - 1e-9) ++target;
    if (target == path.end()) break;
    const double step = target->t - inverse.state().t;
    const double scale = step / sample.dt;  // a gap before the sample belongs to the step
    const ins::RawIncrement whole = inverse.to(*target, {step, scale * sample.dtheta, scale * sample.dv});
    result.imu.samples.push_back({sample.t, sample.dt, whole.dtheta / scale, whole.dv / scale});
    if (!recorded.temperature.empty()) result.imu.temperature.push_back(recorded.temperature[i]);
    result.truth.push_back(inverse.state());
  }
  return result;
}

/// White and correlated errors of fixes, N, E, D.
class FixErrors {
 public:
  FixErrors(const estimate::FilterOptions& options, std::uint64_t seed) : options_(options), normal_(seed) {
    for (double& x : wandering_) x = normal_();
  }
  Eigen::Vector3d position(const record::GnssFix& fix) {
    const estimate::GnssScale& scale = options_.gnss_scale;
    const estimate::CorrelatedGnss& correlated = options_.auxiliary.correlated_gnss;
    const Eigen::Vector3d factor(scale.horizontal, scale.horizontal, scale.vertical);
    const double phi = before_ ? std::exp(-(fix.t - *before_) / correlated.time_s) : 0.0;
    for (double& x : wandering_) x = phi * x + std::sqrt(1.0 - phi * phi) * normal_();
    before_ = fix.t;
    const Eigen::Vector3d sd(correlated.horizontal_m, correlated.horizontal_m, correlated.vertical_m);
    return factor.cwiseProduct(white(fix.position_cov_n)) + sd.cwiseProduct(wandering_);
  }
  Eigen::Vector3d velocity(const Eigen::Matrix3d& cov_n) { return options_.gnss_scale.velocity * white(cov_n); }

 private:
  Eigen::Vector3d white(const Eigen::Matrix3d& cov_n) {
    Eigen::Vector3d draw;
    for (double& x : draw) x = normal_();
    return cov_n.llt().matrixL() * draw;
  }
  const estimate::FilterOptions& options_;
  simulate::Normal normal_;
  Eigen::Vector3d wandering_;
  std::optional<geo::GpsTime> before_;
};

record::GnssRecording fixes_along(const ErrorFree& mission, const MissionInput& model, std::uint64_t seed) {
  record::GnssRecording gnss;
  gnss.source = "twin of " + model.gnss.source;
  FixErrors errors(model.setup.filter, simulate::stream_seed(seed, {2}));
  const Eigen::Vector3d earth_e(0.0, 0.0, geo::kEarthRate);
  for (record::GnssFix fix : model.gnss.fixes) {
    const Eigen::Vector3d error_n = errors.position(fix);
    const geo::GpsTime t = fix.t - model.setup.time_offset_s;
    const auto behind = std::ranges::lower_bound(mission.truth, t, {}, &record::NavState::t);
    if (behind == mission.truth.begin() || behind == mission.truth.end()) continue;
    const record::NavState& a = *std::prev(behind);
    const record::NavState& b = *behind;
    const double step = b.t - a.t;
    const double s = (t - a.t) / step;
    const Eigen::Vector3d acceleration = (b.v_eb_e - a.v_eb_e) / step;
    const double since = t - a.t;
    const Eigen::Matrix3d C_b_e = a.q_b_e.slerp(s, b.q_b_e).toRotationMatrix();
    const record::ImuSample& sample = mission.imu.samples[static_cast<std::size_t>(behind - mission.truth.begin()) - 1];
    const Eigen::Vector3d omega_eb_b = sample.dtheta / sample.dt - C_b_e.transpose() * earth_e;
    const Eigen::Vector3d arm_b = model.setup.lever_arm_b;
    const Eigen::Vector3d r = a.r_eb_e + since * a.v_eb_e + 0.5 * since * since * acceleration;
    const Eigen::Matrix3d C_n_e = geo::C_n_e(geo::geodetic_from_ecef(r));
    fix.r_ea_e = r + C_b_e * arm_b + C_n_e * error_n;
    if (fix.velocity)
      fix.velocity->v_ea_n = C_n_e.transpose() * (a.v_eb_e + since * acceleration + C_b_e * omega_eb_b.cross(arm_b)) +
                             errors.velocity(fix.velocity->cov_n);
    gnss.fixes.push_back(fix);
  }
  return gnss;
}

void rotate(record::ImuRecording& imu, const Eigen::Matrix3d& C) {
  for (record::ImuSample& sample : imu.samples) {
    sample.dtheta = C * sample.dtheta;
    sample.dv = C * sample.dv;
  }
}

}  // namespace

MissionInput twin(const std::vector<record::NavState>& path, const MissionInput& model, std::uint64_t seed) {
  ErrorFree mission = error_free(path, model.imu);
  MissionInput result{{}, fixes_along(mission, model, seed), model.setup};
  rotate(mission.imu, model.setup.C_s_b.transpose());
  result.imu = simulate::with_errors(mission.imu, model.setup.model, simulate::stream_seed(seed, {1}));
  result.imu.temperature = mission.imu.temperature;
  rotate(result.imu, model.setup.C_s_b);
  result.setup.high_order_compensation = false;
  result.setup.restarts.reset();  // they are of the recording: the twin has fixes of its own behind its gaps
  result.setup.antenna_found.reset();
  return result;
}

}  // namespace coast::diagnose
