#include "coast/estimate/noise_fit.hpp"

#include <LBFGSB.h>
#include <tbb/parallel_for.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "coast/record/error.hpp"

namespace coast::estimate {

noise::ImuErrorModel adjusted(const noise::ImuErrorModel& model, const NoiseAdjustment& adjustment) {
  return model.with_white_noise_scaled(noise::Sensor::kGyro, adjustment.gyro_factor)
      .with_white_noise_scaled(noise::Sensor::kAccel, adjustment.accel_factor);
}

FilterOptions adjusted(const FilterOptions& options, const NoiseAdjustment& adjustment) {
  FilterOptions result = options;
  result.gnss_scale = adjustment.gnss_scale;
  result.auxiliary.correlated_gnss = adjustment.correlated_gnss;
  return result;
}

namespace {

/// One free parameter: where it lives and its bounds (natural units; optimised as logarithm).
struct Parameter {
  std::string name;
  std::function<double&(NoiseAdjustment&)> value;
  double low;
  double high;
};

std::vector<Parameter> free_parameters(const NoiseFitChoice& choice, bool velocities) {
  std::vector<Parameter> p;
  if (choice.gnss_scale) {
    p.push_back({"gnss_scale_horizontal", [](auto& a) -> double& { return a.gnss_scale.horizontal; }, 0.005, 100.0});
    p.push_back({"gnss_scale_vertical", [](auto& a) -> double& { return a.gnss_scale.vertical; }, 0.005, 100.0});
    if (velocities)
      p.push_back({"gnss_scale_velocity", [](auto& a) -> double& { return a.gnss_scale.velocity; }, 0.005, 100.0});
  }
  if (choice.correlated_gnss) {
    p.push_back({"correlated_horizontal_m", [](auto& a) -> double& { return a.correlated_gnss.horizontal_m; }, 1e-4, 20.0});
    p.push_back({"correlated_vertical_m", [](auto& a) -> double& { return a.correlated_gnss.vertical_m; }, 1e-4, 20.0});
    p.push_back({"correlated_time_s", [](auto& a) -> double& { return a.correlated_gnss.time_s; }, 1.0, 600.0});
  }
  if (choice.imu_white_noise) {
    p.push_back({"gyro_factor", [](auto& a) -> double& { return a.gyro_factor; }, 0.05, 1000.0});
    p.push_back({"accel_factor", [](auto& a) -> double& { return a.accel_factor; }, 0.05, 1000.0});
  }
  return p;
}

struct Quadratic {
  double value;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;
};

/// Minus the mean log-likelihood of an innovation, as a function of the logarithms of the free parameters.
class Objective {
 public:
  /// @param fixed  what the parameters that are not free keep
  Objective(const Mission& mission, const noise::ImuErrorModel& model, const FilterOptions& options,
            std::vector<Parameter> parameters, const NoiseAdjustment& fixed,
            std::function<FilterState(const ForwardFilter&)> start)
      : mission_(mission),
        model_(model),
        options_(options),
        parameters_(std::move(parameters)),
        fixed_(fixed),
        start_(std::move(start)) {
    options_.gate_probability = 0.0;
  }

  [[nodiscard]] NoiseAdjustment at(const Eigen::VectorXd& theta) const {
    NoiseAdjustment adjustment = fixed_;
    for (std::size_t i = 0; i < parameters_.size(); ++i)
      parameters_[i].value(adjustment) = std::exp(theta(static_cast<Eigen::Index>(i)));
    return adjustment;
  }

  [[nodiscard]] FilterResult run(const NoiseAdjustment& adjustment) const {
    ++evaluations_;
    const noise::ImuErrorModel model = adjusted(model_, adjustment);
    const ForwardFilter filter(mission_, model, adjusted(options_, adjustment));
    return filter.run(start_(filter), {});
  }

  // A parameter set that breaks the filter is worse than any other, not an error; finite, so that a gradient remains.
  [[nodiscard]] double value(const Eigen::VectorXd& theta) const {
    try {
      const FilterResult result = run(at(theta));
      return -result.log_likelihood / static_cast<double>(std::max<std::size_t>(result.innovations.size(), 1));
    } catch (const NumericalError&) {
      constexpr double kBroken = 1e6;
      return kBroken;
    }
  }

  // Forward differences: their truncation moves the optimum by half a step, 0.05 % of a parameter.
  double operator()(const Eigen::VectorXd& theta, Eigen::VectorXd& gradient) const {
    constexpr double kStep = 1e-3;  // of a logarithm; the rounding of a pass is 1e-11 of the value
    std::vector<Eigen::VectorXd> points(static_cast<std::size_t>(theta.size()) + 1, theta);
    for (Eigen::Index i = 0; i < theta.size(); ++i) points[static_cast<std::size_t>(i) + 1](i) += kStep;
    const std::vector<double> values = values_at(points);
    gradient.resize(theta.size());
    for (Eigen::Index i = 0; i < theta.size(); ++i) gradient(i) = (values[static_cast<std::size_t>(i) + 1] - values[0]) / kStep;
    return values[0];
  }

  // Value, central first and second derivatives.
  [[nodiscard]] Quadratic quadratic(const Eigen::VectorXd& theta) const {
    constexpr double kStep = 0.05;  // truncation 1e-3 of a derivative, far above the rounding of a pass
    const Eigen::Index n = theta.size();
    std::vector<Eigen::VectorXd> points{theta};
    const auto add_both = [&](const Eigen::VectorXd& step) {
      points.emplace_back(theta + step);
      points.emplace_back(theta - step);
    };
    for (Eigen::Index i = 0; i < n; ++i) add_both(kStep * Eigen::VectorXd::Unit(n, i));
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < i; ++j) add_both(kStep * (Eigen::VectorXd::Unit(n, i) + Eigen::VectorXd::Unit(n, j)));
    const std::vector<double> values = values_at(points);
    Quadratic q{values[0], Eigen::VectorXd(n), Eigen::MatrixXd(n, n)};
    const auto sum = [&](std::size_t pair) { return values[2 * pair + 1] + values[2 * pair + 2] - 2.0 * values[0]; };
    auto pair = static_cast<std::size_t>(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto at = static_cast<std::size_t>(i);
      q.gradient(i) = (values[2 * at + 1] - values[2 * at + 2]) / (2.0 * kStep);
      q.hessian(i, i) = sum(at) / (kStep * kStep);
      for (Eigen::Index j = 0; j < i; ++j, ++pair)
        q.hessian(i, j) = q.hessian(j, i) = 0.5 * (sum(pair) - sum(at) - sum(static_cast<std::size_t>(j))) / (kStep * kStep);
    }
    return q;
  }

  [[nodiscard]] const std::vector<Parameter>& parameters() const { return parameters_; }
  [[nodiscard]] int evaluations() const { return evaluations_; }

 private:
  [[nodiscard]] std::vector<double> values_at(const std::vector<Eigen::VectorXd>& points) const {
    std::vector<double> values(points.size());
    tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t k) { values[k] = value(points[k]); });
    return values;
  }

  const Mission& mission_;
  const noise::ImuErrorModel& model_;
  FilterOptions options_;
  std::vector<Parameter> parameters_;
  NoiseAdjustment fixed_;
  std::function<FilterState(const ForwardFilter&)> start_;
  mutable std::atomic<int> evaluations_{0};
};

struct Bounds {
  Eigen::VectorXd low, high;
  explicit Bounds(const std::vector<Parameter>& parameters) {
    low.resize(static_cast<Eigen::Index>(parameters.size()));
    high.resize(low.size());
    for (Eigen::Index i = 0; i < low.size(); ++i) {
      low(i) = std::log(parameters[static_cast<std::size_t>(i)].low);
      high(i) = std::log(parameters[static_cast<std::size_t>(i)].high);
    }
  }
};

constexpr double kNowhere = 1e-5;  // of the mean log-likelihood of an innovation: the search has ended

Eigen::VectorXd minimise(const Objective& objective, Eigen::VectorXd theta, const std::function<void(double)>& progress) {
  Bounds bounds(objective.parameters());
  LBFGSpp::LBFGSBParam<double> settings;
  settings.max_iterations = 40;
  settings.epsilon = 1e-4;
  settings.epsilon_rel = 1e-4;
  settings.past = 2;
  settings.delta = 1e-5;
  LBFGSpp::LBFGSBSolver<double> solver(settings);
  int calls = 0;
  Eigen::VectorXd best = theta;
  double best_value = std::numeric_limits<double>::max();
  const auto function = [&](const Eigen::VectorXd& at, Eigen::VectorXd& gradient) {
    const double value = objective(at, gradient);
    if (value < best_value) {
      best_value = value;
      best = at;
    }
    if (progress) progress(1.0 - 1.0 / (1.0 + 0.1 * ++calls));  // the number of iterations is not known beforehand
    return value;
  };
  // The line search gives up (runtime_error), or calls a direction that leads uphill a mistake of the caller's (logic_error),
  // where finite differences end; or where the curvature that was gathered far away misleads. From the best point seen, without
  // that memory, the search goes on as long as it gets anywhere.
  constexpr int kMostStarts = 6;
  for (int start = 0; start < kMostStarts; ++start) {
    const double before = best_value;
    theta = best;
    double value = 0.0;
    try {
      solver.minimize(function, theta, value, bounds.low, bounds.high);
      break;
    } catch (const std::runtime_error&) {
    } catch (const std::logic_error&) {
    }
    if (start > 0 && before - best_value < kNowhere) break;
  }
  return best;
}

/// Of each parameter, with all others free; infinite where the data do not tell it. Before them a logarithm is known to a
/// factor of twenty or so, which keeps what they do not tell from spreading to what they do.
std::vector<double> deviations(const Eigen::MatrixXd& information) {
  constexpr double kBefore = 0.1;  // information
  constexpr double kUnknown = 2.0;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(information);
  const Eigen::VectorXd variance = (solver.eigenvalues().cwiseMax(0.0).array() + kBefore).inverse();
  const Eigen::VectorXd sd = (solver.eigenvectors().cwiseAbs2() * variance).cwiseSqrt();
  std::vector<double> known(sd.begin(), sd.end());
  std::ranges::replace_if(
      known, [](double one) { return one > kUnknown; }, std::numeric_limits<double>::infinity());
  return known;
}

/// Along a ridge, where amplitude and time of an error stand for each other, gradients by forward differences end early:
/// Newton's steps go on, no farther than by a factor of e, and shorter as long as they lead uphill.
/// @return  second derivatives there
Eigen::MatrixXd polish(const Objective& objective, Eigen::VectorXd& theta) {
  constexpr int kMost = 4;
  constexpr int kHalvings = 3;
  constexpr double kFlat = 1e-4;  // curvature of an innovation's log-likelihood
  const Bounds bounds(objective.parameters());
  Eigen::MatrixXd hessian;
  for (int round = 0; round < kMost; ++round) {
    const Quadratic q = objective.quadratic(theta);
    hessian = q.hessian;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(q.hessian);
    const Eigen::VectorXd curvature = solver.eigenvalues().cwiseMax(kFlat);
    Eigen::VectorXd step =
        -(solver.eigenvectors() * curvature.cwiseInverse().asDiagonal() * solver.eigenvectors().transpose() * q.gradient);
    step /= std::max(1.0, step.lpNorm<Eigen::Infinity>());
    bool moved = false;
    for (int i = 0; i <= kHalvings && !moved; ++i, step *= 0.5) {
      const Eigen::VectorXd there = (theta + step).cwiseMax(bounds.low).cwiseMin(bounds.high);
      moved = objective.value(there) < q.value - kNowhere;
      if (moved) theta = there;
    }
    if (!moved) break;
  }
  return hessian;
}

// What the optimum gains over the stated noise, and how well it is known.
void describe(const Objective& objective, const NoiseAdjustment& as_stated, const Eigen::MatrixXd& hessian, NoiseFit& fit) {
  const FilterResult stated = objective.run(as_stated);
  fit.innovations = stated.innovations.size();
  fit.log_likelihood_before = stated.log_likelihood;
  fit.log_likelihood_after = objective.run(fit.adjustment).log_likelihood;
  fit.evaluations += objective.evaluations();
  fit.names.clear();
  for (const Parameter& p : objective.parameters()) fit.names.push_back(p.name);
  fit.log_sd = deviations(static_cast<double>(fit.innovations) * hessian);
  fit.needed.clear();
  for (const Parameter& p : objective.parameters()) {
    NoiseAdjustment other = fit.adjustment;
    NoiseAdjustment stated_noise = as_stated;
    p.value(other) = std::max(p.low, p.value(stated_noise));
    fit.needed.push_back(fit.log_likelihood_after - objective.run(other).log_likelihood);
  }
}

}  // namespace

NoiseAdjustment starting_point(const FilterOptions& options, const NoiseFitChoice& choice) {
  NoiseAdjustment start{options.gnss_scale, options.auxiliary.correlated_gnss};
  CorrelatedGnss& correlated = start.correlated_gnss;
  if (choice.correlated_gnss && !(correlated.horizontal_m > 0.0 || correlated.vertical_m > 0.0))
    correlated = {.horizontal_m = 0.01, .vertical_m = 0.01, .time_s = 10.0};
  return start;
}

NoiseFit fit_noise(const Mission& mission, const noise::ImuErrorModel& model, const FilterOptions& options,
                   const NoiseFitChoice& choice, const NoiseAdjustment& from,
                   const std::function<FilterState(const ForwardFilter&)>& start, const std::function<void(double)>& progress) {
  const bool velocities = options.use_gnss_velocity &&
                          std::ranges::any_of(mission.gnss.fixes, [](const auto& fix) { return fix.velocity.has_value(); });
  const std::vector<Parameter> parameters = free_parameters(choice, velocities);
  Eigen::VectorXd theta(static_cast<Eigen::Index>(parameters.size()));
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    NoiseAdjustment at = from;
    const Parameter& p = parameters[i];
    theta(static_cast<Eigen::Index>(i)) = std::log(std::clamp(p.value(at), p.low, p.high));
  }

  record::GnssRecording clean = mission.gnss;
  const Mission cleaned{mission.imu,         clean,
                        mission.increments,  mission.C_s_b,
                        mission.lever_arm_b, mission.time_offset_s,
                        mission.standstill,  mission.earth_rate};
  NoiseFit fit;
  for (int round = 0; round < 2; ++round) {
    const Objective objective(cleaned, model, options, parameters, from, start);
    theta = minimise(objective, theta, progress);
    if (!choice.to_the_optimum) {
      fit.adjustment = objective.at(theta);
      break;
    }
    const Eigen::MatrixXd hessian = polish(objective, theta);
    fit.adjustment = objective.at(theta);
    describe(objective, {options.gnss_scale, options.auxiliary.correlated_gnss}, hessian, fit);
    if (round == 1) break;
    // What the gate of the fitted filter refuses must not have shaped the fit.
    const ForwardFilter filter(cleaned, adjusted(model, fit.adjustment), adjusted(options, fit.adjustment));
    const FilterResult gated = filter.run(start(filter), {});
    std::vector<geo::GpsTime> refused;
    for (const InnovationRecord& r : gated.innovations)
      if (!r.used && r.kind == UpdateKind::kGnssPosition) refused.push_back(r.t);
    constexpr double kLargestShare = 0.05;  // more is not a few bad fixes but a model that does not fit
    if (refused.empty() || static_cast<double>(refused.size()) > kLargestShare * static_cast<double>(clean.fixes.size())) break;
    std::erase_if(clean.fixes, [&](const record::GnssFix& fix) {
      const geo::GpsTime t = fix.t - mission.time_offset_s;
      return std::ranges::any_of(refused, [&](geo::GpsTime r) { return std::abs(r - t) < 1e-3; });
    });
  }
  return fit;
}

}  // namespace coast::estimate
