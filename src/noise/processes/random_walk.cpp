#include <fmt/format.h>

#include <cmath>

#include "entry.hpp"
#include "processes/block_averages.hpp"
#include "processes/estimables.hpp"
#include "processes/processes.hpp"
#include "scalar_process.hpp"

namespace coast::noise {

namespace {

/// dx = sqrt(q) dW, x(0) = 0: an unknown start is modelled by an additional random_constant.
class RandomWalk final : public ScalarProcess {
 public:
  RandomWalk(double density, std::string_view unit) : density_(density), unit_(unit) {}
  [[nodiscard]] std::string_view name() const override { return "random_walk"; }
  /// IEEE Std 952-1997 annex C: K^2 tau/3; its Hadamard variance is half as large.
  [[nodiscard]] std::optional<double> allan_variance(double tau) const override { return density_ * density_ * tau / 3.0; }
  [[nodiscard]] std::optional<double> hadamard_variance(double tau) const override { return density_ * density_ * tau / 6.0; }
  [[nodiscard]] std::string yaml() const override {
    return fmt::format("{{process: random_walk, density: {:.17g}, unit: {}}}", density_, unit_);
  }

 protected:
  [[nodiscard]] double phi(double) const override { return 1.0; }
  [[nodiscard]] double q(double dt) const override { return density_ * density_ * dt; }
  [[nodiscard]] double initial_variance() const override { return 0.0; }

 private:
  double density_;  ///< [signal]/sqrt(s)
  std::string_view unit_;
};

/// u = log of the squared density, [signal]^2/s. It starts at zero: the level is part of the mean.
class EstimableRandomWalk final : public Estimable {
 public:
  [[nodiscard]] std::string_view name() const override { return "random_walk"; }
  [[nodiscard]] std::string_view symbol() const override { return "RW"; }
  [[nodiscard]] std::vector<ParameterInfo> parameters() const override { return {{"density2", "signal^2/s"}}; }
  [[nodiscard]] Eigen::Index states() const override { return 1; }
  [[nodiscard]] std::vector<Interval> ranges(const SignalScale& scale) const override {
    return {log_variance_range(scale.variance / scale.duration)};
  }
  [[nodiscard]] SampleBlock block(std::span<const double> u, const SampleStep& step) const override {
    if (step.averaged > 1) {
      SampleBlock means = averaged_random_walk(step.averaged);
      means.Q *= std::exp(u[0]) * step.interval;
      means.P_first *= std::exp(u[0]) * step.interval;
      return means;
    }
    SampleBlock block = SampleBlock::zero(1);
    block.Phi(0, 0) = 1.0;
    block.Q(0, 0) = std::exp(u[0]) * step.interval;
    block.h(0) = 1.0;
    return block;
  }
  [[nodiscard]] std::vector<SampleBlock> derivatives(std::span<const double> u, const SampleStep& step) const override {
    return {variances_of(block(u, step))};
  }
  void maximise(const BlockMoments& m, double interval, const std::vector<bool>& fixed, std::span<double> u) const override {
    if (fixed[0]) return;
    const double steps = m.after(0, 0) - 2.0 * m.lagged(0, 0) + m.before(0, 0);
    u[0] = std::log(steps / (m.transitions * interval));
  }
  [[nodiscard]] ProcessPtr process(std::span<const double> u, const Sampling& sampling) const override {
    return std::make_shared<RandomWalk>(std::exp(0.5 * u[0]), si_unit(kSignalWalk.of(sampling.sensor)));
  }
};

}  // namespace

const Estimable& estimable_random_walk() {
  static const EstimableRandomWalk process;
  return process;
}

Registration random_walk() {
  return {"random_walk",
          "integrated white noise that starts at zero: `density` per square root of time",
          "{process: random_walk, density: 2, unit: deg/h/sqrt(h)}",
          "{process: random_walk, density: 1, unit: ug/sqrt(s)}",
          [](const config::Node& entry, const EntryContext& context) -> std::vector<ProcessPtr> {
            return {std::make_shared<RandomWalk>(value_with_unit(entry, "density", kSignalWalk, context),
                                                 si_unit(kSignalWalk.of(context.sensor)))};
          },
          &estimable_random_walk()};
}

}  // namespace coast::noise
