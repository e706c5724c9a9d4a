#include <algorithm>
#include <cmath>
#include <set>

#include "double_differences.hpp"
#include "pass.hpp"
#include "quantile.hpp"

namespace coast::carrier {

namespace {

using Use = SignalResidual::Use;

/// Sums of squared residuals in units of their sd, and their degrees of freedom.
struct Sums {
  double squares = 0.0;
  double freedom = 0.0;

  [[nodiscard]] double scale(double otherwise) const {
    constexpr double kEnough = 30.0;
    return freedom < kEnough ? otherwise : std::sqrt(squares / freedom);
  }
};

Sums phases_of(const PpkEpoch& epoch) {
  Sums sums;
  std::set<std::pair<record::SatelliteSystem, char>> groups;
  double rows = 0.0;
  for (const SignalResidual& r : epoch.residuals) {
    if (!r.phase || r.use != Use::kFixed) continue;
    groups.insert({r.satellite.system, r.band});
    sums.squares += r.residual / r.sd * r.residual / r.sd;
    rows += 1.0;
  }
  sums.freedom = rows - static_cast<double>(groups.size()) - 3.0;
  return sums.freedom > 0.0 ? sums : Sums{};
}

/// Codes beyond this, in units of their sd, are reflections and not noise: four times the sd by the median.
double largest_code(const std::vector<PpkEpoch>& epochs) {
  constexpr double kMedian = 0.6745;  // of the magnitude of a unit normal
  constexpr double kSigmas = 4.0;
  std::vector<double> sizes;
  for (const PpkEpoch& epoch : epochs)
    for (const SignalResidual& r : epoch.residuals)
      if (!r.phase && r.use != Use::kLeftOut) sizes.push_back(std::abs(r.residual / r.sd));
  if (sizes.empty()) return 0.0;
  return kSigmas * median(std::move(sizes)) / kMedian;
}

Sums codes_of(const PpkEpoch& epoch, double largest) {
  Sums sums;
  std::set<std::pair<record::SatelliteSystem, char>> groups;
  for (const SignalResidual& r : epoch.residuals) {
    if (r.phase || r.use == Use::kLeftOut || std::abs(r.residual / r.sd) > largest) continue;
    groups.insert({r.satellite.system, r.band});
    sums.squares += r.residual / r.sd * r.residual / r.sd;
    sums.freedom += 1.0;
  }
  sums.freedom -= static_cast<double>(groups.size());
  return sums.freedom > 0.0 ? sums : Sums{};
}

/// Ratio of the variance of a long average of code residuals to that of independent ones: 1 + 2 sum rho_k, over the
/// lags before the correlation is lost in noise.
double inflation(const std::vector<PpkEpoch>& epochs, double largest) {
  constexpr std::size_t kLags = 60;
  constexpr double kLost = 0.1;
  std::map<std::pair<record::Satellite, char>, std::vector<std::pair<std::size_t, double>>> series;
  for (std::size_t i = 0; i < epochs.size(); ++i)
    for (const SignalResidual& r : epochs[i].residuals)
      if (!r.phase && r.use != Use::kLeftOut && std::abs(r.residual / r.sd) <= largest)
        series[{r.satellite, r.band}].emplace_back(i, r.residual / r.sd);
  double squares = 0.0, count = 0.0;
  std::vector<double> products(kLags + 1, 0.0), pairs(kLags + 1, 0.0);
  for (const auto& [signal, values] : series)
    for (std::size_t a = 0; a < values.size(); ++a) {
      squares += values[a].second * values[a].second;
      count += 1.0;
      for (std::size_t b = a + 1; b < values.size() && values[b].first - values[a].first <= kLags; ++b) {
        products[values[b].first - values[a].first] += values[a].second * values[b].second;
        pairs[values[b].first - values[a].first] += 1.0;
      }
    }
  double sum = 1.0;
  if (!(squares > 0.0)) return sum;
  for (std::size_t lag = 1; lag <= kLags && pairs[lag] > 0.0; ++lag) {
    const double rho = products[lag] / pairs[lag] * count / squares;
    if (rho < kLost) break;
    sum += 2.0 * rho;
  }
  return sum;
}

}  // namespace

NoiseScale estimate_noise(const std::vector<PpkEpoch>& epochs, const NoiseScale& noise) {
  constexpr double kLeast = 0.03, kMost = 10.0;
  const double largest = largest_code(epochs);
  Sums phases, codes;
  for (const PpkEpoch& epoch : epochs) {
    const Sums phase = phases_of(epoch), code = codes_of(epoch, largest);
    phases.squares += phase.squares;
    phases.freedom += phase.freedom;
    codes.squares += code.squares;
    codes.freedom += code.freedom;
  }
  return {std::clamp(noise.phase * phases.scale(1.0), kLeast, kMost), std::clamp(noise.code * codes.scale(1.0), kLeast, kMost),
          std::sqrt(inflation(epochs, largest)), noise.rate, noise.displacement};
}

double estimate_rate_noise(const std::vector<DifferenceEpoch>& differences, const std::vector<PpkEpoch>& solved,
                           const DifferenceOptions& options) {
  constexpr double kMedian = 0.4549;  // of a squared unit normal; the median, because velocities are means over an epoch
  constexpr double kLeast = 0.05, kMost = 100.0;
  constexpr std::size_t kEnough = 30;
  std::vector<double> squares;
  for (std::size_t i = 0; i < solved.size(); ++i) {
    if (solved[i].quality != record::FixQuality::kFixed || !solved[i].velocity) continue;
    Eigen::VectorXd x(6);
    x << solved[i].r_e, solved[i].velocity->v_e;
    const RelativeState state({kVelocityUnknowns.begin(), kVelocityUnknowns.end()}, x, Eigen::MatrixXd::Zero(6, 6));
    const DoubleDifferences dd = double_differences(differences[i], state, {}, options, {});
    const Eigen::VectorXd y = dd.B * dd.residual;
    for (Eigen::Index k = 0; k < y.size(); ++k) {
      Eigen::Index of = 0;
      dd.B.row(k).cwiseAbs().maxCoeff(&of);
      if (dd.rows[static_cast<std::size_t>(of)].observable == Observable::kRate) squares.push_back(y(k) * y(k));
    }
  }
  if (squares.size() < kEnough) return 1.0;
  return std::clamp(std::sqrt(median(std::move(squares)) / kMedian), kLeast, kMost);
}

}  // namespace coast::carrier
