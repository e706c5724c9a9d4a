#include "coast/estimate/noise_fit.hpp"

#include <LBFGSB.h>
#include <tbb/parallel_for.h>

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
    const Eigen::VectorXd values = values_at(theta, {kStep});
    gradient = (values.tail(theta.size()).array() - values(0)) / kStep;
    return values(0);
  }

  // Diagonal of the second derivatives.
  [[nodiscard]] Eigen::VectorXd curvature(const Eigen::VectorXd& theta) const {
    constexpr double kStep = 0.02;  // truncation 1e-4 of the curvature, far above the rounding of a pass
    const Eigen::Index n = theta.size();
    const Eigen::VectorXd values = values_at(theta, {kStep, -kStep});
    return (values.segment(1, n) + values.tail(n) - Eigen::VectorXd::Constant(n, 2.0 * values(0))) / (kStep * kStep);
  }

  [[nodiscard]] const std::vector<Parameter>& parameters() const { return parameters_; }
  [[nodiscard]] int evaluations() const { return evaluations_; }

 private:
  // At the point itself, then with each parameter moved by the first step, then by the second.
  [[nodiscard]] Eigen::VectorXd values_at(const Eigen::VectorXd& theta, const std::vector<double>& steps) const {
    const auto n = static_cast<std::size_t>(theta.size());
    Eigen::VectorXd values(static_cast<Eigen::Index>(1 + n * steps.size()));
    tbb::parallel_for(std::size_t{0}, static_cast<std::size_t>(values.size()), [&](std::size_t k) {
      Eigen::VectorXd moved = theta;
      if (k > 0) moved(static_cast<Eigen::Index>((k - 1) % n)) += steps[(k - 1) / n];
      values(static_cast<Eigen::Index>(k)) = value(moved);
    });
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

Eigen::VectorXd minimise(const Objective& objective, Eigen::VectorXd theta, const std::function<void(double)>& progress) {
  const auto n = theta.size();
  Eigen::VectorXd low(n);
  Eigen::VectorXd high(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Parameter& p = objective.parameters()[static_cast<std::size_t>(i)];
    low(i) = std::log(p.low);
    high(i) = std::log(p.high);
  }
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
  constexpr double kNowhere = 1e-5;  // of the mean log-likelihood of an innovation
  for (int start = 0; start < kMostStarts; ++start) {
    const double before = best_value;
    theta = best;
    double value = 0.0;
    try {
      solver.minimize(function, theta, value, low, high);
      break;
    } catch (const std::runtime_error&) {
    } catch (const std::logic_error&) {
    }
    if (start > 0 && before - best_value < kNowhere) break;
  }
  return best;
}

// What the optimum gains over the stated noise, and how well it is known.
void describe(const Objective& objective, const NoiseAdjustment& as_stated, const Eigen::VectorXd& theta, NoiseFit& fit) {
  const FilterResult stated = objective.run(as_stated);
  const Eigen::VectorXd curvature = objective.curvature(theta);
  fit.innovations = stated.innovations.size();
  fit.log_likelihood_before = stated.log_likelihood;
  fit.log_likelihood_after = objective.run(fit.adjustment).log_likelihood;
  fit.evaluations += objective.evaluations();
  fit.names.clear();
  fit.log_sd.clear();
  for (std::size_t i = 0; i < objective.parameters().size(); ++i) {
    fit.names.push_back(objective.parameters()[i].name);
    const double information = curvature(static_cast<Eigen::Index>(i)) * static_cast<double>(fit.innovations);
    fit.log_sd.push_back(information > 0.0 ? 1.0 / std::sqrt(information) : std::numeric_limits<double>::infinity());
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
    fit.adjustment = objective.at(theta);
    describe(objective, {options.gnss_scale, options.auxiliary.correlated_gnss}, theta, fit);
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
