#include "coast/estimate/noise_fit.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "coast/parallel.hpp"
#include "coast/record/error.hpp"
#include "noise_objective.hpp"
#include "noise_search.hpp"

namespace coast::estimate {

noise::ImuErrorModel adjusted(const noise::ImuErrorModel& model, const NoiseAdjustment& adjustment) {
  return model.with_white_noise_scaled(noise::Sensor::kGyro, adjustment.gyro_factors)
      .with_white_noise_scaled(noise::Sensor::kAccel, adjustment.accel_factors);
}

FilterOptions adjusted(const FilterOptions& options, const NoiseAdjustment& adjustment) {
  FilterOptions result = options;
  result.gnss_scale = adjustment.gnss_scale;
  result.auxiliary.correlated_gnss = adjustment.correlated_gnss;
  return result;
}

namespace {

using Eigen::Index;

/// The mission with these fixes instead of its own and of carrier phases. A further member of Mission must be added here.
Mission with_fixes(const Mission& mission, const record::GnssRecording& fixes) {
  const auto& [imu, gnss, increments, C_s_b, lever_arm_b, time_offset_s, standstill, earth_rate, first_epoch, carrier, restarts,
               aids] = mission;
  return {imu,        fixes,      increments,  C_s_b,   lever_arm_b, time_offset_s,
          standstill, earth_rate, first_epoch, nullptr, restarts,    aids};
}

SearchBox box_of(const std::vector<NoiseParameter>& parameters) {
  SearchBox box{Eigen::VectorXd(static_cast<Index>(parameters.size())), {}};
  box.high = box.low;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    box.low(static_cast<Index>(i)) = std::log(parameters[i].low);
    box.high(static_cast<Index>(i)) = std::log(parameters[i].high);
  }
  return box;
}

Eigen::VectorXd logarithms(const NoiseAdjustment& from, const std::vector<NoiseParameter>& parameters, const SearchBox& box) {
  Eigen::VectorXd theta(box.low.size());
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    NoiseAdjustment at = from;
    const auto place = static_cast<Index>(i);
    theta(place) = std::clamp(std::log(parameters[i].value(at)), box.low(place), box.high(place));
  }
  return theta;
}

/// For each parameter, with all others free; infinite if the data have no information. As prior a logarithm is known to a
/// factor of twenty or so, so that unobservable parameters do not affect observable ones.
std::vector<double> deviations(const Eigen::MatrixXd& information) {
  constexpr double kBefore = 0.1;  // prior information
  constexpr double kUnknown = 2.0;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(information);
  const Eigen::VectorXd variance = (solver.eigenvalues().cwiseMax(0.0).array() + kBefore).inverse();
  const Eigen::VectorXd sd = (solver.eigenvectors().cwiseAbs2() * variance).cwiseSqrt();
  std::vector<double> known(sd.begin(), sd.end());
  std::ranges::replace_if(
      known, [](double one) { return one > kUnknown; }, std::numeric_limits<double>::infinity());
  return known;
}

// The gain of the optimum over the stated noise, and its uncertainty.
void describe(const NoiseObjective& objective, const std::vector<NoiseParameter>& parameters, const NoiseAdjustment& as_stated,
              const SearchPoint& optimum, NoiseFit& fit) {
  const auto log_likelihood_without = [&](const NoiseParameter& p) {
    NoiseAdjustment other = objective.at(optimum.theta);
    NoiseAdjustment stated_noise = as_stated;
    p.value(other) = std::max(p.low, p.value(stated_noise));
    try {
      return objective.run(other).log_likelihood;
    } catch (const NumericalError&) {
      return -std::numeric_limits<double>::infinity();  // the filter fails without it
    }
  };
  const FilterResult stated = objective.run(as_stated);
  fit.innovations = stated.innovations.size();
  fit.log_likelihood_before = stated.log_likelihood;
  fit.log_likelihood_after = optimum.value - objective.prior().value(optimum.theta);
  fit.log_sd = deviations(optimum.information);
  fit.needed.resize(parameters.size());
  coast::parallel_for(std::size_t{0}, parameters.size(),
                      [&](std::size_t i) { fit.needed[i] = fit.log_likelihood_after - log_likelihood_without(parameters[i]); });
}

std::vector<Bound> bounds_met(const Eigen::VectorXd& theta, const SearchBox& box) {
  constexpr double kOn = 1e-6;  // of a logarithm
  std::vector<Bound> met;
  for (Index i = 0; i < theta.size(); ++i)
    met.push_back(theta(i) < box.low(i) + kOn ? Bound::kLower : (theta(i) > box.high(i) - kOn ? Bound::kUpper : Bound::kNone));
  return met;
}

/// Omits the fixes rejected by a filter with closed gate. @return  whether there are any
bool leave_out_refused(const ForwardFilter& filter, const FilterState& start, double time_offset_s,
                       std::vector<record::GnssFix>& fixes) {
  constexpr double kLargestShare = 0.05;  // more means a model that does not fit, not a few bad fixes
  constexpr double kSame = 1e-3;          // s
  std::vector<geo::GpsTime> refused;
  for (const InnovationRecord& r : filter.run(start, {}).innovations)
    if (!r.used && r.kind == UpdateKind::kGnssPosition) refused.push_back(r.t);
  if (refused.empty() || static_cast<double>(refused.size()) > kLargestShare * static_cast<double>(fixes.size())) return false;
  std::erase_if(fixes, [&](const record::GnssFix& fix) {
    const geo::GpsTime t = fix.t - time_offset_s;
    return std::ranges::any_of(refused, [&](geo::GpsTime r) { return std::abs(r - t) < kSame; });
  });
  return true;
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
  constexpr double kNearby = 5e-3;   // of the log-likelihood: a tenth of a sigma
  constexpr double kSettled = 1e-3;  // the fixes rejected by the gate do not change by it
  const bool velocities = options.use_gnss_velocity &&
                          std::ranges::any_of(mission.gnss.fixes, [](const auto& fix) { return fix.velocity.has_value(); });
  const std::vector<NoiseParameter> parameters = free_parameters(choice, velocities);
  const SearchBox box = box_of(parameters);
  record::GnssRecording clean = mission.gnss;
  const Mission cleaned = with_fixes(mission, clean);
  NoiseObjective objective(cleaned, model, options, parameters, from, start);
  const Likelihood likelihood{
      [&](const Eigen::VectorXd& theta) {
        // Their number is unknown beforehand.
        if (progress) progress(1.0 - 1.0 / (1.0 + 0.05 * objective.passes()));
        return objective.value(theta);
      },
      [&] { return objective.scores(); }, [&](const Eigen::VectorXd& theta) { return objective.value_beside(theta); },
      [&](const Eigen::VectorXd& theta, double& value) { return objective.scores_beside(theta, value); }};
  SearchState search{point_at(likelihood, logarithms(from, parameters, box)), {}};
  if (!std::isfinite(search.at.value)) static_cast<void>(objective.run(objective.at(search.at.theta)));  // throws the cause
  climb(likelihood, box, kNearby, search);
  NoiseFit fit;
  if (choice.precision != FitPrecision::kPreliminary) {
    const bool for_search = choice.precision == FitPrecision::kSearch;
    relinearise(likelihood, for_search, search);
    climb(likelihood, box, kSettled, search);
    const NoiseAdjustment fitted = objective.at(search.at.theta);
    const ForwardFilter filter(cleaned, adjusted(model, fitted), adjusted(options, fitted));
    // Fixes rejected by the gate of the fitted filter must not affect the fit.
    if (leave_out_refused(filter, start(filter), mission.time_offset_s, clean.fixes)) {
      search.at = point_at(likelihood, search.at.theta);
      climb(likelihood, box, kSettled, search);
    }
    if (!for_search) polish(likelihood, box, search);
    describe(objective, parameters, {options.gnss_scale, options.auxiliary.correlated_gnss}, search.at, fit);
  }
  for (const NoiseParameter& p : parameters) fit.names.emplace_back(p.name);
  fit.adjustment = objective.at(search.at.theta);
  fit.bounds = bounds_met(search.at.theta, box);
  fit.evaluations = objective.passes();
  return fit;
}

}  // namespace coast::estimate
