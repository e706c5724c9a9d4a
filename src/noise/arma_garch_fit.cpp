#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "arma_garch_checks.hpp"
#include "arma_garch_climb.hpp"
#include "arma_garch_start.hpp"
#include "bounded_search.hpp"

namespace coast::noise {

using Eigen::VectorXd;

namespace {

/// About its mean and in units of its deviation: tolerances and boxes are then without unit.
struct ScaledArmaSeries {
  std::vector<double> y;
  double mean = 0.0;
  double deviation = 1.0;
};

ScaledArmaSeries scaled_series(const ArmaGarchSeries& series, bool constant) {
  const auto is_seen = [&](std::size_t t) { return series.is_missing.empty() || series.is_missing[t] == 0; };
  ScaledArmaSeries scaled;
  double count = 0.0;
  for (std::size_t t = 0; t < series.y.size(); ++t) {
    if (!is_seen(t)) continue;
    count += 1.0;
    if (constant) scaled.mean += (series.y[t] - scaled.mean) / count;
  }
  double squares = 0.0;
  for (std::size_t t = 0; t < series.y.size(); ++t)
    if (is_seen(t)) squares += (series.y[t] - scaled.mean) * (series.y[t] - scaled.mean);
  scaled.deviation = std::sqrt(squares / count);
  if (!(scaled.deviation > 0.0)) throw std::invalid_argument("fit_arma_garch: a series that does not vary");
  scaled.y.assign(series.y.size(), 0.0);
  for (std::size_t t = 0; t < series.y.size(); ++t)
    if (is_seen(t)) scaled.y[t] = (series.y[t] - scaled.mean) / scaled.deviation;
  return scaled;
}

/// The part of the series used to compare starts: the first samples until enough of them are observed.
ArmaGarchSeries beginning(const ArmaGarchSeries& series) {
  constexpr std::size_t kEnough = 3000;
  std::size_t seen = 0;
  std::size_t n = 0;
  for (; n < series.y.size() && seen < kEnough; ++n) seen += series.is_missing.empty() || series.is_missing[n] == 0 ? 1U : 0U;
  return {series.y.first(n), series.is_missing.empty() ? series.is_missing : series.is_missing.first(n)};
}

SearchResult explore(ArmaGarchRecursion& recursion, const ArmaGarchCoordinates& coordinates, const VectorXd& start) {
  constexpr double kGradient = 1e-4;  // per sample
  constexpr int kIterations = 60;
  const double count = static_cast<double>(recursion.observations());
  return search_within({start.begin(), start.end()}, coordinates.box(), kGradient, kIterations,
                       [&](const std::vector<double>& at, VectorXd& gradient) {
                         const VectorXd u = Eigen::Map<const VectorXd>(at.data(), std::ssize(at));
                         VectorXd by_centred;
                         const double value = recursion.slope(coordinates.centred(u), by_centred);
                         gradient = coordinates.centred_by_u(u).transpose() * by_centred / -count;
                         return -value / count;
                       });
}

/// Optima on the beginning from the starts, best first: one, or two if their order may change on the full series.
std::vector<VectorXd> promising(const ArmaGarchSeries& series, const ArmaGarchOrders& orders, const ArmaGarchOptions& options) {
  constexpr double kDecided = 20.0;  // of log-likelihood on the beginning: the worse one will not win on the full series
  constexpr double kSameTop = 0.01;
  const ArmaGarchCoordinates coordinates(orders, options.constant);
  ArmaGarchRecursion recursion(orders, series, options.start);
  std::vector<SearchResult> found;
  for (const VectorXd& start : arma_garch_starts(series, orders, recursion, coordinates))
    found.push_back(explore(recursion, coordinates, start));
  std::ranges::stable_sort(found, {}, &SearchResult::value);
  std::vector<VectorXd> tops;
  const double count = static_cast<double>(recursion.observations());
  for (const SearchResult& result : found) {
    const double behind = count * (result.value - found.front().value);
    if (tops.size() == 1 && behind < kSameTop) continue;
    if (tops.size() == 2 || behind > kDecided) break;
    tops.emplace_back(Eigen::Map<const VectorXd>(result.u.data(), std::ssize(result.u)));
  }
  return tops;
}

}  // namespace

double ArmaGarchFit::aic() const {
  return 2.0 * (parameters - log_likelihood);
}
double ArmaGarchFit::aicc() const {
  const double k = parameters;
  return aic() + 2.0 * k * (k + 1.0) / (static_cast<double>(observations) - k - 1.0);
}

ArmaGarchFit fit_arma_garch(const ArmaGarchSeries& series, const ArmaGarchOrders& orders, const ArmaGarchOptions& options) {
  check_arma_garch(orders);
  check_arma_garch(series, orders);
  const ScaledArmaSeries scaled = scaled_series(series, options.constant);
  const ArmaGarchSeries all{scaled.y, series.is_missing};
  const ArmaGarchCoordinates coordinates(orders, options.constant);
  ArmaGarchRecursion recursion(orders, all, options.start);
  ArmaGarchTop best{{}, -std::numeric_limits<double>::infinity(), false, 0};
  int evaluations = 0;
  for (const VectorXd& u : promising(beginning(all), orders, options)) {
    ArmaGarchTop top = climb_arma_garch(recursion, coordinates, u);
    evaluations += top.evaluations;
    if (top.value > best.value) best = std::move(top);
  }
  VectorXd centred = coordinates.centred(best.u);
  centred(0) = scaled.mean + scaled.deviation * centred(0);
  centred(coordinates.layout().gamma0()) *= scaled.deviation * scaled.deviation;
  ArmaGarchFit fit;
  fit.model = model_of_centred(coordinates.layout(), centred);
  fit.options = options;
  fit.observations = recursion.observations();
  fit.log_likelihood = best.value - static_cast<double>(fit.observations) * std::log(scaled.deviation);
  fit.parameters = static_cast<int>(coordinates.layout().size()) - (options.constant ? 0 : 1);
  fit.converged = best.converged;
  fit.evaluations = evaluations;
  fit.nearest_root_pair = fit.model.nearest_root_pair();
  return fit;
}

}  // namespace coast::noise
