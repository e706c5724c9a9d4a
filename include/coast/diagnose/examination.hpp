#pragma once
// Score tests of all hypotheses from one filter run, and the distribution of the largest one by chance.

#include <optional>
#include <vector>

#include "coast/diagnose/hypotheses.hpp"
#include "coast/diagnose/noise_effect.hpp"
#include "coast/study/solution.hpp"

namespace coast::diagnose {

/// Scores and information of the coefficients about zero, effect = coefficient times column:
/// log-likelihood ratio = score' c - c' information c / 2.
struct Examination {
  /// A hypothesis with a given start time.
  struct Started {
    Eigen::Index hypothesis = 0;
    geo::GpsTime from;
    bool operator==(const Started&) const = default;
  };
  std::vector<Started> started;
  /// For all hypotheses as effects of the whole mission (those that begin at some time: from its start), followed by those in
  /// `started`, in order.
  Eigen::VectorXd score;
  Eigen::MatrixXd information;
  Eigen::MatrixXd null_score;  ///< for draws of the innovations from their own covariance, one column per draw

  /// For a hypothesis that begins at some time: results at every instant at which it is observable.
  struct Track {
    Eigen::Index hypothesis = 0;
    std::vector<geo::GpsTime> t;  ///< ascending
    std::vector<double> score;
    std::vector<double> information;
    Eigen::VectorXd null_largest;  ///< largest likelihood ratio over all instants, for each draw
  };
  std::vector<Track> tracks;
  Disturbances disturbances;

  /// Copies the draws of another examination: they depend on covariances, which hardly depend on the corrected effects. @return
  ///  true if covariances, hypotheses and `started` equal those of the other; otherwise nothing is copied
  bool take_draws_of(const Examination& other);
};

struct ExaminationOptions {
  Eigen::Index draws = 400;
  Eigen::Index draws_of_disturbances = 200;  ///< number of draws that are stored interval by interval
  std::uint64_t seed = 1;
  std::vector<Examination::Started> started = {};
};

/// @param knots  of a forward pass with the layout
[[nodiscard]] Examination examine(const estimate::Mission& mission, const estimate::StateLayout& layout,
                                  const estimate::KnotStore& knots, const Hypotheses& hypotheses,
                                  const ExaminationOptions& options, const std::function<void(double)>& progress = {});

/// The score test of one hypothesis, with the selected effects estimated too.
struct Suspicion {
  Eigen::Index hypothesis = 0;
  std::optional<geo::GpsTime> from;  ///< where it begins at some time
  double from_sd_s = 0.0;
  double estimate = 0.0;
  double sd = 0.0;
  double usual_sd = 0.0;          ///< if it begins at some time: median over the possible instants
  double likelihood_ratio = 0.0;  ///< twice the logarithm
  double log_bayes = 0.0;         ///< log Bayes factor of the effect with its plausible size against none
  double p_value = 1.0;           ///< probability that the largest of all is as large by chance
  /// Penalty on the gain in log-likelihood for its size and onset.
  [[nodiscard]] double price() const { return 0.5 * likelihood_ratio - log_bayes; }
};

/// The distribution of the largest likelihood ratio over all hypotheses and instants if no effect is missing: that of the
/// largest of `count` independent squares of standard normal numbers, with the count fitted to the median of the draws.
struct LargestByChance {
  double count = 1.0;
  /// @param largest  likelihood ratio of each draw
  [[nodiscard]] static LargestByChance of(std::vector<double> largest);
  [[nodiscard]] double p_value(double likelihood_ratio) const;
  /// Likelihood ratio that is exceeded with this probability.
  [[nodiscard]] double quantile(double probability) const;
};

struct Suspicions {
  std::vector<Suspicion> all;  ///< by hypothesis; unobservable ones are left out
  /// Hypotheses whose estimate is not plausible: not selected while a plausible one explains the data, but listed as possible
  /// alternatives.
  std::vector<Suspicion> implausible;
  LargestByChance chance;
  /// From either list; null if it cannot be separated from the selected effects in this mission.
  [[nodiscard]] const Suspicion* of(Eigen::Index hypothesis) const;
  /// Computes p-values with a given distribution, if there were no draws.
  void judge(const LargestByChance& by_chance);
};
/// @param selected  rows of the selected effects, estimated together with each hypothesis of the whole mission
[[nodiscard]] Suspicions suspicions(const Examination& examination, const Hypotheses& hypotheses,
                                    const std::vector<Eigen::Index>& selected);

/// Inverse of an information matrix. Coefficients that cannot be separated share the estimate, evenly in standard deviations.
[[nodiscard]] Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& information);

/// Logarithm of the ratio of the likelihoods of a coefficient c ~ Cauchy(0, plausible) and of c = 0 (Jeffreys, Theory of
/// Probability, 3rd ed., section 5.2). With a normal prior an effect of thirty times the plausible size would never be
/// accepted, however much it explains.
[[nodiscard]] double log_bayes_factor(double score, double information, double plausible);

/// Smallest coefficient that is detected with probability 0.8 if a likelihood ratio of `threshold` is required (Baarda's
/// minimal detectable bias). @param sd  of its estimate
[[nodiscard]] double minimal_detectable(double sd, double threshold);

}  // namespace coast::diagnose
