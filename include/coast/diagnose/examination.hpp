#pragma once
// What one run of the filter says of every hypothesis, and how large the largest may be by chance.

#include <optional>
#include <vector>

#include "coast/diagnose/hypotheses.hpp"
#include "coast/diagnose/noise_effect.hpp"
#include "coast/study/solution.hpp"

namespace coast::diagnose {

/// Scores and information of the coefficients about zero, effect = coefficient times column:
/// log-likelihood ratio = score' c - c' information c / 2.
struct Examination {
  /// Hypotheses of which it is asked what they do from some instant on.
  struct Started {
    Eigen::Index hypothesis = 0;
    geo::GpsTime from;
    bool operator==(const Started&) const = default;
  };
  std::vector<Started> started;
  /// Of all hypotheses as effects of the whole mission (of those that begin at some time: from its start), and behind them of
  /// those that have `started`, in their order.
  Eigen::VectorXd score;
  Eigen::MatrixXd information;
  Eigen::MatrixXd null_score;  ///< by draws of the innovations from their own covariance, a column each

  /// Of those that begin at some time, at every instant at which they can be told.
  struct Track {
    Eigen::Index hypothesis = 0;
    std::vector<geo::GpsTime> t;  ///< ascending
    std::vector<double> score;
    std::vector<double> information;
    Eigen::VectorXd null_largest;  ///< likelihood ratio, the largest of each draw over all instants
  };
  std::vector<Track> tracks;
  Disturbances disturbances;

  /// Takes over what draws of another examination say, in place of own ones: they depend on covariances, and these hardly
  /// on what was taken out. @return  whether covariances, hypotheses and what has started are those of the other; else nothing
  /// was taken
  bool take_draws_of(const Examination& other);
};

struct ExaminationOptions {
  Eigen::Index draws = 400;
  Eigen::Index draws_of_disturbances = 200;  ///< of these, as many are kept interval by interval
  std::uint64_t seed = 1;
  std::function<bool(geo::GpsTime)> counts = {};  ///< innovations at other instants say nothing; empty: all count
  std::vector<Examination::Started> started = {};
};

/// @param knots  of a forward pass with the layout
[[nodiscard]] Examination examine(const estimate::Mission& mission, const estimate::StateLayout& layout,
                                  const estimate::KnotStore& knots, const Hypotheses& hypotheses,
                                  const ExaminationOptions& options, const std::function<void(double)>& progress = {});

/// One hypothesis as the data see it by itself, beside those that are taken for true already.
struct Suspicion {
  Eigen::Index hypothesis = 0;
  std::optional<geo::GpsTime> from;  ///< where it begins at some time
  double from_sd_s = 0.0;
  double estimate = 0.0;
  double sd = 0.0;
  double usual_sd = 0.0;          ///< where it begins at some time: at the median of the instants at which it might
  double likelihood_ratio = 0.0;  ///< twice the logarithm
  double log_bayes = 0.0;         ///< of the effect with its plausible size against none
  double p_value = 1.0;           ///< that the largest of all is as large by chance
  /// What its size and its onset cost of the gain in log-likelihood.
  [[nodiscard]] double price() const { return 0.5 * likelihood_ratio - log_bayes; }
};

/// The distribution of the largest likelihood ratio of all hypotheses and instants where nothing is missing: that of the
/// largest of `count` independent squares of standard normal numbers, the count fitted to the median of the draws.
struct LargestByChance {
  double count = 1.0;
  /// @param largest  likelihood ratio of each draw
  [[nodiscard]] static LargestByChance of(std::vector<double> largest);
  [[nodiscard]] double p_value(double likelihood_ratio) const;
  /// Likelihood ratio that is exceeded with this probability.
  [[nodiscard]] double quantile(double probability) const;
};

struct Suspicions {
  std::vector<Suspicion> all;  ///< by hypothesis; what cannot be seen at all is left out
  /// Of which the mission shows nothing that is plausible: they are not looked for while one that is plausible explains it, but
  /// what is found may look like them.
  std::vector<Suspicion> implausible;
  LargestByChance chance;
  /// Of either; null where the mission cannot tell it from what is taken.
  [[nodiscard]] const Suspicion* of(Eigen::Index hypothesis) const;
  /// By what chance does as it is known already, where there were no draws.
  void judge(const LargestByChance& by_chance);
};
/// @param taken  rows of the examination that are estimated beside each one that lasts the mission
[[nodiscard]] Suspicions suspicions(const Examination& examination, const Hypotheses& hypotheses,
                                    const std::vector<Eigen::Index>& taken);

/// Inverse of an information matrix. What cannot be told apart shares what is found, evenly in standard deviations.
[[nodiscard]] Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& information);

/// Logarithm of the ratio of the likelihoods of a coefficient c ~ Cauchy(0, plausible) and of c = 0 (Jeffreys, Theory of
/// Probability, 3rd ed., section 5.2). Under a normal prior an effect of thirty times what is plausible would never be
/// believed, however much it explains.
[[nodiscard]] double log_bayes_factor(double score, double information, double plausible);

/// Smallest coefficient that is found with probability 0.8 where a likelihood ratio of `threshold` is asked for (Baarda's
/// minimal detectable bias). @param sd  of its estimate
[[nodiscard]] double minimal_detectable(double sd, double threshold);

}  // namespace coast::diagnose
