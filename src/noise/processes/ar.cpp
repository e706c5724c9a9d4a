#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "autoregression.hpp"
#include "bounded_search.hpp"
#include "coast/noise/partial_autocorrelation.hpp"
#include "entry.hpp"
#include "processes/estimables.hpp"
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
/// The filter also needs fractions of the sample interval. Powers of the companion matrix do not serve for p > 1: its noise
/// has rank one over one step, and a continuous driving noise that leaves rank one over a step cannot excite p states. So the
/// states are those of the continuous-time process whose autocovariance at integer lags is that of the series, exact for
/// any interval; for p = 1 and 0 < a1 < 1 that is the Gauss-Markov process. If there is no such process (a pole that is not
/// right of zero, an oscillation of a few samples) they are the companion's, and an interval is rounded to the nearest number
/// of steps.
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
  [[nodiscard]] std::optional<geo::Psd> as_white() const override {
    constexpr double kForgets = 0.1;  // s
    constexpr double kRings = 0.05;   // Hz
    for (const std::complex<double>& pole : Autoregression::poles(p_.coefficients)) {
      const bool forgets = -std::log(std::abs(pole)) * p_.rate_hz * kForgets > 1.0;
      const bool rings = std::abs(std::arg(pole)) * p_.rate_hz > 2.0 * std::numbers::pi * kRings;
      if (!forgets && !rings) return {};
    }
    const double gain = p_.innovation_sigma / (1.0 - p_.coefficients.sum());
    return geo::Psd{gain * gain / p_.rate_hz};
  }
  /// Exact for means over an integer number of samples. Between, the variance is interpolated linearly; below one sample it
  /// decreases to zero with tau, as for any signal that is held.
  [[nodiscard]] std::optional<double> allan_variance(double tau) const override {
    return interpolated(tau, &Autoregression::allan_variance);
  }
  [[nodiscard]] std::optional<double> hadamard_variance(double tau) const override {
    return interpolated(tau, &Autoregression::hadamard_variance);
  }
  /// Poles r exp(+-i w) with 0 > log r > -w/2: a band about w/(2 pi dt) with half-power width -log r/(pi dt).
  [[nodiscard]] std::string in_words() const override {
    std::string bands;
    for (const std::complex<double>& pole : Autoregression::poles(p_.coefficients)) {
      const double decay = -std::log(std::abs(pole));
      if (!(std::arg(pole) > 2.0 * decay)) continue;
      bands += fmt::format("{} {:.4g} Hz ({:.3g} Hz wide)", bands.empty() ? "" : " and",
                           std::arg(pole) * p_.rate_hz / (2.0 * std::numbers::pi), decay * p_.rate_hz / std::numbers::pi);
    }
    if (bands.empty()) return {};
    return fmt::format("AR({}) rings at{}, rms {:.3g} {}", p_.coefficients.size(), bands,
                       std::sqrt(static_cast<double>(series_.covariance()(0, 0))), unit_);
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
  constexpr double kStationary = 1.0 - 1e-12;  // closer to 1 the result depends on rounding
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

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// X = A X A' + W.
MatrixXd lyapunov(const MatrixXd& A, const MatrixXd& W) {
  const Index p = A.rows();
  MatrixXd system = MatrixXd::Identity(p * p, p * p);
  for (Index i = 0; i < p; ++i)
    for (Index j = 0; j < p; ++j) system.block(i * p, j * p, p, p) -= A(i, j) * A;
  const VectorXd x = system.partialPivLu().solve(VectorXd(W.reshaped()));
  const MatrixXd X = x.reshaped(p, p);
  return 0.5 * (X + X.transpose());
}

/// Coefficients from given partial autocorrelations, and their derivatives (Levinson & Durbin; Barndorff-Nielsen & Schou 1973):
/// stationary for any partial autocorrelations inside (-1, 1).
struct Coefficients {
  VectorXd a;
  MatrixXd slope;  ///< d a/d partial
};
Coefficients from_partial(const VectorXd& partial) {
  const Index p = partial.size();
  Coefficients now{VectorXd::Zero(p), MatrixXd::Zero(p, p)};
  for (Index k = 0; k < p; ++k) {
    const Coefficients before = now;
    for (Index j = 0; j < k; ++j) {
      now.a(j) = before.a(j) - partial(k) * before.a(k - 1 - j);
      now.slope.row(j) = before.slope.row(j) - partial(k) * before.slope.row(k - 1 - j);
      now.slope(j, k) -= before.a(k - 1 - j);
    }
    now.a(k) = partial(k);
    now.slope(k, k) = 1.0;
  }
  return now;
}

/// The inverse; none if the series is not stationary.
std::optional<VectorXd> to_partial(VectorXd a) {
  VectorXd partial(a.size());
  for (Index k = a.size() - 1; k >= 0; --k) {
    partial(k) = a(k);
    if (!(std::abs(partial(k)) < 1.0)) return {};
    const VectorXd now = a;
    for (Index j = 0; j < k; ++j) a(j) = (now(j) + partial(k) * now(k - 1 - j)) / (1.0 - partial(k) * partial(k));
  }
  return partial;
}

/// u = atanh of the partial autocorrelations, then log of the innovation's variance; at the sample interval of the record.
class EstimableAr final : public Estimable {
 public:
  explicit EstimableAr(Index order) : order_(order), symbol_(fmt::format("AR({})", order)) {}
  [[nodiscard]] std::string_view name() const override { return "ar"; }
  [[nodiscard]] std::string_view symbol() const override { return symbol_; }
  [[nodiscard]] std::vector<ParameterInfo> parameters() const override {
    constexpr std::array<std::string_view, 4> kNames{"partial1", "partial2", "partial3", "partial4"};
    std::vector<ParameterInfo> all;
    for (Index i = 0; i < order_; ++i)
      all.push_back({kNames.at(static_cast<std::size_t>(i)), "1", ParameterInfo::Kind::kPartial});
    all.push_back({"innovation2", "signal^2"});
    return all;
  }
  [[nodiscard]] Index states() const override { return order_; }
  /// As white noise of the same density at zero frequency: the neglected part decreases with the length of a block.
  [[nodiscard]] bool has_averages() const override { return true; }
  [[nodiscard]] std::vector<Interval> ranges(const SignalScale& scale) const override {
    constexpr double kNearOne = 9.0;  // tanh 9 is 3e-8 from 1
    std::vector<Interval> all(static_cast<std::size_t>(order_), {-kNearOne, kNearOne});
    all.push_back(log_variance_range(scale.variance));
    return all;
  }
  [[nodiscard]] SampleBlock block(std::span<const double> u, const SampleStep& step) const override {
    if (step.averaged > 1) {
      SampleBlock means = SampleBlock::zero(0);
      const double gain = 1.0 / (1.0 - from_partial(partial_of(u)).a.sum());
      means.white = std::exp(u[static_cast<std::size_t>(order_)]) * gain * gain / static_cast<double>(step.averaged);
      return means;
    }
    SampleBlock block = SampleBlock::zero(order_);
    block.Phi.row(0) = from_partial(partial_of(u)).a.transpose();
    for (Index i = 1; i < order_; ++i) block.Phi(i, i - 1) = 1.0;
    block.Q(0, 0) = std::exp(u[static_cast<std::size_t>(order_)]);
    block.P_first = lyapunov(block.Phi, block.Q);
    block.h(0) = 1.0;
    return block;
  }
  [[nodiscard]] std::vector<SampleBlock> derivatives(std::span<const double> u, const SampleStep& step) const override {
    const SampleBlock at = block(u, step);
    const VectorXd partial = partial_of(u);
    const MatrixXd slope = from_partial(partial).slope;
    std::vector<SampleBlock> all;
    if (step.averaged > 1) {
      const double gain = 1.0 / (1.0 - from_partial(partial).a.sum());
      for (Index i = 0; i < order_; ++i) {
        all.push_back(at);
        all.back().white *= 2.0 * gain * slope.col(i).sum() * (1.0 - partial(i) * partial(i));
      }
      all.push_back(at);
      return all;
    }
    for (Index i = 0; i < order_; ++i) {
      SampleBlock by_partial = SampleBlock::zero(order_);
      by_partial.Phi.row(0) = (1.0 - partial(i) * partial(i)) * slope.col(i).transpose();
      const MatrixXd moved = by_partial.Phi * at.P_first * at.Phi.transpose();
      by_partial.P_first = lyapunov(at.Phi, moved + moved.transpose());
      all.push_back(by_partial);
    }
    all.push_back(variances_of(at));
    return all;
  }
  void maximise(const BlockMoments& m, double interval, const std::vector<bool>& fixed, std::span<double> u) const override;
  [[nodiscard]] ProcessPtr process(std::span<const double> u, const Sampling& sampling) const override {
    return std::make_shared<Ar>(ArParameters{from_partial(partial_of(u)).a, std::exp(0.5 * u[static_cast<std::size_t>(order_)]),
                                             1.0 / sampling.interval},
                                si_unit(kSignal.of(sampling.sensor)));
  }

 private:
  [[nodiscard]] VectorXd partial_of(std::span<const double> u) const {
    VectorXd partial(order_);
    for (Index i = 0; i < order_; ++i) partial(i) = std::tanh(u[static_cast<std::size_t>(i)]);
    return partial;
  }
  /// Expected complete log-likelihood, without constants.
  [[nodiscard]] double expected(const BlockMoments& m, std::span<const double> u) const {
    const SampleBlock at = block(u, 1.0);
    const VectorXd a = at.Phi.row(0);
    const double squares = m.after(0, 0) - 2.0 * a.dot(m.lagged.row(0)) + a.dot(m.before * a);
    const Eigen::LLT<MatrixXd> start(at.P_first);
    const double log_start = 2.0 * MatrixXd(start.matrixL()).diagonal().array().log().sum();
    return -0.5 *
           (m.transitions * std::log(at.Q(0, 0)) + squares / at.Q(0, 0) + m.records * log_start + start.solve(m.first).trace());
  }

  Index order_;
  std::string symbol_;
};

/// The maximum is the regression of the expected transitions, except for the stationary start; from there, or from the previous
/// values, a search over the few parameters includes the start.
void EstimableAr::maximise(const BlockMoments& m, double, const std::vector<bool>& fixed, std::span<double> u) const {
  const std::vector<double> from(u.begin(), u.end());
  std::vector<double> start = from;
  const VectorXd a = m.before.ldlt().solve(VectorXd(m.lagged.row(0)));
  const double variance = (m.after(0, 0) - a.dot(m.lagged.row(0))) / m.transitions;
  const std::optional<VectorXd> partial = to_partial(a);
  for (std::size_t i = 0; i < start.size() && partial && variance > 0.0; ++i)
    if (!fixed[i]) start[i] = i + 1 < start.size() ? std::atanh((*partial)(static_cast<Index>(i))) : std::log(variance);
  if (!(expected(m, start) > expected(m, from))) start = from;
  std::vector<Interval> box;
  constexpr double kReach = 1.0;  // from the start; the next M-step continues
  for (std::size_t i = 0; i < start.size(); ++i)
    box.push_back(fixed[i] ? Interval{start[i], start[i]} : Interval{start[i] - kReach, start[i] + kReach});
  constexpr double kStep = 1e-5;
  const auto cost = [&](std::vector<double> at, VectorXd& gradient) {
    for (std::size_t i = 0; i < at.size(); ++i) {
      const double here = at[i];
      at[i] = here + kStep;
      const double above = expected(m, at);
      at[i] = here - kStep;
      gradient(static_cast<Index>(i)) = (expected(m, at) - above) / (2.0 * kStep);
      at[i] = here;
    }
    return -expected(m, at);
  };
  const SearchResult found = search_within(start, box, 1e-4, 50, cost);
  if (-found.value >= expected(m, from)) std::ranges::copy(found.u, u.begin());
}

}  // namespace

std::optional<std::vector<double>> partial_autocorrelations(std::span<const double> coefficients) {
  const std::optional<VectorXd> partial = to_partial(Eigen::Map<const VectorXd>(coefficients.data(), std::ssize(coefficients)));
  if (!partial) return {};
  return std::vector<double>(partial->begin(), partial->end());
}

const Estimable& estimable_ar(int order) {
  static const std::array<EstimableAr, 4> orders{EstimableAr(1), EstimableAr(2), EstimableAr(3), EstimableAr(4)};
  if (order < 1 || order > static_cast<int>(orders.size()))
    throw std::invalid_argument(
        fmt::format("an autoregression of order {} cannot be estimated, only 1 to {}", order, orders.size()));
  return orders.at(static_cast<std::size_t>(order - 1));
}

Registration ar() {
  return {"ar",
          "autoregressive series: x[k] = a1 x[k-1] + ... + ap x[k-p] + e[k] with `coefficients` [a1, ..., ap], e of standard "
          "deviation `innovation_sigma`, at `rate_hz`; stationary from the start, each value held until the next",
          "{process: ar, coefficients: [1.989, -0.98901], innovation_sigma: 5e-5, unit: deg/h, rate_hz: 1}",
          "{process: ar, coefficients: [0.998], innovation_sigma: 1, unit: ug, rate_hz: 1}",
          make_ar,
          &estimable_ar(2)};
}

}  // namespace coast::noise
