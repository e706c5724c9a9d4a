#include <fmt/format.h>

#include <cmath>

#include "entry.hpp"
#include "processes/block_averages.hpp"
#include "processes/estimables.hpp"
#include "processes/processes.hpp"

namespace coast::noise {

namespace {

struct FlickerParameters {
  double coefficient = 0.0;  ///< B, [signal]
  double shortest = 0.0;     ///< s, the band of averaging times
  double longest = 0.0;
};

/// Bias instability as a sum of Gauss-Markov processes.
///
/// IEEE Std 952-1997 annex C: two-sided density B^2/(2 pi f) within a band, Allan variance (2 ln 2/pi) B^2. One process has the
/// density 2 sigma^2 T/(1 + (omega T)^2); an infinite series of correlation times T at a constant ratio exp(d) adds up to
///
///     sum_j 2 sigma^2 T_j/(1 + (omega T_j)^2) = sigma^2/(2 d f) (1 + 2 sech(pi^2/d) cos(2 pi ln(omega T_0)/d) + ...)
///
/// (Poisson's summation of sech), so sigma^2 = B^2 d/pi, and for d up to ln(10)/1.5 the ripple is 0.64 % of the density. The
/// processes beyond the ends act within the band by their leading term, 2 sigma^2 T or 2 sigma^2/(omega^2 T): a geometric
/// series, included by a variance of the two processes at the ends that is larger by 1/(1 - exp(-d)).
class Flicker final : public Process {
 public:
  Flicker(const FlickerParameters& parameters, std::string_view unit) : p_(parameters), unit_(unit) {
    // With this extension of the ends the Allan variance is within 1 % of the floor (tests/noise/flicker_test.cpp).
    constexpr double kBelow = 10.0, kAbove = 4.0, kPerDecade = 1.5;
    const double first = p_.shortest / kBelow, last = p_.longest * kAbove;
    const double span = std::log(last / first);
    const int count = 1 + static_cast<int>(std::ceil(kPerDecade * span / std::log(10.0)));
    const double d = span / (count - 1);
    const double variance = p_.coefficient * p_.coefficient * d / geo::kPi;
    for (int i = 0; i < count; ++i) {
      const double share = i == 0 || i == count - 1 ? -1.0 / std::expm1(-d) : 1.0;
      rates_.push_back(std::exp(-d * i) / first);
      terms_.push_back(
          make_gauss_markov({.name = "flicker", .sigma = std::sqrt(share * variance), .beta = rates_.back(), .unit = unit_}));
    }
  }
  [[nodiscard]] std::string_view name() const override { return "flicker"; }
  [[nodiscard]] int states() const override { return static_cast<int>(terms_.size()); }
  /// beta of one process, 1/s.
  [[nodiscard]] double rate(Eigen::Index i) const { return rates_[static_cast<std::size_t>(i)]; }
  void transition(double dt, Eigen::Ref<Eigen::MatrixXd> Phi) const override {
    Phi.setZero();
    for (int i = 0; i < states(); ++i) term(i).transition(dt, Phi.block(i, i, 1, 1));
  }
  void driving_noise(double dt, Eigen::Ref<Eigen::MatrixXd> Q_d) const override {
    Q_d.setZero();
    for (int i = 0; i < states(); ++i) term(i).driving_noise(dt, Q_d.block(i, i, 1, 1));
  }
  void output(Eigen::Ref<Eigen::RowVectorXd> h) const override { h.setOnes(); }
  void initial_covariance(Eigen::Ref<Eigen::MatrixXd> P) const override {
    P.setZero();
    for (int i = 0; i < states(); ++i) term(i).initial_covariance(P.block(i, i, 1, 1));
  }
  /// For the sum, not for ideal flicker noise: they agree within the band.
  [[nodiscard]] std::optional<double> allan_variance(double tau) const override {
    double sum = 0.0;
    for (const ProcessPtr& process : terms_) sum += process->allan_variance(tau).value_or(0.0);
    return sum;
  }
  [[nodiscard]] std::optional<double> hadamard_variance(double tau) const override {
    double sum = 0.0;
    for (const ProcessPtr& process : terms_) sum += process->hadamard_variance(tau).value_or(0.0);
    return sum;
  }
  [[nodiscard]] std::string yaml() const override {
    return fmt::format(
        "{{process: flicker, coefficient: {:.17g}, unit: {}, shortest_time_s: {:.17g}, longest_time_s: {:.17g}}}",
        p_.coefficient, unit_, p_.shortest, p_.longest);
  }

 private:
  [[nodiscard]] const Process& term(int i) const { return *terms_[static_cast<std::size_t>(i)]; }

  FlickerParameters p_;
  std::string_view unit_;
  std::vector<ProcessPtr> terms_;
  std::vector<double> rates_;
};

// Below ten seconds white noise hides the floor of all sensors seen so far; above hours few recordings have information.
constexpr double kShortestTime = 10.0, kLongestTime = 1e4;

/// u = log B^2 [signal]^2, over the default band: one factor on all variances.
class EstimableFlicker final : public Estimable {
 public:
  EstimableFlicker() : unit_({.coefficient = 1.0, .shortest = kShortestTime, .longest = kLongestTime}, "") {}
  [[nodiscard]] std::string_view name() const override { return "flicker"; }
  [[nodiscard]] std::string_view symbol() const override { return "BI"; }
  [[nodiscard]] std::vector<ParameterInfo> parameters() const override { return {{"coefficient2", "signal^2"}}; }
  [[nodiscard]] Eigen::Index states() const override { return unit_.states(); }
  [[nodiscard]] std::vector<Interval> ranges(const SignalScale& scale) const override {
    return {log_variance_range(scale.variance)};
  }
  /// Means of samples need one state per process as well, so that it can be combined with others (block_averages.hpp).
  [[nodiscard]] SampleBlock block(std::span<const double> u, const SampleStep& step) const override {
    SampleBlock block = SampleBlock::zero(states());
    unit_.transition(step.duration(), block.Phi);
    unit_.driving_noise(step.duration(), block.Q);
    unit_.initial_covariance(block.P_first);
    block.h.setOnes();
    if (step.averaged > 1) average(step, block);
    block.Q *= std::exp(u[0]);
    block.P_first *= std::exp(u[0]);
    block.white *= std::exp(u[0]);
    return block;
  }
  [[nodiscard]] std::vector<SampleBlock> derivatives(std::span<const double> u, const SampleStep& step) const override {
    return {variances_of(block(u, step))};
  }
  void maximise(const BlockMoments& m, double interval, const std::vector<bool>& fixed, std::span<double> u) const override {
    if (fixed[0]) return;
    const SampleBlock unit = block(std::vector<double>{0.0}, interval);
    double sum = 0.0;
    for (Eigen::Index i = 0; i < states(); ++i) {
      const double phi = unit.Phi(i, i);
      sum += m.first(i, i) / unit.P_first(i, i);
      sum += (m.after(i, i) - 2.0 * phi * m.lagged(i, i) + phi * phi * m.before(i, i)) / unit.Q(i, i);
    }
    u[0] = std::log(sum / (static_cast<double>(states()) * (m.records + m.transitions)));
  }
  [[nodiscard]] ProcessPtr process(std::span<const double> u, const Sampling& sampling) const override {
    return std::make_shared<Flicker>(
        FlickerParameters{.coefficient = std::exp(0.5 * u[0]), .shortest = kShortestTime, .longest = kLongestTime},
        si_unit(kSignal.of(sampling.sensor)));
  }

 private:
  void average(const SampleStep& step, SampleBlock& block) const {
    for (Eigen::Index i = 0; i < states(); ++i) {
      const AveragedVariances means = averaged_variances(unit_.rate(i) * step.interval, step.averaged);
      block.white += means.alone * block.P_first(i, i);
      block.Q(i, i) *= means.common;
      block.P_first(i, i) *= means.common;
    }
  }

  Flicker unit_;
};

const Estimable& estimable_flicker() {
  static const EstimableFlicker process;
  return process;
}

std::vector<ProcessPtr> make_flicker(const config::Node& entry, const EntryContext& context) {
  const FlickerParameters parameters{.coefficient = value_with_unit(entry, "coefficient", kSignal, context),
                                     .shortest = entry.number_within("shortest_time_s", kShortestTime, 1e-3, 1e8),
                                     .longest = entry.number_within("longest_time_s", kLongestTime, 1e-3, 1e8)};
  if (!(parameters.longest >= parameters.shortest))
    throw entry.error(fmt::format("longest_time_s {} below shortest_time_s {}", parameters.longest, parameters.shortest),
                      "a band of averaging times, shortest first");
  return {std::make_shared<Flicker>(parameters, si_unit(kSignal.of(context.sensor)))};
}

}  // namespace

Registration flicker() {
  return {"flicker",
          "bias instability: `coefficient` is B of IEEE 952, whose Allan deviation is flat at 0.664 B, here within 1 % for "
          "averaging times from `shortest_time_s` (10) to `longest_time_s` (10000); a sum of Gauss-Markov processes, three to "
          "every two decades, each a state of the filter",
          "{process: flicker, coefficient: 0.5, unit: deg/h}",
          "{process: flicker, coefficient: 30, unit: ug, shortest_time_s: 20, longest_time_s: 2000}",
          make_flicker,
          &estimable_flicker()};
}

}  // namespace coast::noise
