// The score test of every hypothesis, and the distribution of the largest likelihood ratio of all by chance.

#include <algorithm>
#include <cmath>

#include "coast/diagnose/examination.hpp"
#include "coast/noise/chi_square.hpp"
#include "evidence/observable.hpp"

namespace coast::diagnose {

namespace {

/// Scores and information of hypotheses that last the mission, estimated jointly with the selected ones.
class Conditional {
 public:
  Conditional(const Examination& e, const std::vector<Eigen::Index>& selected) : e_(e), selected_(selected) {
    if (!selected.empty())
      of_selected_ = covariance_of(e.information(selected, selected)) * Eigen::MatrixXd(e.information(selected, Eigen::all));
  }
  [[nodiscard]] double information(Eigen::Index i) const {
    if (selected_.empty()) return e_.information(i, i);
    return e_.information(i, i) - Eigen::VectorXd(e_.information(selected_, i)).dot(of_selected_.col(i));
  }
  [[nodiscard]] double score(Eigen::Index i) const {
    if (selected_.empty()) return e_.score(i);
    return e_.score(i) - of_selected_.col(i).dot(Eigen::VectorXd(e_.score(selected_)));
  }
  [[nodiscard]] Eigen::VectorXd null_score(Eigen::Index i) const {
    if (selected_.empty()) return e_.null_score.row(i).transpose();
    return e_.null_score.row(i).transpose() -
           Eigen::MatrixXd(e_.null_score(selected_, Eigen::all)).transpose() * of_selected_.col(i);
  }

 private:
  const Examination& e_;
  const std::vector<Eigen::Index>& selected_;
  Eigen::MatrixXd of_selected_;  ///< I_aa^-1 I_a
};

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
  // All instants whose likelihood ratio is closer to the largest than that of a change point by chance: 95 % of
  // (1 - exp(-x/2))^2, the larger of two random walks downhill (Hansen 2000, Econometrica 68, eq. 9), not chi-square.
  constexpr double kDrop = 7.35;
  std::size_t first = 0;
  std::size_t last = track.t.size() - 1;
  while (first < best && ratio(first) <= ratio(best) - kDrop) ++first;
  while (last > best && ratio(last) <= ratio(best) - kDrop) --last;
  // The interval extends to the excluded neighbours: between two knots there is no information.
  const geo::GpsTime before = track.t[first > 0 ? first - 1 : 0];
  const geo::GpsTime behind = track.t[std::min(last + 1, track.t.size() - 1)];
  geo::GpsTime from = track.t[best];
  if (!h.effect->sensors && best > 0) {
    // For an effect on fixes only, every instant since the last fix is equivalent. The middle is used, so that a shift of tags
    // moves no fix across.
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

Suspicions suspicions(const Examination& examination, const Hypotheses& hypotheses, const std::vector<Eigen::Index>& selected) {
  constexpr double kSame = 1e-4;  // of the variance: correlation of 0.99995 with selected effects
  Suspicions result;
  const Conditional conditional(examination, selected);
  Eigen::VectorXd largest = Eigen::VectorXd::Zero(examination.null_score.cols());
  for (Eigen::Index i = 0; i < hypotheses.size(); ++i) {
    const Hypothesis& h = hypotheses[i];
    if (h.begins_at_some_time() || std::ranges::find(selected, i) != selected.end()) continue;
    const double information = conditional.information(i);
    if (!(information > kSame * examination.information(i, i))) continue;
    const double score = conditional.score(i);
    const bool seen = is_observable(h, information);
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

}  // namespace coast::diagnose
