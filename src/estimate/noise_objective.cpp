#include "noise_objective.hpp"

#include <cmath>
#include <limits>

#include "coast/record/error.hpp"

namespace coast::estimate {

TriadPrior::TriadPrior(const std::vector<NoiseParameter>& parameters) {
  constexpr double kSd = 0.5;  // of a logarithm: two axes differ by a factor of two
  const auto n = static_cast<Eigen::Index>(parameters.size());
  information_ = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i + 2 < n; ++i) {
    const NoisePart first = parameters[static_cast<std::size_t>(i)].part;
    if (first == NoisePart::kGyroX || first == NoisePart::kAccelX)
      information_.block<3, 3>(i, i) = (Eigen::Matrix3d::Identity() - Eigen::Matrix3d::Constant(1.0 / 3.0)) / (kSd * kSd);
  }
}

NoiseScores TriadPrior::added_to(NoiseScores scores, const Eigen::VectorXd& theta) const {
  scores.gradient -= information_ * theta;
  scores.information += information_;
  return scores;
}

NoiseObjective::NoiseObjective(const Mission& mission, const noise::ImuErrorModel& model, const FilterOptions& options,
                               const std::vector<NoiseParameter>& parameters, const NoiseAdjustment& fixed, const Start& start)
    : mission_(mission),
      model_(model),
      options_(options),
      parameters_(parameters),
      prior_(parameters),
      fixed_(fixed),
      start_(start) {
  options_.gate_probability = 0.0;
}

NoiseAdjustment NoiseObjective::at(const Eigen::VectorXd& theta) const {
  NoiseAdjustment adjustment = fixed_;
  for (std::size_t i = 0; i < parameters_.size(); ++i)
    parameters_[i].value(adjustment) = std::exp(theta(static_cast<Eigen::Index>(i)));
  return adjustment;
}

double NoiseObjective::value(const Eigen::VectorXd& theta) {
  ++passes_;
  theta_ = theta;
  filter_.emplace(filter_at(at(theta)));
  try {
    return pass_.run(*filter_, start_(*filter_)).log_likelihood + prior_.value(theta);
  } catch (const NumericalError&) {
    return -std::numeric_limits<double>::infinity();
  }
}

NoiseScores NoiseObjective::scores() const {
  NoiseModel model{mission_, filter_->layout(), at(theta_), parameters_, {}};
  for (Eigen::Index i = 0; i < theta_.size(); ++i) model.start.push_back(start_slope(i));
  return prior_.added_to(noise_scores(pass_, model), theta_);
}

NoiseScores NoiseObjective::scores_beside(const Eigen::VectorXd& theta, double& value) const {
  NoiseObjective other(mission_, model_, options_, parameters_, fixed_, start_);
  value = other.value(theta);
  ++passes_;
  if (std::isfinite(value)) return other.scores();
  const auto n = theta.size();
  return {Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Zero(n, n)};
}

double NoiseObjective::value_beside(const Eigen::VectorXd& theta) const {
  try {
    return run(at(theta)).log_likelihood + prior_.value(theta);
  } catch (const NumericalError&) {
    return -std::numeric_limits<double>::infinity();
  }
}

FilterResult NoiseObjective::run(const NoiseAdjustment& adjustment) const {
  ++passes_;
  const ForwardFilter filter = filter_at(adjustment);
  return filter.run(start_(filter), {});
}

ForwardFilter NoiseObjective::filter_at(const NoiseAdjustment& adjustment) const {
  return ForwardFilter(mission_, adjusted(model_, adjustment), adjusted(options_, adjustment));
}

// Does not need a pass.
StartSlope NoiseObjective::start_slope(Eigen::Index parameter) const {
  constexpr double kStep = 1e-4;  // its square is the error, relative
  const auto start_at = [&](double step) {
    Eigen::VectorXd theta = theta_;
    theta(parameter) += step;
    return start_(filter_at(at(theta)));
  };
  const FilterState above = start_at(kStep), below = start_at(-kStep);
  StartSlope slope{(above.x - below.x) / (2.0 * kStep), (above.P - below.P) / (2.0 * kStep)};
  slope.estimate.head<kNav>() = error_between(above.nav, below.nav) / (2.0 * kStep);
  return slope;
}

}  // namespace coast::estimate
