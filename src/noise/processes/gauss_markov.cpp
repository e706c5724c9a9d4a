#include <fmt/format.h>

#include <cmath>

#include "entry.hpp"
#include "processes/block_averages.hpp"
#include "processes/estimables.hpp"
#include "processes/processes.hpp"
#include "scalar_process.hpp"

namespace coast::noise {

namespace {

/// sum over n >= 3 of (-u)^n/n! (a - b 2^n + c 3^n): a combination of exponentials and a polynomial whose terms below n = 3
/// cancel, for small u. For u <= 0.5 the terms left out are below rounding.
double left_of_exponentials(double a, double b, double c, double u) {
  double sum = 0.0;
  double power = 0.5 * u * u;  // (-u)^n/n!
  double two = 4.0;
  double three = 9.0;
  for (int n = 3; n < 30; ++n) {
    power *= -u / n;
    two *= 2.0;
    three *= 3.0;
    sum += power * (a - b * two + c * three);
  }
  return sum;
}

/// Stationary first-order Gauss-Markov process, discretised exactly:
///
///     x[k+1] = phi x[k] + w[k],    phi = exp(-beta dt),    var w = sigma^2 (1 - phi^2)
///
/// expm1 keeps full precision for beta dt -> 0. Stebler et al. (2011), Table I, gives the first-order form.
class GaussMarkov : public ScalarProcess {
 public:
  explicit GaussMarkov(const GaussMarkovParameters& parameters) : p_(parameters) {}
  [[nodiscard]] std::string_view name() const override { return p_.name; }
  [[nodiscard]] Input input() const override { return p_.input; }
  /// With u = beta tau: sigma^2/u^2 (2u - 3 + 4 exp(-u) - exp(-2u)); IEEE Std 952-1997 annex C, exponentially correlated
  /// noise, rearranged. The Hadamard variance is (15 V1 - 6 V2 + V3)/(6 tau^2), with V the variance of the integral over tau,
  /// 2 tau and 3 tau.
  [[nodiscard]] std::optional<double> allan_variance(double tau) const override {
    if (p_.input != Input::kOne) return {};
    const double u = p_.beta * tau;
    if (u == 0.0) return 0.0;
    const double bracket =
        u > 0.5 ? 2.0 * u - 3.0 + 4.0 * std::exp(-u) - std::exp(-2.0 * u) : left_of_exponentials(4.0, 1.0, 0.0, u);
    return p_.sigma * p_.sigma * bracket / (u * u);
  }
  [[nodiscard]] std::optional<double> hadamard_variance(double tau) const override {
    if (p_.input != Input::kOne) return {};
    const double u = p_.beta * tau;
    if (u == 0.0) return 0.0;
    const double bracket = u > 0.5 ? 6.0 * u - 10.0 + 15.0 * std::exp(-u) - 6.0 * std::exp(-2.0 * u) + std::exp(-3.0 * u)
                                   : left_of_exponentials(15.0, 6.0, 1.0, u);
    return p_.sigma * p_.sigma * bracket / (3.0 * u * u);
  }
  [[nodiscard]] std::string yaml() const override {
    const std::string time = p_.beta > 0.0 ? fmt::format(", correlation_time_s: {:.17g}", 1.0 / p_.beta) : "";
    return fmt::format("{{process: {}, sigma: {:.17g}, unit: {}{}}}", p_.name, p_.sigma / geo::unit(p_.unit).to_si, p_.unit,
                       time);
  }

 protected:
  [[nodiscard]] double phi(double dt) const override { return p_.beta > 0.0 ? std::exp(-p_.beta * dt) : 1.0; }
  [[nodiscard]] double q(double dt) const override { return -p_.sigma * p_.sigma * std::expm1(-2.0 * p_.beta * dt); }
  [[nodiscard]] double initial_variance() const override { return p_.sigma * p_.sigma; }

 private:
  GaussMarkovParameters p_;
};

/// Other intervals are multiples of the model's step: an exact process of another beta and sigma.
GaussMarkovParameters exact_equivalent(const GaussMarkovParameters& stated, FirstOrderForm form, double rate_hz) {
  const GaussMarkovValues values = noise::exact_equivalent({stated.beta, stated.sigma * stated.sigma}, form, 1.0 / rate_hz);
  GaussMarkovParameters exact = stated;
  exact.beta = values.beta;
  exact.sigma = std::sqrt(values.sigma2);
  return exact;
}

class FirstOrderGaussMarkov final : public GaussMarkov {
 public:
  FirstOrderGaussMarkov(const GaussMarkovParameters& stated, FirstOrderForm form, double rate_hz)
      : GaussMarkov(exact_equivalent(stated, form, rate_hz)), stated_(stated), form_(form) {}
  [[nodiscard]] std::string yaml() const override {
    std::string text = GaussMarkov(stated_).yaml();
    text.insert(text.size() - 1, form_ == FirstOrderForm::kTable1 ? ", first_order: table1" : ", first_order: section2e");
    return text;
  }

 protected:
  [[nodiscard]] double initial_variance() const override { return stated_.sigma * stated_.sigma; }

 private:
  GaussMarkovParameters stated_;
  FirstOrderForm form_;
};

std::vector<ProcessPtr> make_gauss_markov(const config::Node& entry, const EntryContext& context) {
  const GaussMarkovParameters parameters{.name = "gauss_markov",
                                         .sigma = value_with_unit(entry, "sigma", kSignal, context),
                                         .beta = 1.0 / entry.at("correlation_time_s").number(),
                                         .unit = si_unit(kSignal.of(context.sensor))};
  if (!(parameters.beta > 0.0) || !std::isfinite(parameters.beta))
    throw entry.at("correlation_time_s").error(entry.at("correlation_time_s").text(), "a correlation time above zero");
  const auto first_order = entry.find("first_order");
  if (!first_order) return {make_gauss_markov(parameters)};
  const auto form = static_cast<FirstOrderForm>(first_order->choice({"table1", "section2e"}));
  if (!(context.rate_hz > parameters.beta))
    throw first_order->error("a first-order form at a rate of " + fmt::format("{}", context.rate_hz) + " Hz",
                             "the model's rate_hz, above 1/correlation_time_s");
  return {std::make_shared<FirstOrderGaussMarkov>(parameters, form, context.rate_hz)};
}

/// The zero of `slope` in (low, high), positive at low, negative at high.
template <class Slope>
double zero_of(const Slope& slope, double low, double high) {
  for (int i = 0; i < 200 && high - low > 1e-15 * std::abs(high); ++i) {
    const double middle = 0.5 * (low + high);
    (slope(middle) > 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

SampleBlock scaled(SampleBlock block, double log_variance) {
  block.Q *= std::exp(log_variance);
  block.P_first *= std::exp(log_variance);
  return block;
}

/// u = log beta [1/s], log sigma^2 [signal]^2, discretised exactly, with a stationary start.
class EstimableGaussMarkov final : public Estimable {
 public:
  [[nodiscard]] std::string_view name() const override { return "gauss_markov"; }
  [[nodiscard]] std::string_view symbol() const override { return "GM"; }
  [[nodiscard]] std::vector<ParameterInfo> parameters() const override {
    return {{"beta", "1/s", ParameterInfo::Kind::kRate}, {"sigma2", "signal^2"}};
  }
  [[nodiscard]] Eigen::Index states() const override { return 1; }
  /// A correlation time of ten records cannot be distinguished from a random walk; one of a third of an interval is white.
  [[nodiscard]] std::vector<Interval> ranges(const SignalScale& scale) const override {
    return {{-std::log(10.0 * scale.duration), std::log(3.0 / scale.interval)}, log_variance_range(scale.variance)};
  }
  [[nodiscard]] SampleBlock block(std::span<const double> u, const SampleStep& step) const override {
    if (step.averaged > 1) return scaled(averaged_gauss_markov(std::exp(u[0]) * step.interval, step.averaged).value, u[1]);
    const double b = std::exp(u[0]) * step.interval;
    const double sigma2 = std::exp(u[1]);
    SampleBlock block = SampleBlock::zero(1);
    block.Phi(0, 0) = std::exp(-b);
    block.Q(0, 0) = -sigma2 * std::expm1(-2.0 * b);
    block.P_first(0, 0) = sigma2;
    block.h(0) = 1.0;
    return block;
  }
  [[nodiscard]] std::vector<SampleBlock> derivatives(std::span<const double> u, const SampleStep& step) const override {
    const SampleBlock at = block(u, step);
    const double b = std::exp(u[0]) * step.interval;
    if (step.averaged > 1) return {scaled(averaged_gauss_markov(b, step.averaged).slope, u[1]), variances_of(at)};
    SampleBlock by_beta = SampleBlock::zero(1);
    by_beta.Phi = -b * at.Phi;
    by_beta.Q(0, 0) = 2.0 * b * std::exp(u[1] - 2.0 * b);
    return {by_beta, variances_of(at)};
  }
  void maximise(const BlockMoments& m, double interval, const std::vector<bool>& fixed, std::span<double> u) const override;
  [[nodiscard]] ProcessPtr process(std::span<const double> u, const Sampling& sampling) const override {
    return noise::make_gauss_markov({.name = "gauss_markov",
                                     .sigma = std::exp(0.5 * u[1]),
                                     .beta = std::exp(u[0]),
                                     .unit = si_unit(kSignal.of(sampling.sensor))});
  }
};

/// Maximises, with d = 1 - phi and the stationary start,
///
///     -1/2 { (R + T) log sigma2 + T log(1 - phi^2) + s0/sigma2 + M(phi)/(sigma2 (1 - phi^2)) },
///     M = C - 2 phi B + phi^2 A = (C - 2 B + A) + 2 d (B - A) + d^2 A
///
/// over R records with T transitions. The slope in phi is a cubic with one sign change in (0, 1), whether sigma2 is free
/// (concentrated out) or fixed. In d there is no loss of digits for phi close to 1.
void EstimableGaussMarkov::maximise(const BlockMoments& m, double interval, const std::vector<bool>& fixed,
                                    std::span<double> u) const {
  const double A = m.before(0, 0);
  const double B = m.lagged(0, 0);
  const double C = m.after(0, 0);
  const double steps = C - 2.0 * B + A;
  const double T = m.transitions;
  const double R = m.records;
  const double s0 = m.first(0, 0);
  const auto M = [&](double d) { return steps + 2.0 * d * (B - A) + d * d * A; };
  const auto D = [](double d) { return d * (2.0 - d); };  // 1 - phi^2
  const auto free_slope = [&](double d) {
    const double phi = 1.0 - d;
    return (R + T) * ((A - s0) * phi - B) * D(d) + R * phi * (s0 * D(d) + M(d));
  };
  const auto fixed_slope = [&](double d) {
    const double phi = 1.0 - d;
    return -2.0 * T * phi * D(d) * std::exp(u[1]) + 2.0 * (phi * A - B) * D(d) + 2.0 * phi * M(d);
  };
  constexpr double kShortest = 1e-15;
  constexpr double kLongest = 1.0 - 1e-6;
  if (!fixed[0]) {
    const double d = fixed[1] ? zero_of(fixed_slope, kShortest, kLongest) : zero_of(free_slope, kShortest, kLongest);
    u[0] = std::log(-std::log1p(-d) / interval);
  }
  if (fixed[1]) return;
  const double d = -std::expm1(-std::exp(u[0]) * interval);
  u[1] = std::log((s0 + M(d) / D(d)) / (R + T));
}

}  // namespace

const Estimable& estimable_gauss_markov() {
  static const EstimableGaussMarkov process;
  return process;
}

GaussMarkovValues exact_equivalent(const GaussMarkovValues& stated, FirstOrderForm form, double dt) {
  const double drive = 2.0 * stated.beta * stated.sigma2 * (form == FirstOrderForm::kTable1 ? dt * dt : 1.0);
  const double lost = stated.beta * dt;  // 1 - phi
  return {-std::log1p(-lost) / dt, drive / (lost * (2.0 - lost))};
}

ProcessPtr make_gauss_markov(const GaussMarkovParameters& parameters) {
  return std::make_shared<GaussMarkov>(parameters);
}

double beta_of(const config::Node& entry) {
  const auto time = entry.find("correlation_time_s");
  if (!time) return 0.0;
  if (!(time->number() > 0.0)) throw time->error(time->text(), "a correlation time above zero");
  return 1.0 / time->number();
}

Registration gauss_markov() {
  return {"gauss_markov",
          "first-order Gauss-Markov process: `sigma` is the stationary standard deviation, `correlation_time_s` = 1/beta; "
          "`first_order: table1 | section2e` for the paper's approximate discretisations",
          "{process: gauss_markov, sigma: 0.1, unit: deg/h, correlation_time_s: 1000}",
          "{process: gauss_markov, sigma: 2e-4, unit: m/s^2, correlation_time_s: 2500}",
          make_gauss_markov,
          &estimable_gauss_markov()};
}

}  // namespace coast::noise
