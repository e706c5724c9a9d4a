#include "coast/carrier/single_point.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "coast/carrier/signals.hpp"

namespace coast::carrier {

namespace {

using record::SatelliteSystem;

constexpr double kNearEarth = 6.2e6;  // m from the centre: below, satellites and atmosphere are not modelled yet

/// The linearised problem at one position: rows scaled to unit variance. Unknowns: position, the clock of each system.
struct Linearised {
  Eigen::MatrixXd H;
  Eigen::VectorXd residual;
  std::vector<std::size_t> used;  ///< index of the measurement of each row
  std::vector<SatelliteSystem> clocks;
};

/// Sd of a code from one receiver: noise, multipath and residual errors of the atmosphere models, m.
double code_sd(double elevation) {
  constexpr double kZenith = 0.9;
  return kZenith / std::max(std::sin(elevation), 0.1);
}

class Problem {
 public:
  Problem(const std::vector<CodeMeasurement>& measurements, geo::GpsTime t, const AirModel& air, double mask)
      : measurements_(measurements), t_(t), air_(air), mask_(mask) {}

  Linearised at(const Eigen::Vector3d& r_e, const std::vector<bool>& left_out) const {
    const bool placed = r_e.norm() > kNearEarth;
    const geo::Geodetic receiver = placed ? geo::geodetic_from_ecef(r_e) : geo::Geodetic{};
    Linearised l;
    std::vector<std::pair<double, SignalPath>> rows;  // code minus model
    for (std::size_t i = 0; i < measurements_.size(); ++i) {
      if (left_out[i]) continue;
      const CodeMeasurement& m = measurements_[i];
      const SignalPath path = path_to(m.state, r_e, receiver, t_, placed && air_.troposphere);
      if (placed && path.direction.elevation < mask_) continue;
      double residual = m.code - path.modelled(m.state);
      if (placed && air_.ionosphere)
        residual -= m.iono_factor * klobuchar_delay(*air_.ionosphere, receiver, path.direction, t_);
      rows.emplace_back(residual, path);
      l.used.push_back(i);
      if (std::ranges::find(l.clocks, m.satellite.system) == l.clocks.end()) l.clocks.push_back(m.satellite.system);
    }
    const auto n = static_cast<Eigen::Index>(rows.size());
    l.H.setZero(n, 3 + static_cast<Eigen::Index>(l.clocks.size()));
    l.residual.resize(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto& [residual, path] = rows[static_cast<std::size_t>(i)];
      const CodeMeasurement& m = measurements_[l.used[static_cast<std::size_t>(i)]];
      const double weight = 1.0 / (m.noise * code_sd(placed ? path.direction.elevation : 1.0));
      l.H.block<1, 3>(i, 0) = -weight * path.to_satellite_e.transpose();
      l.H(i, 3 + (std::ranges::find(l.clocks, m.satellite.system) - l.clocks.begin())) = weight;
      l.residual(i) = weight * residual;
    }
    return l;
  }

 private:
  const std::vector<CodeMeasurement>& measurements_;
  geo::GpsTime t_;
  const AirModel& air_;
  double mask_;
};

struct Solved {
  Eigen::Vector3d r_e = Eigen::Vector3d::Zero();
  Linearised at;
  Eigen::VectorXd clocks;    ///< m
  Eigen::VectorXd residual;  ///< after adjustment, unit variance
  Eigen::MatrixXd covariance;
};

std::optional<Solved> solve(const Problem& problem, const Eigen::Vector3d& start_e, const std::vector<bool>& left_out) {
  constexpr int kIterations = 12;
  constexpr double kStill = 1e-4;       // m
  constexpr double kFarthest = 1e8;     // m
  constexpr double kBadlyPlaced = 1e4;  // m^2 of variance
  Solved s;
  s.r_e = start_e;
  for (int i = 0; i < kIterations; ++i) {
    s.at = problem.at(s.r_e, left_out);
    if (s.at.H.rows() < s.at.H.cols()) return std::nullopt;
    const Eigen::LDLT<Eigen::MatrixXd> normal(s.at.H.transpose() * s.at.H);
    const Eigen::VectorXd step = normal.solve(s.at.H.transpose() * s.at.residual);
    if (!step.allFinite()) return std::nullopt;
    s.r_e += step.head<3>();
    if (!(s.r_e.norm() < kFarthest)) return std::nullopt;
    s.clocks = step.tail(step.size() - 3);
    s.residual = s.at.residual - s.at.H * step;
    if (step.head<3>().norm() > kStill) continue;
    s.covariance = normal.solve(Eigen::MatrixXd::Identity(step.size(), step.size()));
    if (!s.covariance.allFinite() || !(s.covariance.topLeftCorner<3, 3>().trace() < kBadlyPlaced)) return std::nullopt;
    return s;
  }
  return std::nullopt;
}

/// The row whose error would explain the residuals best; none if all are plausible.
std::optional<Eigen::Index> outlier(const Solved& s) {
  constexpr double kSuspicious = 4.0;   // sd
  constexpr double kControlled = 0.05;  // fraction of an error visible in the residual
  Eigen::Index worst = -1;
  double largest = kSuspicious;
  const Eigen::MatrixXd G = s.at.H * s.covariance;
  for (Eigen::Index i = 0; i < s.residual.size(); ++i) {
    const double redundancy = 1.0 - G.row(i).dot(s.at.H.row(i));
    if (redundancy < kControlled) continue;
    const double w = std::abs(s.residual(i)) / std::sqrt(redundancy);
    if (w < largest) continue;
    largest = w;
    worst = i;
  }
  return worst < 0 ? std::nullopt : std::optional(worst);
}

std::optional<SinglePoint::Velocity> velocity(const Solved& s, const std::vector<CodeMeasurement>& measurements) {
  constexpr double kDopplerSd = 0.02;  // m/s at the zenith
  constexpr int kUnknowns = 4;
  Eigen::Matrix4d N = Eigen::Matrix4d::Zero();
  Eigen::Vector4d b = Eigen::Vector4d::Zero();
  int rows = 0;
  double squares = 0.0;
  for (std::size_t i = 0; i < s.at.used.size(); ++i) {
    const CodeMeasurement& m = measurements[s.at.used[i]];
    if (!m.range_rate) continue;
    const Eigen::Vector3d to_satellite = (m.state.r_e - s.r_e).normalized();
    const double expected = modelled_rate(m.state, s.r_e, Eigen::Vector3d::Zero());
    const double weight = std::max(to_satellite.dot(s.r_e.normalized()), 0.1);  // approximate sine of the elevation
    Eigen::Vector4d h;
    h << -to_satellite, 1.0;
    const double y = *m.range_rate - expected;
    N += weight * weight * h * h.transpose();
    b += weight * weight * h * y;
    squares += weight * weight * y * y;
    ++rows;
  }
  if (rows < kUnknowns) return std::nullopt;
  const Eigen::LDLT<Eigen::Matrix4d> normal(N);
  const Eigen::Vector4d x = normal.solve(b);
  const Eigen::Matrix4d covariance = normal.solve(Eigen::Matrix4d::Identity());
  if (!x.allFinite() || !covariance.allFinite()) return std::nullopt;
  const double spread = rows > kUnknowns ? std::max(0.0, squares - x.dot(b)) / (rows - kUnknowns) : 0.0;
  return SinglePoint::Velocity{x.head<3>(), std::max(spread, kDopplerSd * kDopplerSd) * covariance.topLeftCorner<3, 3>()};
}

}  // namespace

std::optional<SinglePoint> single_point(const std::vector<CodeMeasurement>& measurements, geo::GpsTime t,
                                        const Eigen::Vector3d& start_e, const AirModel& air, double elevation_mask) {
  const Problem problem(measurements, t, air, elevation_mask);
  std::vector<bool> left_out(measurements.size(), false);
  SinglePoint result;
  std::optional<Solved> s = solve(problem, start_e, left_out);
  if (s) s = solve(problem, s->r_e, left_out);  // with mask and atmosphere, which the first solution did not use
  while (s) {
    const std::optional<Eigen::Index> worst = outlier(*s);
    if (!worst) break;
    const std::size_t i = s->at.used[static_cast<std::size_t>(*worst)];
    left_out[i] = true;
    result.left_out.push_back(measurements[i].satellite);
    s = solve(problem, s->r_e, left_out);
  }
  if (!s) return std::nullopt;
  result.r_e = s->r_e;
  const double redundancy = static_cast<double>(s->at.H.rows() - s->at.H.cols());
  const double spread = redundancy > 0.0 ? std::max(1.0, s->residual.squaredNorm() / redundancy) : 1.0;
  result.covariance_e = spread * s->covariance.topLeftCorner<3, 3>();
  const auto gps = std::ranges::find(s->at.clocks, SatelliteSystem::kGps);
  result.clock_s = s->clocks(gps == s->at.clocks.end() ? 0 : gps - s->at.clocks.begin()) / kSpeedOfLight;
  result.satellites = static_cast<int>(s->at.used.size());
  result.velocity = velocity(*s, measurements);
  return result;
}

}  // namespace coast::carrier
