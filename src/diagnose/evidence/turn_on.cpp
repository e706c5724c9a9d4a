#include "evidence/turn_on.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coast/noise/chi_square.hpp"
#include "coast/noise/gauss_markov.hpp"
#include "noise_effects/noise_effects.hpp"

namespace coast::diagnose {

namespace {

constexpr double kBiasFalseAlarm = 1e-4;  // for all axes together: negligible compared with the allowed false alarms
constexpr double kConstant = 0.9;         // least share of the squared mean in the mean square of a constant

/// Visits the states that add up to the bias of an axis.
template <typename Take>
void for_each_block(const TurnOn& one, const estimate::StateLayout& layout, const Take& take) {
  for (const estimate::StateLayout::SensorBlock& block : layout.sensors())
    if (block.sensor == one.sensor && block.axis == one.axis && !block.signal_axis) take(block);
}

double bias_of(const TurnOn& one, const estimate::StateLayout& layout, const Eigen::VectorXd& x) {
  double sum = 0.0;
  const Eigen::VectorXd deviation = x - layout.mean(0.0);
  for_each_block(one, layout, [&](const auto& block) { sum += block.output.dot(deviation.segment(block.offset, block.size)); });
  return sum;
}

/// Sum and sum of squares of a unit of each effect on an axis.
struct Moments {
  Eigen::ArrayXd sum, squares;
  double count = 0.0;
};

Moments moments(const TurnOn& one, const MissionRun& run) {
  constexpr std::size_t kEvery = 20;  // samples: a subset is sufficient to see what is constant
  const std::vector<Hypothesis>& all = run.hypotheses().all();
  Moments m{Eigen::ArrayXd::Zero(run.hypotheses().size()), Eigen::ArrayXd::Zero(run.hypotheses().size())};
  run.for_each_sample([&](std::size_t sample, geo::GpsTime, const Signals& signals) {
    if (sample % kEvery != 0) return;
    m.count += 1.0;
    for (Eigen::Index i = 0; i < run.hypotheses().size();) {
      const Effect& effect = *all[static_cast<std::size_t>(i)].effect;
      const auto axes = static_cast<Eigen::Index>(effect.axes.size());
      if (effect.sensors && effect.site == sensor_site(one.sensor) && effect.begins == Effect::Begins::kWithTheMission) {
        Eigen::Matrix3Xd gyro = Eigen::Matrix3Xd::Zero(3, axes);
        Eigen::Matrix3Xd accel = Eigen::Matrix3Xd::Zero(3, axes);
        SensorErrors errors{gyro, accel};
        effect.sensors(signals, errors);
        const Eigen::ArrayXd error = (one.sensor == noise::Sensor::kGyro ? gyro : accel).row(one.axis).transpose();
        m.sum.segment(i, axes) += error;
        m.squares.segment(i, axes) += error.square();
      }
      i += axes;
    }
  });
  return m;
}

}  // namespace

// Logarithm of N(b; 0, b^2) over N(0; 0, s^2), with opposite sign.
double TurnOn::price() const {
  return 0.5 + std::log(std::abs(value) / stated);
}

double TurnOn::cost() const {
  return 0.5 * std::pow(value / stated, 2);
}

double TurnOn::gain() const {
  return cost() - price();
}

std::vector<TurnOn> beyond_stated(const MissionRun& run) {
  const estimate::SmoothedKnot& start = run.solution().smoothed.front();
  const double threshold = noise::chi2_upper_quantile(1.0, kBiasFalseAlarm / kAxes);
  std::vector<TurnOn> beyond;
  for (const noise::Sensor sensor : {noise::Sensor::kGyro, noise::Sensor::kAccel})
    for (int axis = 0; axis < 3; ++axis) {
      TurnOn one{.sensor = sensor, .axis = axis, .stated = run.prepared().model().bias_sd(sensor, axis)};
      one.value = bias_of(one, run.layout(), start.x);
      for_each_block(one, run.layout(), [&](const auto& block) {
        one.sd = std::hypot(one.sd, block.output.transpose().cwiseProduct(start.sd.segment(block.offset, block.size)).norm());
      });
      if (one.stated > 0.0 && std::pow(one.value / one.stated, 2) > threshold) beyond.push_back(one);
    }
  return beyond;
}

double gain_about_stated(const TurnOn& one, const MissionRun& run) {
  const double bias = bias_of(one, run.layout(), run.solution().smoothed.front().x);
  return 0.5 * (std::pow(bias - prior_mean(one, run), 2) - bias * bias) / (one.stated * one.stated);
}

// Innovations about a mean smaller by m are larger by D_b m, with D_b those of a constant bias.
double prior_mean(const TurnOn& one, const MissionRun& run) {
  return bias_of(one, run.layout(), run.prepared().start_state(*run.solution().filter).x);
}

Eigen::Index constant_bias(const TurnOn& one, const MissionRun& run) {
  return run.hypotheses().bias_step(sensor_site(one.sensor), one.axis);
}

NoiseFinding described_bias(const TurnOn& one) {
  const double ratio = std::abs(one.value / one.stated);
  return {.name = "turn_on_bias",
          .sensor = std::string(name(sensor_site(one.sensor))),
          .axis = axis_letter(one.axis),
          .parameter = "bias",
          .unit = std::string(signal_unit(sensor_site(one.sensor))),
          .value = one.value,
          .sd = one.sd,
          .delta_log_likelihood = one.gain(),
          .p_value = std::min(1.0, kAxes * noise::chi2_survival(1.0, ratio * ratio)),
          .place = NoiseFinding::Place::kErrorModel,
          .meaning = fmt::format("The bias at the start is {:.{}f} times the sigma that the error model has of it, {:.3g}.",
                                 ratio, ratio < 10.0 ? 1 : 0, one.stated),
          .equation = "d_i = constant, beyond the error model's sigma",
          .separating_manoeuvre = "The IMU switched on again: a bias of one start is another one then.",
          .alternatives = one.alternatives};
}

void widen(const TurnOn& one, MissionInput& input) {
  append({noise::make_gauss_markov(
             {.name = "random_constant", .sigma = std::abs(one.value), .unit = signal_unit(sensor_site(one.sensor))})},
         one.sensor, one.axis, input);
}

std::optional<Suspicion> constant_like(const TurnOn& one, const MissionRun& run) {
  const Hypotheses& hypotheses = run.hypotheses();
  const Moments m = moments(one, run);
  std::optional<Suspicion> likeliest;
  for (Eigen::Index i = 0; i < hypotheses.size(); ++i) {
    const Hypothesis& h = hypotheses[i];
    if (!h.effect->relation.empty() || !(m.sum(i) * m.sum(i) > kConstant * m.count * m.squares(i))) continue;
    const double unit = m.sum(i) / m.count;
    const double ratio = one.value / one.stated;
    const double information = std::pow(unit / one.stated, 2);
    const double log_bayes = log_bayes_factor(ratio * unit / one.stated, information, h.plausible);
    if (likeliest && !(log_bayes > likeliest->log_bayes)) continue;
    likeliest = Suspicion{.hypothesis = i,
                          .from = {},
                          .estimate = one.value / unit,
                          .sd = one.stated / std::abs(unit),
                          .likelihood_ratio = ratio * ratio,
                          .log_bayes = log_bayes,
                          .p_value = std::min(1.0, kAxes * noise::chi2_survival(1.0, ratio * ratio))};
  }
  return likeliest;
}

}  // namespace coast::diagnose
