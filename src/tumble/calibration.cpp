#include "coast/tumble/calibration.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "adjustment.hpp"
#include "coast/record/error.hpp"
#include "start.hpp"

namespace coast::tumble {

namespace {

constexpr std::size_t kFewestRests = 9;  ///< bias and symmetric gain of the accelerometers
constexpr double kOutlier = 25.0;        ///< chi-square of three degrees of freedom: once in 60 000
constexpr int kMostSteps = 60;

/// State, equations and solution that belong together.
struct Adjusted {
  State state;
  std::vector<Observation> observations;
  std::vector<Turn> turns;
  Eigen::MatrixXd covariance;
  Variances levels{};
  double misfit = 0.0;  ///< minus twice the log-likelihood of the residuals, less a constant
};

Eigen::Vector3d remaining(const Observation& o, const Eigen::VectorXd& change) {
  const auto own = static_cast<Eigen::Index>(Common::kCount + Pose::kCount * o.rest);
  Eigen::Vector3d e = o.residual - o.common * change.head<Common::kCount>() - o.own * change.segment<Pose::kCount>(own);
  if (o.pair) e -= o.next * change.segment<Pose::kCount>(own + Pose::kCount);
  return e;
}

// One step of restricted maximum likelihood: each level is multiplied by its observed over its expected sum of squares.
// Förstner (1979); fixed point of the REML equations.
Variances updated(const std::vector<Observation>& observations, const Solution& solution, const Variances& levels) {
  std::array<double, kKinds> observed{};
  std::array<double, kKinds> expected{};
  for (const Observation& o : observations) {
    if (!o.used || o.shape == 0.0) continue;
    const auto kind = static_cast<std::size_t>(o.kind);
    const Eigen::Vector3d W = noise(o, levels).cwiseInverse();
    const Eigen::Vector3d weighted = W.cwiseProduct(remaining(o, solution.change));
    const Eigen::Vector3d P = predicted(o, solution.covariance).diagonal();
    observed[kind] += o.shape * weighted.squaredNorm();
    expected[kind] += o.shape * (W.array() - W.array().square() * P.array()).max(0.0).sum();
  }
  Variances next = levels;
  for (std::size_t kind = 0; kind < kKinds; ++kind)
    if (expected[kind] > 0.0) next[kind] *= std::clamp(observed[kind] / expected[kind], 1e-3, 1e3);
  return next;
}

bool settled(const Variances& a, const Variances& b, const std::vector<Observation>& observations) {
  std::array<double, kKinds> white{};
  for (const Observation& o : observations)
    if (o.shape > 0.0)
      white[static_cast<std::size_t>(o.kind)] = std::max(white[static_cast<std::size_t>(o.kind)], o.white.maxCoeff() / o.shape);
  for (std::size_t kind = 0; kind < kKinds; ++kind)
    if (std::abs(a[kind] - b[kind]) > 1e-3 * (a[kind] + white[kind])) return false;
  return true;
}

void adjust(Adjusted& fit, const record::ImuRecording& sensor, const std::vector<Rest>& rests, const Options& options,
            const std::vector<bool>& left_out) {
  for (int step = 0; step < kMostSteps; ++step) {
    fit.observations = linearised(sensor, rests, options, fit.state, fit.turns);
    for (std::size_t i = 0; i < fit.observations.size(); ++i)
      fit.observations[i].used = fit.observations[i].used && !left_out[i];
    const Solution solution = solve(fit.observations, options, fit.state, fit.levels);
    if (!solution.change.allFinite()) throw NumericalError(sensor.source, "", "the adjustment of the poses does not converge");
    add(fit.state, solution.change);
    fit.covariance = solution.covariance;
    // Change of the unknowns that matter, in standard deviations.
    const auto common = solution.change.head<Common::kCount>().array();
    const double moved = (common.abs() / fit.covariance.diagonal().head<Common::kCount>().array().sqrt().max(1e-12)).maxCoeff();
    if (step < 2) continue;  // far away the residuals are those of the linearisation
    const Variances next = updated(fit.observations, solution, fit.levels);
    const bool done = moved < 1e-2 && settled(fit.levels, next, fit.observations);
    fit.levels = next;
    if (done) break;
  }
  fit.observations = linearised(sensor, rests, options, fit.state, fit.turns);
  fit.misfit = 0.0;
  for (std::size_t i = 0; i < fit.observations.size(); ++i) {
    Observation& o = fit.observations[i];
    o.used = o.used && !left_out[i];
    if (!o.used) continue;
    const Eigen::Array3d variance = noise(o, fit.levels);
    fit.misfit += (o.residual.array().square() / variance + variance.log()).sum();
  }
}

/// Chi-square of the redundant part of an observation.
double chi_square(const Observation& o, const Adjusted& fit) {
  const Eigen::Vector3d sd = noise(o, fit.levels).cwiseSqrt();
  const Eigen::Vector3d e = o.residual.cwiseQuotient(sd);
  const Eigen::Matrix3d share = sd.cwiseInverse().asDiagonal() * predicted(o, fit.covariance) * sd.cwiseInverse().asDiagonal();
  if (!o.used) {  // not part of the estimate: its errors add to those of the prediction
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(Eigen::MatrixXd(Eigen::Matrix3d::Identity() + share));
    const Eigen::VectorXd along = eigen.eigenvectors().transpose() * Eigen::VectorXd(e);
    return (along.array().square() / eigen.eigenvalues().array()).sum();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(Eigen::MatrixXd(Eigen::Matrix3d::Identity() - share));
  double sum = 0.0;
  for (Eigen::Index i = 0; i < 3; ++i)
    if (const double redundancy = eigen.eigenvalues()[i]; redundancy > 0.02) {
      const double along = eigen.eigenvectors().col(i).dot(Eigen::VectorXd(e));
      sum += along * along / redundancy;
    }
  return sum;
}

// Leaves out, one after the other, what contradicts all the rest.
void without_outliers(Adjusted& fit, const record::ImuRecording& sensor, const std::vector<Rest>& rests, const Options& options,
                      const std::function<void(double)>& progress) {
  std::vector<bool> left_out(4 * rests.size(), false);
  const std::size_t most = std::max<std::size_t>(1, rests.size() / 5);
  for (std::size_t count = 0; count <= most; ++count) {
    if (progress) progress(static_cast<double>(count) / static_cast<double>(most + 1));
    adjust(fit, sensor, rests, options, left_out);
    std::size_t worst = 0;
    double most_found = 0.0;
    for (std::size_t i = 0; i < fit.observations.size(); ++i) {
      const Observation& o = fit.observations[i];
      if (!o.used || (o.kind != Kind::kForce && o.kind != Kind::kTurn)) continue;
      if (const double found = chi_square(o, fit); found > most_found) {
        most_found = found;
        worst = i;
      }
    }
    if (most_found <= kOutlier || count == most) break;
    left_out[worst] = true;
  }
}

record::ImuCalibration calibration_of(const Adjusted& fit) {
  using C = record::ImuCalibration;
  const Common& common = fit.state.common;
  const auto poses = static_cast<double>(fit.state.poses.size());
  C found;
  found.accel = {common.accel_gain, common.accel_bias};
  found.gyro.gain = common.gyro_gain;
  // J: the 24 values from the unknowns.
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(C::kValues, fit.covariance.rows());
  for (int axis = 0; axis < 3; ++axis) J(C::kAccel + axis, Common::kAccelBias + axis) = 1.0;
  for (int k = 0; k < 6; ++k) {
    const auto [row, column] = kSymmetric[static_cast<std::size_t>(k)];
    J(C::kAccel + 3 + 3 * row + column, Common::kAccelGain + k) = 1.0;
    J(C::kAccel + 3 + 3 * column + row, Common::kAccelGain + k) = 1.0;
  }
  for (int i = 0; i < 9; ++i) J(C::kGyro + 3 + i, Common::kGyroGain + i) = 1.0;
  for (std::size_t p = 0; p < fit.state.poses.size(); ++p) {
    found.gyro.bias += fit.state.poses[p].gyro_bias / poses;
    for (int axis = 0; axis < 3; ++axis)
      J(C::kGyro + axis, static_cast<Eigen::Index>(Common::kCount + Pose::kCount * p + 3) + axis) = 1.0 / poses;
  }
  const Eigen::MatrixXd covariance = J * fit.covariance * J.transpose();
  found.covariance = 0.5 * (covariance + covariance.transpose());
  return found;
}

double level_of(const Adjusted& fit, Kind kind) {
  return std::sqrt(fit.levels[static_cast<std::size_t>(kind)]);
}

Result result_of(const Adjusted& fit, const std::vector<Rest>& rests, const Options& options) {
  Result result;
  result.calibration = calibration_of(fit);
  result.gravity = fit.state.common.gravity;
  result.gravity_sd = std::sqrt(fit.covariance(Common::kGravity, Common::kGravity));
  result.levels = {level_of(fit, Kind::kForce), level_of(fit, Kind::kTurn), level_of(fit, Kind::kWalk)};
  for (std::size_t i = 0; i < rests.size(); ++i) {
    RestFit& rest = result.rests.emplace_back();
    rest.rest = rests[i];
    rest.up = -fit.state.poses[i].C_b_n.transpose().col(2);
    rest.gyro_bias = fit.state.poses[i].gyro_bias;
  }
  for (const Observation& o : fit.observations) {
    if (o.used) {
      const Eigen::Vector3d W = noise(o, fit.levels).cwiseInverse();
      result.redundancy += 3.0 - W.dot(predicted(o, fit.covariance).diagonal());
    }
    if (o.kind == Kind::kForce) {
      RestFit& rest = result.rests[o.rest];
      rest.accel_residual = o.residual;
      rest.chi_square = chi_square(o, fit);
      rest.used = o.used;
    } else if (o.kind == Kind::kTurn) {
      const Turn& turn = fit.turns[o.rest];
      result.turns.push_back({o.rest, turn.duration, turn.turned, o.residual, chi_square(o, fit), o.used});
    }
  }
  if (options.latitude) result.heading_sd = std::sqrt(fit.covariance(Common::kCount + 2, Common::kCount + 2));
  const auto gravity = fit.covariance.col(Common::kGravity).head<9>();
  result.accel_covariance =
      fit.covariance.topLeftCorner<9, 9>() - gravity * gravity.transpose() / fit.covariance(Common::kGravity, Common::kGravity);
  return result;
}

}  // namespace

Result calibrate(const record::ImuRecording& sensor, const Options& options, const std::function<void(double)>& progress) {
  const std::vector<Rest> rests = find_rests(sensor);
  if (rests.size() < kFewestRests)
    throw InputError({sensor.source, 0, fmt::format("{} rests of 1.5 s and more", rests.size()),
                      fmt::format("{} or more, in different poses", kFewestRests),
                      "Put the IMU down for a few seconds in each of some twenty poses, and turn it by hand between them."});
  // Where the Earth's rate is used, the heading of the first pose is one of four.
  std::optional<Adjusted> best;
  const int headings = options.latitude ? 4 : 1;
  for (int k = 0; k < headings; ++k) {
    Adjusted fit;
    fit.state = start_of(sensor, rests, options, k * std::numbers::pi / 2.0);
    if (k == 0) require_agreement(sensor, rests, options, fit.state);
    fit.levels = {1e-4, 0.0, 1e-4, 1e-10};
    without_outliers(fit, sensor, rests, options, [&](double share) {
      if (progress) progress((k + share) / headings);
    });
    if (!best || fit.misfit < best->misfit) best = std::move(fit);
  }
  return result_of(*best, rests, options);
}

}  // namespace coast::tumble
