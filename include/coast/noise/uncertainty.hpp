#pragma once
// Accuracy of parameters from a static record: exact information and the Cramer-Rao bound, profile intervals, flat directions.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "coast/noise/estimators.hpp"

namespace coast::noise {

/// Expected Fisher information of u in a record without holes, with level and drift of the model estimated too:
///
///     I_ij = sum_k  E[de_i de_j]/S + dS_i dS_j/(2 S^2),
///
/// e the innovations of the filter that carries level and drift as states of unlimited prior variance (so these are the
/// innovations of the restricted likelihood), E over records of the model itself, propagated in closed form. O(samples). A
/// record longer than 20 000 samples is replaced by block means, plus the information of the samples within each block; only
/// the information in correlations between samples of neighbouring blocks is lost.
/// @param samples  number of samples in the record, at `interval`
[[nodiscard]] Eigen::MatrixXd expected_information(const SumModel& model, const std::vector<double>& u, double interval,
                                                   std::uint64_t samples);
/// Sum over the records of a likelihood, computed as if they had no holes. For a long record and a sum of more than six states,
/// or with a resonance that rings longer than a block, it is computed from the lines of the spectrum instead (Whittle 1953),
/// without the two lowest, which level and drift use.
[[nodiscard]] Eigen::MatrixXd record_information(const Likelihood& likelihood, const std::vector<double>& u);

/// Inverse of an information matrix; a parameter without information has infinite variance.
[[nodiscard]] Eigen::MatrixXd cramer_rao(const Eigen::MatrixXd& information);

/// Where the profile log-likelihood is 1.92 below its maximum (95 %, chi-square of one degree of freedom). Absent: it does not
/// fall that far within the range in which a record of this length is informative.
struct ProfileInterval {
  std::optional<double> lower;  ///< of u
  std::optional<double> upper;
};
/// Interval of every parameter. For a record beyond 40 000 samples, a parameter known to 5 % has the interval of the quadratic
/// approximation; the profile of others is computed on block means, or on the spectrum if block means contain less than half of
/// the information on them.
/// @param fit  the maximum
[[nodiscard]] std::vector<ProfileInterval> profile_intervals(const Likelihood& likelihood, const Fit& fit);

/// The same for level and drift, by the restricted likelihood with one of them held fixed and the processes free: if slow
/// processes are poorly determined, this is wider than the interval of generalised least squares at the estimate. For a record
/// beyond 40 000 samples it is computed on block means.
/// @return [record][coefficient], in the units of MeanEstimate
[[nodiscard]] std::vector<std::vector<ProfileInterval>> mean_intervals(const Likelihood& likelihood, const Fit& fit);

/// P(LR > x) if the tested variance is zero, on its boundary: half chi2(0), half chi2(1).
[[nodiscard]] double chi_bar_square_survival(double likelihood_ratio);

}  // namespace coast::noise
