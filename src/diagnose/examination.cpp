#include "coast/diagnose/examination.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "coast/noise/chi_square.hpp"
#include "coast/simulate/random.hpp"

namespace coast::diagnose {

namespace {

// What is plausible is known to an order of magnitude or two. An effect of which less than that is known is not seen at all.
constexpr double kBlind = 30.0;

constexpr double kEpisode = 10.0;  // s; onsets closer than this are hardly different hypotheses

/// A disturbance within an interval is a bias that steps at its beginning and back at its end.
class DisturbanceRecorder {
 public:
  DisturbanceRecorder(const Hypotheses& hypotheses, const ExaminationOptions& options, std::size_t intervals,
                      Disturbances& into)
      : rows_(1 + std::min(options.draws, options.draws_of_disturbances)), into_(into) {
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      step_[axis] = hypotheses.bias_step(axis < 3 ? Site::kGyro : Site::kAccel, static_cast<Eigen::Index>(axis % 3));
      into_.score[axis].resize(rows_, static_cast<Eigen::Index>(intervals));
      behind_[axis] = Eigen::VectorXd::Zero(rows_);
    }
    into_.t.resize(intervals);
    into_.length.resize(intervals);
    left_ = intervals;
  }
  void add(const estimate::Evidence& e) {
    const bool is_interval = end_.has_value() && left_ > 0;
    if (is_interval) --left_;
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      Eigen::VectorXd now(rows_);
      now << -e.r_effects(step_[axis]), -e.null_r_effects.row(step_[axis]).head(rows_ - 1).transpose();
      if (is_interval) into_.score[axis].col(static_cast<Eigen::Index>(left_)) = (now - behind_[axis]).cast<float>();
      behind_[axis] = std::move(now);
    }
    if (is_interval) {
      into_.t[left_] = e.t;
      into_.length[left_] = *end_ - e.t;
    }
    end_ = e.t;
  }

 private:
  Eigen::Index rows_;
  Disturbances& into_;
  std::array<Eigen::Index, kAxes> step_{};
  std::array<Eigen::VectorXd, kAxes> behind_;
  std::optional<geo::GpsTime> end_;
  std::size_t left_ = 0;
};

class Recorder {
 public:
  Recorder(const Hypotheses& hypotheses, const ExaminationOptions& options, const estimate::KnotStore& knots, Examination& into)
      : hypotheses_(hypotheses),
        into_(into),
        disturbances_(hypotheses, options, knots.size() > 0 ? knots.size() - 1 : 0, into.disturbances) {
    if (knots.size() > 0) earliest_ = knots.at(0).post.nav.t + kEpisode;
    for (Eigen::Index i = 0; i < hypotheses.size(); ++i)
      if (hypotheses[i].begins_at_some_time()) into.tracks.push_back({i, {}, {}, {}, Eigen::VectorXd::Zero(options.draws)});
  }
  void add(const estimate::Evidence& e) {
    into_.score = -e.r_effects;
    into_.information = e.N_effects;
    into_.null_score = -e.null_r_effects;
    disturbances_.add(e);
    for (Examination::Track& track : into_.tracks) {
      const Eigen::Index i = track.hypothesis;
      const double information = e.N_effects(i, i);
      const double plausible = kBlind * hypotheses_[i].plausible;
      if (e.t < earliest_ || information * plausible * plausible < 1.0) continue;
      track.t.push_back(e.t);
      track.score.push_back(-e.r_effects(i));
      track.information.push_back(information);
      track.null_largest = track.null_largest.cwiseMax(e.null_r_effects.row(i).transpose().cwiseAbs2() / information);
    }
  }
  void finish() {  // the pass went backward
    for (Examination::Track& track : into_.tracks) {
      std::ranges::reverse(track.t);
      std::ranges::reverse(track.score);
      std::ranges::reverse(track.information);
    }
  }

 private:
  const Hypotheses& hypotheses_;
  Examination& into_;
  DisturbanceRecorder disturbances_;
  geo::GpsTime earliest_;  ///< of an onset: what begins before has been there from the start
};

/// The hypotheses, and behind them some of them as they act from some instant on.
class WithStarted : public estimate::Effects {
 public:
  WithStarted(const Hypotheses& hypotheses, const std::vector<Examination::Started>& started)
      : hypotheses_(hypotheses), started_(started) {}
  [[nodiscard]] Eigen::Index size() const override { return hypotheses_.size() + static_cast<Eigen::Index>(started_.size()); }
  void add_sensor_errors(const estimate::SampleView& sample, Eigen::Matrix3Xd& gyro_b,
                         Eigen::Matrix3Xd& accel_b) const override {
    hypotheses_.add_sensor_errors(sample, gyro_b, accel_b);
    for_each_at(sample.nav.t, [&](Eigen::Index to, Eigen::Index of) {
      gyro_b.col(to) = gyro_b.col(of);
      accel_b.col(to) = accel_b.col(of);
    });
  }
  void add_measurement_errors(const estimate::MeasurementView& measurement, Eigen::MatrixXd& D) const override {
    hypotheses_.add_measurement_errors(measurement, D);
    for_each_at(measurement.nav.t, [&](Eigen::Index to, Eigen::Index of) { D.col(to) = D.col(of); });
  }

 private:
  template <typename Take>
  void for_each_at(geo::GpsTime t, const Take& take) const {
    for (std::size_t k = 0; k < started_.size(); ++k)
      if (t >= started_[k].from) take(hypotheses_.size() + static_cast<Eigen::Index>(k), started_[k].hypothesis);
  }
  const Hypotheses& hypotheses_;
  const std::vector<Examination::Started>& started_;
};

/// Scores and information of hypotheses that last the mission, those taken estimated beside them.
class Conditional {
 public:
  Conditional(const Examination& e, const std::vector<Eigen::Index>& taken) : e_(e), taken_(taken) {
    if (!taken.empty())
      of_taken_ = covariance_of(e.information(taken, taken)) * Eigen::MatrixXd(e.information(taken, Eigen::all));
  }
  [[nodiscard]] double information(Eigen::Index i) const {
    if (taken_.empty()) return e_.information(i, i);
    return e_.information(i, i) - Eigen::VectorXd(e_.information(taken_, i)).dot(of_taken_.col(i));
  }
  [[nodiscard]] double score(Eigen::Index i) const {
    if (taken_.empty()) return e_.score(i);
    return e_.score(i) - of_taken_.col(i).dot(Eigen::VectorXd(e_.score(taken_)));
  }
  [[nodiscard]] Eigen::VectorXd null_score(Eigen::Index i) const {
    if (taken_.empty()) return e_.null_score.row(i).transpose();
    return e_.null_score.row(i).transpose() - Eigen::MatrixXd(e_.null_score(taken_, Eigen::all)).transpose() * of_taken_.col(i);
  }

 private:
  const Examination& e_;
  const std::vector<Eigen::Index>& taken_;
  Eigen::MatrixXd of_taken_;  ///< I_aa^-1 I_a
};

/// Whether the information tells more than nothing of what is plausible.
bool is_seen(const Hypothesis& h, double information) {
  const double plausible = kBlind * h.plausible;
  return information * plausible * plausible > 1.0;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

Suspicion best_of(const Examination::Track& track, const Hypothesis& h) {
  std::size_t best = 0;
  const auto ratio = [&](std::size_t k) { return track.score[k] * track.score[k] / track.information[k]; };
  for (std::size_t k = 1; k < track.t.size(); ++k)
    if (ratio(k) > ratio(best)) best = k;
  // All instants whose likelihood ratio is less below the largest than that of a change point is by chance: 95 % of
  // (1 - exp(-x/2))^2, the larger of two random walks downhill (Hansen 2000, Econometrica 68, eq. 9), not chi-square.
  constexpr double kDrop = 7.35;
  std::size_t first = 0;
  std::size_t last = track.t.size() - 1;
  while (first < best && ratio(first) <= ratio(best) - kDrop) ++first;
  while (last > best && ratio(last) <= ratio(best) - kDrop) --last;
  // The interval reaches to the neighbours that are excluded: between two knots nothing tells.
  const geo::GpsTime before = track.t[first > 0 ? first - 1 : 0];
  const geo::GpsTime behind = track.t[std::min(last + 1, track.t.size() - 1)];
  geo::GpsTime from = track.t[best];
  if (!h.effect->sensors && best > 0) {
    // Of what only fixes see every instant since the last of them is as good. In the middle no shift of tags moves a fix
    // across.
    std::size_t fix = best;
    while (fix + 1 < track.t.size() && ratio(fix + 1) == ratio(best)) ++fix;
    from = track.t[best - 1] + 0.5 * (track.t[fix] - track.t[best - 1]);
  }
  const double reach = std::max(from - before, behind - from);
  const double places = std::max(1.0, (track.t.back() - track.t.front()) / kEpisode);
  return {.hypothesis = track.hypothesis,
          .from = from,
          .from_sd_s = reach / 1.96,
          .estimate = track.score[best] / track.information[best],
          .sd = 1.0 / std::sqrt(track.information[best]),
          .usual_sd = 1.0 / std::sqrt(median(track.information)),
          .likelihood_ratio = ratio(best),
          .log_bayes = log_bayes_factor(track.score[best], track.information[best], h.plausible) - std::log(places)};
}

}  // namespace

Examination examine(const estimate::Mission& mission, const estimate::StateLayout& layout, const estimate::KnotStore& knots,
                    const Hypotheses& hypotheses, const ExaminationOptions& options,
                    const std::function<void(double)>& progress) {
  Examination result;
  result.started = options.started;
  const WithStarted effects(hypotheses, result.started);
  Recorder recorder(hypotheses, options, knots, result);
  simulate::Normal normal(simulate::stream_seed(options.seed, {1}));
  estimate::EffectPassOptions pass;
  pass.draws = options.draws;
  pass.counts = options.counts;
  pass.fill_normal = [&normal](Eigen::Ref<Eigen::MatrixXd> values) {
    for (double& value : values.reshaped()) value = normal();
  };
  pass.progress = progress;
  estimate::effect_pass(mission, layout, knots, effects, pass, [&](const estimate::Evidence& e) { recorder.add(e); });
  recorder.finish();
  return result;
}

bool Examination::take_draws_of(const Examination& other) {
  constexpr double kSame = 0.05;  // of the variance of the score of each that lasts the mission
  const Disturbances& theirs = other.disturbances;
  if (information.rows() != other.information.rows() || disturbances.t.size() != theirs.t.size() || started != other.started)
    return false;
  Eigen::ArrayXd change =
      (information - other.information).diagonal().array().abs() - kSame * other.information.diagonal().array();
  for (const Track& track : tracks) change(track.hypothesis) = 0.0;
  if ((change > 0.0).any()) return false;
  null_score = other.null_score;
  for (std::size_t i = 0; i < tracks.size(); ++i) tracks[i].null_largest = other.tracks[i].null_largest;
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    Eigen::MatrixXf rows = theirs.score[axis];
    rows.row(0) = disturbances.score[axis].row(0);
    disturbances.score[axis] = std::move(rows);
  }
  return true;
}

LargestByChance LargestByChance::of(std::vector<double> largest) {
  if (largest.empty()) return {};
  return {std::max(1.0, std::log(0.5) / std::log1p(-noise::chi2_survival(1.0, median(std::move(largest)))))};
}

double LargestByChance::p_value(double likelihood_ratio) const {
  return -std::expm1(count * std::log1p(-noise::chi2_survival(1.0, likelihood_ratio)));
}

double LargestByChance::quantile(double probability) const {
  return noise::chi2_upper_quantile(1.0, -std::expm1(std::log1p(-probability) / count));
}

void Suspicions::judge(const LargestByChance& by_chance) {
  chance = by_chance;
  for (std::vector<Suspicion>* some : {&all, &implausible})
    for (Suspicion& s : *some) s.p_value = chance.p_value(s.likelihood_ratio);
}

const Suspicion* Suspicions::of(Eigen::Index hypothesis) const {
  for (const std::vector<Suspicion>* some : {&all, &implausible}) {
    const auto at = std::ranges::find(*some, hypothesis, &Suspicion::hypothesis);
    if (at != some->end()) return &*at;
  }
  return nullptr;
}

Suspicions suspicions(const Examination& examination, const Hypotheses& hypotheses, const std::vector<Eigen::Index>& taken) {
  constexpr double kSame = 1e-4;  // of the variance: correlated by 0.99995 with what is taken
  Suspicions result;
  const Conditional conditional(examination, taken);
  Eigen::VectorXd largest = Eigen::VectorXd::Zero(examination.null_score.cols());
  for (Eigen::Index i = 0; i < hypotheses.size(); ++i) {
    const Hypothesis& h = hypotheses[i];
    if (h.begins_at_some_time() || std::ranges::find(taken, i) != taken.end()) continue;
    const double information = conditional.information(i);
    if (!(information > kSame * examination.information(i, i))) continue;
    const double score = conditional.score(i);
    const bool seen = is_seen(h, information);
    if (seen) largest = largest.cwiseMax(conditional.null_score(i).cwiseAbs2() / information);
    (seen ? result.all : result.implausible)
        .push_back({.hypothesis = i,
                    .from = {},
                    .from_sd_s = 0.0,
                    .estimate = score / information,
                    .sd = 1.0 / std::sqrt(information),
                    .usual_sd = 1.0 / std::sqrt(information),
                    .likelihood_ratio = score * score / information,
                    .log_bayes = log_bayes_factor(score, information, h.plausible)});
  }
  for (const Examination::Track& track : examination.tracks) {
    if (track.t.empty()) continue;
    largest = largest.cwiseMax(track.null_largest);
    result.all.push_back(best_of(track, hypotheses[track.hypothesis]));
  }
  result.judge(LargestByChance::of({largest.begin(), largest.end()}));
  return result;
}

Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& information) {
  constexpr double kSame = 1e-6;  // of the variance: rounding
  const Eigen::VectorXd scale =
      information.diagonal().unaryExpr([](double of) { return of > 0.0 ? 1.0 / std::sqrt(of) : 0.0; });
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scale.asDiagonal() * information * scale.asDiagonal());
  const Eigen::VectorXd inverse = solver.eigenvalues().unaryExpr([](double of) { return of > kSame ? 1.0 / of : 0.0; });
  const Eigen::MatrixXd columns = scale.asDiagonal() * solver.eigenvectors();
  return columns * inverse.asDiagonal() * columns.transpose();
}

// A Cauchy distribution is a mixture of normal ones with sd = plausible/|n|, n standard normal, and so is the ratio.
double log_bayes_factor(double score, double information, double plausible) {
  constexpr int kParts = 48;
  constexpr double kFrom = -11.0;  // ln |n|
  constexpr double kTo = 1.4;
  constexpr double kStep = (kTo - kFrom) / kParts;
  std::array<double, kParts> parts{};
  double weights = 0.0;
  for (int i = 0; i < kParts; ++i) {
    const double n = std::exp(kFrom + (i + 0.5) * kStep);
    const double prior = n * n / (plausible * plausible);
    const double log_weight = std::log(n) - 0.5 * n * n;
    weights += std::exp(log_weight);
    parts[static_cast<std::size_t>(i)] =
        log_weight + 0.5 * (score * score / (information + prior) - std::log1p(information / prior));
  }
  const double largest = *std::ranges::max_element(parts);
  double sum = 0.0;
  for (const double part : parts) sum += std::exp(part - largest);
  return largest + std::log(sum / weights);
}

// Noncentral chi-square with one degree of freedom: sqrt of it is |N(delta, 1)|; the other tail adds nothing.
double minimal_detectable(double sd, double threshold) {
  constexpr double kPower = 0.8416;  // the normal quantile of 0.8
  return sd * (std::sqrt(threshold) + kPower);
}

}  // namespace coast::diagnose
