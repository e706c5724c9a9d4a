#include <fmt/format.h>

#include <cmath>

#include "autoregression.hpp"
#include "entry.hpp"
#include "processes/processes.hpp"

namespace coast::noise {

namespace {

struct ArParameters {
  Eigen::VectorXd coefficients;
  double innovation_sigma = 0.0;  ///< [signal]
  double rate_hz = 0.0;
};

/// Autoregressive series at a rate of its own, stationary from the start; each value is held until the next.
///
///     x[k] = a1 x[k-1] + ... + ap x[k-p] + e[k]            Box & Jenkins (1976) sec. 3.2
///
/// The filter asks for other intervals than whole samples. No power of the companion matrix serves for p > 1: its driving noise
/// has rank one over one step, and a continuous driving noise that leaves rank one over a step cannot excite p states. So the
/// states are those of the process in continuous time whose autocovariance at whole samples is that of the series, exact for
/// any interval; for p = 1 and 0 < a1 < 1 that is Gauss and Markov's. Where there is no such process (a pole that is not right
/// of zero, an oscillation of a few samples) they are the companion's, and an interval is taken for the nearest number of whole
/// steps.
class Ar final : public Process {
 public:
  Ar(const ArParameters& parameters, std::string_view unit)
      : p_(parameters),
        unit_(unit),
        series_(p_.coefficients, p_.innovation_sigma * p_.innovation_sigma),
        continuous_(ContinuousForm::of(p_.coefficients, p_.innovation_sigma * p_.innovation_sigma)) {}
  [[nodiscard]] std::string_view name() const override { return "ar"; }
  [[nodiscard]] int states() const override { return static_cast<int>(series_.order()); }
  void transition(double dt, Eigen::Ref<Eigen::MatrixXd> Phi) const override {
    if (continuous_)
      continuous_->transition(dt * p_.rate_hz, Phi);
    else
      Phi = series_.steps(whole_steps(dt)).Phi.cast<double>();
  }
  void driving_noise(double dt, Eigen::Ref<Eigen::MatrixXd> Q_d) const override {
    if (continuous_) return continuous_->driving_noise(dt * p_.rate_hz, Q_d);
    const Eigen::MatrixXd var_e = series_.steps(whole_steps(dt)).var_e.cast<double>();
    Q_d = 0.5 * (var_e + var_e.transpose());
  }
  void output(Eigen::Ref<Eigen::RowVectorXd> h) const override {
    if (continuous_) return continuous_->output(h);
    h.setZero();
    h(0) = 1.0;
  }
  void initial_covariance(Eigen::Ref<Eigen::MatrixXd> P) const override {
    if (continuous_)
      continuous_->covariance(P);
    else
      P = series_.covariance().cast<double>();
  }
  [[nodiscard]] std::optional<double> sample_interval() const override { return 1.0 / p_.rate_hz; }
  /// Of means over whole samples, exactly. Between, the variance is interpolated linearly; below one sample it falls to zero
  /// with tau, as for any signal that is held.
  [[nodiscard]] std::optional<double> allan_variance(double tau) const override {
    return interpolated(tau, &Autoregression::allan_variance);
  }
  [[nodiscard]] std::optional<double> hadamard_variance(double tau) const override {
    return interpolated(tau, &Autoregression::hadamard_variance);
  }
  [[nodiscard]] std::string yaml() const override {
    std::string list;
    for (const double a : p_.coefficients) list += fmt::format("{}{:.17g}", list.empty() ? "" : ", ", a);
    return fmt::format("{{process: ar, coefficients: [{}], innovation_sigma: {:.17g}, unit: {}, rate_hz: {:.17g}}}", list,
                       p_.innovation_sigma, unit_, p_.rate_hz);
  }

 private:
  [[nodiscard]] std::uint64_t whole_steps(double dt) const { return static_cast<std::uint64_t>(std::llround(dt * p_.rate_hz)); }
  [[nodiscard]] double interpolated(double tau, double (Autoregression::*variance)(std::uint64_t) const) const {
    const double samples = tau * p_.rate_hz;
    const double nearest = std::round(samples);
    const auto at = [&](double m) { return (series_.*variance)(static_cast<std::uint64_t>(m)); };
    if (nearest >= 1.0 && std::abs(samples - nearest) <= 1e-9 * nearest) return at(nearest);
    if (samples < 1.0) return samples * at(1.0);
    const double below = std::floor(samples);
    return at(below) + (samples - below) * (at(below + 1.0) - at(below));
  }

  ArParameters p_;
  std::string_view unit_;
  Autoregression series_;
  std::optional<ContinuousForm> continuous_;
};

std::vector<ProcessPtr> make_ar(const config::Node& entry, const EntryContext& context) {
  const config::Node list = entry.at("coefficients");
  const std::vector<double> coefficients = list.numbers();
  constexpr std::size_t kMostCoefficients = 12;
  if (coefficients.empty() || coefficients.size() > kMostCoefficients || coefficients.back() == 0.0)
    throw list.error(fmt::format("{} coefficients", coefficients.size()), "1 to 12 coefficients, the last not zero");
  ArParameters parameters;
  parameters.coefficients = Eigen::Map<const Eigen::VectorXd>(coefficients.data(), std::ssize(coefficients));
  const double pole = Autoregression::largest_pole(parameters.coefficients);
  constexpr double kStationary = 1.0 - 1e-12;  // nearer to 1 rounding decides
  if (!(pole < kStationary))
    throw list.error(
        fmt::format("a series that is not stationary: its largest pole has the modulus {:.6g}", pole),
        "all poles inside the unit circle",
        "x[k] = a1 x[k-1] + a2 x[k-2] + ...: other programs state the opposite sign. A random walk is random_walk.");
  parameters.innovation_sigma = value_with_unit(entry, "innovation_sigma", kSignal, context);
  const config::Node rate = entry.at("rate_hz");
  parameters.rate_hz = rate.number();
  if (!(parameters.rate_hz > 0.0)) throw rate.error(rate.text(), "a rate above zero");
  return {std::make_shared<Ar>(parameters, si_unit(kSignal.of(context.sensor)))};
}

}  // namespace

Registration ar() {
  return {"ar",
          "autoregressive series: x[k] = a1 x[k-1] + ... + ap x[k-p] + e[k] with `coefficients` [a1, ..., ap], e of standard "
          "deviation `innovation_sigma`, at `rate_hz`; stationary from the start, each value held until the next",
          "{process: ar, coefficients: [1.989, -0.98901], innovation_sigma: 5e-5, unit: deg/h, rate_hz: 1}",
          "{process: ar, coefficients: [0.998], innovation_sigma: 1, unit: ug, rate_hz: 1}", make_ar};
}

}  // namespace coast::noise
