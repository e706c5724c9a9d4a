#include "warm_up.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "polish.hpp"
#include "short_likelihood.hpp"

namespace coast::noise {

namespace {

/// exp(-t/time_constant), t from the first sample of the grid on.
StaticSignal decay(const StaticSignal& like, double time_constant) {
  StaticSignal column = like;
  for (const StaticSignal::Run& run : like.runs)
    for (std::size_t i = 0; i < run.count; ++i)
      column.values[run.first + i] = std::exp(-static_cast<double>(run.start + i) * like.interval / time_constant);
  return column;
}

StaticSignal less(StaticSignal record, const StaticSignal& column, double factor) {
  for (std::size_t i = 0; i < record.values.size(); ++i) record.values[i] -= factor * column.values[i];
  return record;
}

/// Generalised least squares on data whitened by a sum.
class Regression {
 public:
  Regression(const StaticSignal& record, const SumModel& model, const std::vector<double>& u)
      : record_(detrend(record).signal), model_(processes_alone(model)), u_(u), y_(white(record_)) {
    StaticSignal column = record_;
    std::ranges::fill(column.values, 1.0);
    columns_.resize(y_.size(), 3);
    columns_.col(0) = white(column);
    columns_.col(1) = white(decay_limit(column));
  }

  struct Fitted {
    double amplitude = 0.0;
    double time_constant = 0.0;
    double squares = std::numeric_limits<double>::infinity();  ///< of the residuals
  };
  /// With a level, and a ramp if its gain is large enough for a parameter: the two are so alike that each hides the other's
  /// errors.
  Fitted at(double time_constant) {
    columns_.col(2) = white(decay(record_, time_constant));
    const Fitted alone = solved({0, 2}, time_constant);
    const Fitted beside = solved({0, 1, 2}, time_constant);
    return alone.squares - beside.squares > std::log(static_cast<double>(record_.values.size())) ? beside : alone;
  }
  /// Over a grid, then between the neighbours of the best.
  Fitted best() {
    constexpr int kPoints = 14;
    constexpr double kShortest = 0.01;  // of the record
    constexpr int kHalvings = 6;
    const double duration = record_.duration();
    double step = std::log(1.0 / kShortest) / (kPoints - 1);
    Fitted best;
    for (int i = 0; i < kPoints; ++i) take(at(duration * kShortest * std::exp(step * i)), best);
    for (int i = 0; i < kHalvings; ++i) {
      step *= 0.5;
      const double centre = best.time_constant;
      for (const double side : {-step, step}) take(at(std::min(duration, centre * std::exp(side))), best);
    }
    return best;
  }

 private:
  [[nodiscard]] Fitted solved(const std::vector<Eigen::Index>& which, double time_constant) const {
    const Eigen::MatrixXd columns = columns_(Eigen::all, which);
    const Eigen::VectorXd x = columns.colPivHouseholderQr().solve(y_);
    return {x(x.size() - 1), time_constant, (y_ - columns * x).squaredNorm()};
  }
  static void take(const Fitted& other, Fitted& best) {
    if (other.squares < best.squares) best = other;
  }
  static SumModel processes_alone(const SumModel& model) {
    std::vector<const Estimable*> processes;
    for (const SumModel::Term& term : model.terms()) processes.push_back(term.process);
    return {processes, Mean::kZero};
  }
  /// A ramp: the limit of a decay, except for a level, as its time constant grows.
  static StaticSignal decay_limit(StaticSignal column) {
    for (const StaticSignal::Run& run : column.runs)
      for (std::size_t i = 0; i < run.count; ++i)
        column.values[run.first + i] = static_cast<double>(run.start + i) / static_cast<double>(column.length()) - 0.5;
    return column;
  }
  [[nodiscard]] Eigen::VectorXd white(const StaticSignal& column) const {
    const Likelihood whole({column}, model_);
    const std::optional<Likelihood> means = on_block_means(whole, kMostValues);
    const std::vector<double> white = (means ? *means : whole).standardised_innovations(u_, 0);
    return Eigen::Map<const Eigen::VectorXd>(white.data(), static_cast<Eigen::Index>(white.size()));
  }

  static constexpr double kMostValues = 4000.0;  // a trend is at low frequencies

  StaticSignal record_;
  SumModel model_;
  std::vector<double> u_;
  Eigen::VectorXd y_;
  Eigen::MatrixXd columns_;
};

/// The sum fitted to records, starting from u.
Fit fitted(const std::vector<StaticSignal>& records, const SumModel& model, const std::vector<double>& u) {
  const Likelihood likelihood(records, model);
  const ShortLikelihood shortened(likelihood);
  Fit fit;
  fit.u = u;
  polish([&](const std::vector<double>& at) { return shortened.slope(at); }, model, model.ranges(likelihood.scale()), {},
         {.tolerance = 1e-4}, fit);
  return fit;
}

}  // namespace

std::vector<WarmUp> warm_ups_of(const std::vector<StaticSignal>& records, const Candidate& chosen) {
  constexpr int kRounds = 3;  // a better sum shows the trend better
  std::vector<WarmUp> found;
  std::vector<StaticSignal> rest = records;
  Fit now = fitted(rest, chosen.model, chosen.fit.u);
  const double samples = Likelihood(records, chosen.model).samples();
  for (std::size_t r = 0; r < records.size(); ++r) {
    Fit then = now;
    std::vector<StaticSignal> trial = rest;
    Regression::Fitted trend;
    for (int round = 0; round < kRounds; ++round) {
      trend = Regression(records[r], chosen.model, then.u).best();
      trial[r] = less(records[r], decay(records[r], trend.time_constant), trend.amplitude);
      then = fitted(trial, chosen.model, then.u);
    }
    const double gain = then.log_likelihood - now.log_likelihood;
    if (!(gain > std::log(samples))) continue;
    found.push_back({r, trend.amplitude, trend.time_constant, gain});
    rest = std::move(trial);
    now = std::move(then);
  }
  return found;
}

std::vector<StaticSignal> without_warm_ups(std::vector<StaticSignal> records, const std::vector<WarmUp>& warm_ups) {
  for (const WarmUp& w : warm_ups) {
    const StaticSignal column = decay(records[w.record], w.time_constant);
    records[w.record] = less(std::move(records[w.record]), column, w.amplitude);
  }
  return records;
}

}  // namespace coast::noise
