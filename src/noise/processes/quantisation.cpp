#include <fmt/format.h>

#include <stdexcept>

#include "entry.hpp"
#include "processes/estimables.hpp"
#include "processes/processes.hpp"

namespace coast::noise {

namespace {

/// Rounding to a step. Its error is uniform over a step if the signal changes by more than one step from sample to sample
/// (Bennett 1948); a signal that stays within a step reads as a constant instead, which no variance describes.
class Quantisation final : public Process {
 public:
  /// @param rate_hz  of the samples that are rounded; not used for an integral
  Quantisation(const Rounding& rounding, double rate_hz, std::string_view unit)
      : rounding_(rounding), rate_hz_(rate_hz), unit_(unit) {}
  [[nodiscard]] std::string_view name() const override { return "quantisation"; }
  [[nodiscard]] int states() const override { return 0; }
  void transition(double, Eigen::Ref<Eigen::MatrixXd>) const override {}
  void driving_noise(double, Eigen::Ref<Eigen::MatrixXd>) const override {}
  void output(Eigen::Ref<Eigen::RowVectorXd>) const override {}
  void initial_covariance(Eigen::Ref<Eigen::MatrixXd>) const override {}
  [[nodiscard]] std::optional<Rounding> rounding() const override { return rounding_; }
  /// White noise of step^2/12 per sample. The error of a rounded integral is bounded, so its density at zero frequency is zero.
  [[nodiscard]] geo::Psd white_density() const override {
    return of_integral() ? geo::Psd{} : geo::density_of_samples({variance()}, rate_hz_);
  }
  /// IEEE Std 952-1997 annex C: 3 Q^2/tau^2, Q = step/sqrt(12): the second difference of an integral whose errors are
  /// independent has the variance (1 + 4 + 1) Q^2, over 2 tau^2. The third has (1 + 9 + 9 + 1) Q^2, over 6 tau^2.
  [[nodiscard]] std::optional<double> allan_variance(double tau) const override {
    return of_integral() ? 3.0 * variance() / (tau * tau) : white_density().value / tau;
  }
  [[nodiscard]] std::optional<double> hadamard_variance(double tau) const override {
    return of_integral() ? 10.0 / 3.0 * variance() / (tau * tau) : white_density().value / tau;
  }
  [[nodiscard]] std::string yaml() const override {
    return fmt::format("{{process: quantisation, step: {:.17g}, unit: {}}}", rounding_.step, unit_);
  }

 private:
  [[nodiscard]] bool of_integral() const { return rounding_.of == Rounding::Of::kIntegral; }
  [[nodiscard]] double variance() const { return rounding_.step * rounding_.step / 12.0; }

  Rounding rounding_;
  double rate_hz_;
  std::string_view unit_;
};

// The unit decides which quantity is rounded.
Rounding::Of rounded(const config::Node& entry, const EntryContext& context) {
  const config::Node unit = entry.at("unit");
  try {
    const geo::Dimension dimension = geo::unit(unit.text()).dimension;
    if (dimension == kSignalIntegral.of(context.sensor)) return Rounding::Of::kIntegral;
    if (dimension == kSignal.of(context.sensor)) return Rounding::Of::kSample;
  } catch (const std::invalid_argument& unknown) {
    throw unit.error(unknown.what(), "");
  }
  const bool gyro = context.sensor == Sensor::kGyro;
  throw unit.error("unit '" + unit.text() + "'",
                   gyro ? "a unit of angle such as arcsec (its integral is rounded), or of rate such as deg/s (each sample is)"
                        : "m/s (the integral is rounded), or a unit of specific force such as mg (each sample is)");
}

std::vector<ProcessPtr> make_quantisation(const config::Node& entry, const EntryContext& context) {
  const Rounding::Of of = rounded(entry, context);
  const SensorDimension& dimension = of == Rounding::Of::kIntegral ? kSignalIntegral : kSignal;
  const Rounding rounding{of, value_with_unit(entry, "step", dimension, context)};
  if (!(rounding.step > 0.0)) throw entry.at("step").error(entry.at("step").text(), "a step above zero");
  if (of == Rounding::Of::kSample && !(context.rate_hz > 0.0))
    throw entry.at("step").error("a step of the samples, but the model states no rate_hz", "rate_hz > 0");
  return {std::make_shared<Quantisation>(rounding, context.rate_hz, si_unit(dimension.of(context.sensor)))};
}

/// For the integral: u = log Q^2 [signal s]^2, Q = step/sqrt(12). The error of each integral is independent, that of the mean
/// rate is (e[k] - e[k-1])/interval: states e[k], e[k-1].
class EstimableQuantisation final : public Estimable {
 public:
  [[nodiscard]] std::string_view name() const override { return "quantisation"; }
  [[nodiscard]] std::string_view symbol() const override { return "QN"; }
  [[nodiscard]] std::vector<ParameterInfo> parameters() const override { return {{"q2", "(signal s)^2"}}; }
  [[nodiscard]] Eigen::Index states() const override { return 2; }
  [[nodiscard]] std::vector<Interval> ranges(const SignalScale& scale) const override {
    return {log_variance_range(scale.variance * scale.interval * scale.interval)};
  }
  [[nodiscard]] SampleBlock block(std::span<const double> u, const SampleStep& step) const override {
    SampleBlock block = SampleBlock::zero(2);
    block.Phi(1, 0) = 1.0;
    block.Q(0, 0) = std::exp(u[0]) / (step.duration() * step.duration());
    block.P_first = block.Q(0, 0) * Eigen::Matrix2d::Identity();
    block.h << 1.0, -1.0;
    return block;
  }
  [[nodiscard]] std::vector<SampleBlock> derivatives(std::span<const double> u, const SampleStep& step) const override {
    return {variances_of(block(u, step))};
  }
  void maximise(const BlockMoments& m, double interval, const std::vector<bool>& fixed, std::span<double> u) const override {
    if (fixed[0]) return;
    const double sum = m.first.trace() + m.after(0, 0);
    u[0] = std::log(sum / (2.0 * m.records + m.transitions) * interval * interval);
  }
  [[nodiscard]] ProcessPtr process(std::span<const double> u, const Sampling& sampling) const override {
    const Rounding rounding{Rounding::Of::kIntegral, std::sqrt(12.0) * std::exp(0.5 * u[0])};
    return std::make_shared<Quantisation>(rounding, 1.0 / sampling.interval, si_unit(kSignalIntegral.of(sampling.sensor)));
  }
};

const Estimable& estimable_quantisation() {
  static const EstimableQuantisation process;
  return process;
}

}  // namespace

Registration quantisation() {
  return {
      "quantisation",
      "rounding to multiples of `step`: of the integral of the output where the unit is an angle (accelerometer: m/s), with "
      "the residue carried on; of each sample, at the model's rate_hz, where it is a rate (accelerometer: specific force)",
      "{process: quantisation, step: 0.5, unit: arcsec}",
      "{process: quantisation, step: 0.001, unit: m/s}",
      make_quantisation,
      &estimable_quantisation()};
}

}  // namespace coast::noise
