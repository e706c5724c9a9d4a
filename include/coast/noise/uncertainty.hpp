#pragma once
// What a static record can know of the parameters: exact information and the Cramer-Rao bound, profile intervals, flat
// directions.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "coast/noise/estimators.hpp"

namespace coast::noise {

/// Expected Fisher information of u in a record without holes, level and drift of the model estimated beside it:
///
///     I_ij = sum_k  E[de_i de_j]/S + dS_i dS_j/(2 S^2),
///
/// e the innovations of the filter that carries level and drift as states of unlimited prior variance (so these are the
/// innovations of the restricted likelihood), E over records of the model itself, propagated in closed form. O(samples). A
/// record longer than 20 000 samples is taken as block means, and what samples tell within their blocks beside these: what is
/// lost is only what ties the insides of neighbouring blocks together.
/// @param samples  of the record, at `interval`
[[nodiscard]] Eigen::MatrixXd expected_information(const SumModel& model, const std::vector<double>& u, double interval,
                                                   std::uint64_t samples);
/// Summed over the records of a likelihood, as if they had no holes. Where a sum has a resonance that rings longer than a block
/// of a long record, by the lines of its spectrum instead (Whittle 1953), without the two lowest for level and drift.
[[nodiscard]] Eigen::MatrixXd record_information(const Likelihood& likelihood, const std::vector<double>& u);

/// Inverse of an information matrix; a parameter of which nothing is known has an infinite variance.
[[nodiscard]] Eigen::MatrixXd cramer_rao(const Eigen::MatrixXd& information);

/// Where the profile log-likelihood is 1.92 below its maximum (95 %, chi-square of one degree of freedom). Absent: it does not
/// fall that far within the range in which a record of this length can tell anything.
struct ProfileInterval {
  std::optional<double> lower;  ///< of u
  std::optional<double> upper;
};
/// Of every parameter. Of a record beyond 40 000 samples a parameter known to 5 % has the interval of its parabola; others are
/// followed on block means, or on the spectrum where block means hold less than half of what the record tells of them.
/// @param fit  the maximum
[[nodiscard]] std::vector<ProfileInterval> profile_intervals(const Likelihood& likelihood, const Fit& fit);

/// The same of level and drift, by the restricted likelihood with one of them held and the processes free to follow: where slow
/// processes are known badly, this is wider than what generalised least squares states at the estimate. Of a record beyond
/// 40 000 samples it is followed on block means.
/// @return [record][coefficient], in the units of MeanEstimate
[[nodiscard]] std::vector<std::vector<ProfileInterval>> mean_intervals(const Likelihood& likelihood, const Fit& fit);

/// P(LR > x) where the variance tested is zero on the boundary: half chi2(0), half chi2(1).
[[nodiscard]] double chi_bar_square_survival(double likelihood_ratio);

}  // namespace coast::noise
