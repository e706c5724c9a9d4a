#include <fmt/format.h>

#include <cmath>

#include "entry.hpp"
#include "processes/estimables.hpp"
#include "processes/processes.hpp"

namespace coast::noise {

namespace {

/// No state: white noise of the rate or specific force is a random walk of its integral.
class WhiteNoise final : public Process {
 public:
  WhiteNoise(geo::Psd density, std::string_view unit) : density_(density), unit_(unit) {}
  [[nodiscard]] std::string_view name() const override { return "white_noise"; }
  [[nodiscard]] int states() const override { return 0; }
  void transition(double, Eigen::Ref<Eigen::MatrixXd>) const override {}
  void driving_noise(double, Eigen::Ref<Eigen::MatrixXd>) const override {}
  void output(Eigen::Ref<Eigen::RowVectorXd>) const override {}
  void initial_covariance(Eigen::Ref<Eigen::MatrixXd>) const override {}
  [[nodiscard]] geo::Psd white_density() const override { return density_; }
  /// IEEE Std 952-1997 annex C: N^2/tau; averages are independent, so the Hadamard variance is the same.
  [[nodiscard]] std::optional<double> allan_variance(double tau) const override { return density_.value / tau; }
  [[nodiscard]] std::optional<double> hadamard_variance(double tau) const override { return density_.value / tau; }
  [[nodiscard]] std::string yaml() const override {
    return fmt::format("{{process: white_noise, density: {:.17g}, unit: {}}}", std::sqrt(density_.value), unit_);
  }

 private:
  geo::Psd density_;
  std::string_view unit_;
};

std::vector<ProcessPtr> make_white_noise(const config::Node& entry, const EntryContext& context) {
  if (entry.find("density"))
    return {make_white_noise(value_with_unit(entry, "density", kSignalNoise, context), context.sensor)};
  if (!(context.rate_hz > 0.0))
    throw entry.at("variance_per_sample").error("a variance per sample, but the model states no rate_hz", "rate_hz > 0");
  const geo::Cov variance{value_with_unit(entry, "variance_per_sample", kSignalVariance, context)};
  return {make_white_noise(std::sqrt(geo::density_of_samples(variance, context.rate_hz).value), context.sensor)};
}

/// u = log of the density [signal]^2/Hz.
class EstimableWhiteNoise final : public Estimable {
 public:
  [[nodiscard]] std::string_view name() const override { return "white_noise"; }
  [[nodiscard]] std::string_view symbol() const override { return "WN"; }
  [[nodiscard]] std::vector<ParameterInfo> parameters() const override { return {{"density", "signal^2/Hz"}}; }
  [[nodiscard]] Eigen::Index states() const override { return 0; }
  [[nodiscard]] std::vector<Interval> ranges(const SignalScale& scale) const override {
    return {log_variance_range(scale.variance * scale.interval)};
  }
  [[nodiscard]] SampleBlock block(std::span<const double> u, const SampleStep& step) const override {
    SampleBlock block = SampleBlock::zero(0);
    block.white = std::exp(u[0]) / step.duration();
    return block;
  }
  [[nodiscard]] std::vector<SampleBlock> derivatives(std::span<const double> u, const SampleStep& step) const override {
    return {block(u, step)};
  }
  void maximise(const BlockMoments& moments, double interval, const std::vector<bool>& fixed,
                std::span<double> u) const override {
    if (!fixed[0]) u[0] = std::log(moments.residual / moments.samples * interval);
  }
  [[nodiscard]] ProcessPtr process(std::span<const double> u, const Sampling& sampling) const override {
    return make_white_noise(std::exp(0.5 * u[0]), sampling.sensor);
  }
};

}  // namespace

const Estimable& estimable_white_noise() {
  static const EstimableWhiteNoise process;
  return process;
}

ProcessPtr make_white_noise(double density, Sensor sensor) {
  return std::make_shared<WhiteNoise>(geo::Psd{density * density}, si_unit(kSignalNoise.of(sensor)));
}

Registration white_noise() {
  return {"white_noise",
          "white noise of the signal: `density` (per square root of Hz), or `variance_per_sample` at the model's rate_hz",
          "{process: white_noise, density: 0.15, unit: deg/sqrt(h)}",
          "{process: white_noise, density: 50, unit: ug/sqrt(Hz)}",
          make_white_noise,
          &estimable_white_noise()};
}

}  // namespace coast::noise
