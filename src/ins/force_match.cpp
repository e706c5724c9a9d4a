#include "force_match.hpp"

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "coast/ins/strapdown.hpp"
#include "force_observations.hpp"
#include "gnss_track.hpp"

namespace coast::ins {
namespace {

constexpr double kSideslip = 4.0 * geo::kDegree;       // course relative to body axis: mounting and drift, constant in a window
constexpr double kSlowest = 0.3, kCourseSigmas = 5.0;  // m/s
constexpr double kOverlap = 1.5;                       // neighbouring hats share a quarter of their noise
constexpr double kRateSpan = 0.02;                     // s to both sides, for the antenna's velocity relative to the IMU
constexpr int kGaussNewtonSteps = 60;
constexpr double kLinear = 0.1;  // rad of attitude change by a bias over a window up to which its effect is linear

using Matrix9 = Eigen::Matrix<double, 9, 9>;  // psi_e, gyro bias, accelerometer bias
using Vector9 = Eigen::Matrix<double, 9, 1>;

// Prediction of an observation from the IMU, for one value of the gyro bias: F - B b_a, with its derivative by the gyro bias.
struct Prediction {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  // mean of C_b(t)_b(0) f, antenna's, m/s^2
  Eigen::Matrix3d by_gyro_bias = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d by_accel_bias = Eigen::Matrix3d::Zero();  // mean of C_b(t)_b(0)
  Eigen::Matrix3d C_k = Eigen::Matrix3d::Identity();        // C_b(t_k)_b(0)
};

// Weight of a sample over (t - dt/2, t + dt/2]; a box weights the samples at its ends by overlap.
double weight(const ForceObservation& o, double t, double dt) {
  if (!o.hat) return std::clamp((std::min(o.t_b, t + 0.5 * dt) - std::max(o.t_a, t - 0.5 * dt)) / dt, 0.0, 1.0);
  if (t <= o.t_a || t >= o.t_b) return 0.0;
  return t < o.t_k ? (t - o.t_a) / (o.t_k - o.t_a) : (o.t_b - t) / (o.t_b - o.t_k);
}

// Position of the antenna relative to the IMU in the axes of b(0), with the derivative by the gyro bias, at the edges of the
// samples.
using Lever = Eigen::Matrix<double, 3, 4>;  // l, dl/db_g
struct LeverPath {
  std::vector<double> t;
  std::vector<Lever> l;

  [[nodiscard]] Lever at(double time) const {
    const auto behind = std::upper_bound(t.begin() + 1, t.end() - 1, time);
    const auto i = static_cast<std::size_t>(behind - t.begin());
    const double part = std::clamp((time - t[i - 1]) / (t[i] - t[i - 1]), 0.0, 1.0);
    return l[i - 1] + part * (l[i] - l[i - 1]);
  }
  [[nodiscard]] Lever velocity(double time) const {
    const double from = std::max(time - kRateSpan, t.front()), to = std::min(time + kRateSpan, t.back());
    return (at(to) - at(from)) / (to - from);
  }
  // The antenna's mean acceleration relative to the IMU: the derivatives of the weights act on the lever arm.
  [[nodiscard]] Lever acceleration(const ForceObservation& o) const {
    if (!o.hat) return (velocity(o.t_b) - velocity(o.t_a)) / (o.t_b - o.t_a);
    const Lever after = (at(o.t_b) - at(o.t_k)) / (o.t_b - o.t_k);
    const Lever before = (at(o.t_k) - at(o.t_a)) / (o.t_k - o.t_a);
    return 2.0 * (after - before) / (o.t_b - o.t_a);
  }
};

class Window {
 public:
  Window(const MatchInput& input, geo::GpsTime reference, std::vector<ForceObservation> observations)
      : input_(input), reference_(reference), observations_(std::move(observations)) {}

  [[nodiscard]] const std::vector<ForceObservation>& observations() const { return observations_; }

  // One pass over the samples; an observation overlaps at most its two neighbours.
  [[nodiscard]] std::vector<Prediction> predict(const Eigen::Vector3d& gyro_bias) const {
    std::vector<Prediction> predictions(observations_.size());
    std::vector<double> total(observations_.size(), 0.0);
    LeverPath path;
    path.t.push_back(0.0);
    path.l.push_back((Lever() << input_.lever_arm_b, Eigen::Matrix3d::Zero()).finished());
    Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
    Eigen::Matrix3d turned = Eigen::Matrix3d::Zero();  // integral of C_b(t)_b(0): response of the attitude to a bias
    RawIncrement previous;
    std::size_t oldest = 0;
    for (std::size_t i = input_.first; i <= input_.last; ++i) {
      const record::ImuSample& sample = input_.imu.samples[i];
      const double t = (sample.t - reference_) - 0.5 * sample.dt;
      const Eigen::Matrix3d C = q.toRotationMatrix();
      const RawIncrement raw{sample.dt, sample.dtheta - sample.dt * gyro_bias, sample.dv};
      const BodyIncrement body = compensate_two_sample(previous, raw);
      const Eigen::Vector3d dv = C * body.u;
      while (oldest < observations_.size() && observations_[oldest].t_b < t - 0.5 * sample.dt) ++oldest;
      for (std::size_t j = oldest; j < observations_.size() && observations_[j].t_a < t + 0.5 * sample.dt; ++j) {
        const double w = weight(observations_[j], t, sample.dt);
        predictions[j].force += w * dv;
        predictions[j].by_gyro_bias += w * geo::skew(dv) * turned;
        predictions[j].by_accel_bias += (w * sample.dt) * C;
        if (t < observations_[j].t_k) predictions[j].C_k = C;
        total[j] += w * sample.dt;
      }
      turned += sample.dt * C;
      q = (q * geo::quaternion_from_rotation_vector(body.phi)).normalized();
      previous = raw;
      path.t.push_back(t + 0.5 * sample.dt);
      const Eigen::Vector3d l = q * input_.lever_arm_b;
      path.l.push_back((Lever() << l, geo::skew(l) * turned).finished());
    }
    for (std::size_t j = 0; j < predictions.size(); ++j) {
      const Lever lever = path.acceleration(observations_[j]);
      predictions[j].force = predictions[j].force / total[j] + lever.col(0);
      predictions[j].by_gyro_bias = predictions[j].by_gyro_bias / total[j] + lever.rightCols<3>();
      predictions[j].by_accel_bias /= total[j];
    }
    return predictions;
  }

 private:
  const MatchInput& input_;
  geo::GpsTime reference_;
  std::vector<ForceObservation> observations_;
};

// Rotation of the IMU's forces to those of GNSS, closed form (Wahba 1965; Markley 1988).
Eigen::Matrix3d wahba(const std::vector<ForceObservation>& observations, const std::vector<Prediction>& predictions) {
  Eigen::Matrix3d B = Eigen::Matrix3d::Zero();
  for (std::size_t j = 0; j < observations.size(); ++j) B += observations[j].force_i * predictions[j].force.transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(B, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = svd.matrixU().determinant() * svd.matrixV().determinant();
  return svd.matrixU() * Eigen::Vector3d(1.0, 1.0, sign).asDiagonal() * svd.matrixV().transpose();
}

struct Estimate {
  Eigen::Matrix3d C = Eigen::Matrix3d::Identity();  // body at the reference to i
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_bias = Eigen::Vector3d::Zero();
  Matrix9 covariance = Matrix9::Zero();
  double variance = 0.0;  // of an observation in excess of that of GNSS
  double cost = 0.0;      // -2 log likelihood
};

// Normal equations of one linearisation; returns the cost at the estimate.
struct Normal {
  Matrix9 N = Matrix9::Zero();
  Vector9 b = Vector9::Zero();
  double cost = 0.0;
};

// The body's velocity across the course is only sideslip: one unknown angle for the window, plus noise of the course.
void add_course(const std::vector<ForceObservation>& observations, const std::vector<Prediction>& predictions,
                const Estimate& x, Normal& normal) {
  std::vector<std::size_t> moving;
  for (std::size_t j = 0; j < observations.size(); ++j) {
    const double speed = observations[j].velocity_i.norm();
    if (speed > kSlowest && speed > kCourseSigmas * observations[j].velocity_sd) moving.push_back(j);
  }
  if (moving.empty()) return;
  const auto count = static_cast<double>(moving.size());
  double ahead = 0.0;
  for (const std::size_t j : moving) {
    const Eigen::Vector3d course = observations[j].velocity_i.normalized();
    const double noise = observations[j].velocity_sd / observations[j].velocity_i.norm();
    const double information = 1.0 / (kSideslip * kSideslip * count + noise * noise);
    const Eigen::Matrix3d C_i_b = (x.C * predictions[j].C_k).transpose();
    const Eigen::Vector3d v_b = C_i_b * course;
    const Eigen::RowVector3d H = (C_i_b * geo::skew(course)).row(1);
    normal.N.topLeftCorner<3, 3>() += information * H.transpose() * H;
    normal.b.head<3>() -= information * H.transpose() * v_b.y();
    normal.cost += information * v_b.y() * v_b.y();
    ahead += v_b.x() / count;
  }
  // Sideslip does not detect driving backwards: forward is preferred by 3 sigma, which the forces may outweigh.
  if (ahead < 0.0) normal.cost += 9.0;
}

Normal linearise(const MatchInput& input, const std::vector<ForceObservation>& observations,
                 const std::vector<Prediction>& predictions, Estimate& x) {
  double excess = 0.0;
  std::vector<Eigen::Vector3d> residuals(observations.size());
  for (std::size_t j = 0; j < observations.size(); ++j) {
    residuals[j] = observations[j].force_i - x.C * (predictions[j].force - predictions[j].by_accel_bias * x.accel_bias);
    excess += residuals[j].squaredNorm() / 3.0 - observations[j].variance;
  }
  x.variance = std::max(1e-6, excess / static_cast<double>(observations.size()));
  Normal normal;
  for (std::size_t j = 0; j < observations.size(); ++j) {
    const double variance = observations[j].variance + x.variance;
    const double squared = residuals[j].squaredNorm() / variance;
    const double robust = squared > 16.0 ? 4.0 / std::sqrt(squared) : 1.0;  // Huber, for wrong fixes
    Eigen::Matrix<double, 3, 9> H;
    H << -geo::skew(x.C * predictions[j].force), x.C * predictions[j].by_gyro_bias, -x.C * predictions[j].by_accel_bias;
    normal.N += (robust / variance) * H.transpose() * H;
    normal.b += (robust / variance) * H.transpose() * residuals[j];
    normal.cost += 3.0 * std::log(variance) + (robust < 1.0 ? 8.0 * std::sqrt(squared) - 16.0 : squared);
  }
  if (input.vehicle_forward) add_course(observations, predictions, x, normal);
  const auto prior = [&](int at, const Eigen::Vector3d& deviation, double sd) {
    normal.N.diagonal().segment<3>(at).array() += 1.0 / (sd * sd);
    normal.b.segment<3>(at) -= deviation / (sd * sd);
    normal.cost += deviation.squaredNorm() / (sd * sd);
  };
  prior(3, x.gyro_bias - input.gyro_bias, input.gyro_bias_sd);
  prior(6, x.accel_bias, input.accel_bias_sd);
  normal.N.diagonal().head<3>().array() += 1e-2;  // 10 rad: keeps an unobservable heading finite, without other effect
  return normal;
}

// The predictions for a nearby bias.
std::vector<Prediction> moved(std::vector<Prediction> predictions, const Eigen::Vector3d& by) {
  for (Prediction& one : predictions) one.force += one.by_gyro_bias * by;
  return predictions;
}

// Gauss-Newton, with a bound on the step: a distant heading must rotate without overshooting. Samples are processed again if
// the bias has moved beyond the range of its linear effect, and at convergence, until it has converged at a bias for which they
// were processed.
Estimate refine(const MatchInput& input, const Window& window, Estimate x) {
  constexpr double kRests = 1e-6;  // rad
  const double seconds = window.observations().back().t_b;
  Eigen::Vector3d predicted_at = x.gyro_bias;
  std::vector<Prediction> predictions = window.predict(x.gyro_bias);
  for (int iteration = 0; iteration < kGaussNewtonSteps; ++iteration) {
    const Eigen::Vector3d off = x.gyro_bias - predicted_at;
    const Normal normal = linearise(input, window.observations(), moved(predictions, off), x);
    const Eigen::LDLT<Matrix9> solver(normal.N);
    Vector9 dx = solver.solve(normal.b);
    x.covariance = solver.solve(Matrix9::Identity());
    x.cost = normal.cost;
    const double angle = dx.head<3>().norm();
    if (angle > 0.5) dx *= 0.5 / angle;
    x.C = geo::rotation_matrix(dx.head<3>()) * x.C;
    x.gyro_bias += dx.segment<3>(3);
    x.accel_bias += dx.tail<3>();
    const double turned = seconds * (x.gyro_bias - predicted_at).norm();
    if (angle < kRests && turned < kRests) break;
    if (angle >= kRests && turned < kLinear) continue;
    predicted_at = x.gyro_bias;
    predictions = window.predict(x.gyro_bias);
  }
  return x;
}

}  // namespace

std::optional<MatchResult> match_specific_force(const MatchInput& input) {
  const record::ImuSample& first = input.imu.samples[input.first];
  const geo::GpsTime reference = first.t - first.dt;
  const Window window(input, reference, observe_specific_force(input.gnss, reference, input.imu.samples[input.last].t));
  const std::size_t count = window.observations().size();
  if (count < 4) return std::nullopt;

  Estimate start;
  start.gyro_bias = input.nearby_gyro_bias;
  start.C = wahba(window.observations(), window.predict(start.gyro_bias));
  const Eigen::Vector3d up = input.gnss.fixes.front().r_ea_e.normalized();
  std::array<Estimate, 4> candidates;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    Estimate turned = start;
    turned.C = Eigen::AngleAxisd(0.5 * geo::kPi * static_cast<double>(i), up).toRotationMatrix() * start.C;
    candidates[i] = refine(input, window, turned);
  }
  std::sort(candidates.begin(), candidates.end(), [](const Estimate& a, const Estimate& b) { return a.cost < b.cost; });
  const Estimate& best = candidates.front();

  MatchResult result;
  result.C_b_e = best.C;
  result.psi_covariance_e = kOverlap * best.covariance.topLeftCorner<3, 3>();
  result.gyro_bias = best.gyro_bias;
  result.accel_bias = best.accel_bias;
  result.gyro_bias_sd = std::sqrt(kOverlap) * axis_sd(best.covariance.block<3, 3>(3, 3));
  result.residual_sd = std::sqrt(best.variance);
  for (const ForceObservation& o : window.observations())
    result.horizontal_force += (o.force_i - up * up.dot(o.force_i)).squaredNorm() / static_cast<double>(count);
  result.horizontal_force = std::sqrt(result.horizontal_force);
  result.observations = count;
  result.lead = std::numeric_limits<double>::infinity();
  for (const Estimate& other : candidates) {
    const double apart = geo::rotation_vector(Eigen::Quaterniond(other.C * best.C.transpose())).norm();
    if (apart > 0.2) result.lead = std::min(result.lead, other.cost - best.cost);
  }
  return result;
}

}  // namespace coast::ins
