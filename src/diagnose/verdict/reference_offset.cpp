#include "verdict/reference_offset.hpp"

#include <algorithm>
#include <cmath>

#include "coast/noise/chi_square.hpp"
#include "coast/study/comparison.hpp"

namespace coast::diagnose {

namespace {

constexpr double kMinute = 60.0;           // s: longer than the correlation of a smoothed trajectory's errors
constexpr std::size_t kFewestMinutes = 5;  // minutes
constexpr double kFalseAlarm = 0.01;

/// The square of a normal value with the same probability as Student's t (Wallace 1959, Ann. Math. Stat. 30, to 0.02 of its
/// root from five degrees of freedom on).
double as_of_normal(double t, double dof) {
  const double root = (8.0 * dof + 1.0) / (8.0 * dof + 3.0) * std::sqrt(dof * std::log1p(t * t / dof));
  return root * root;
}

std::vector<Eigen::Vector3d> means_of_minutes(const Reference& reference, const std::vector<record::NavState>& path) {
  std::vector<Eigen::Vector3d> means;
  std::optional<geo::GpsTime> begin;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0.0;
  study::Comparison comparison(*reference.trajectory, reference.lever_arm_b, [&](const study::ErrorSample& error) {
    if (begin && error.t - *begin >= kMinute) {
      means.emplace_back(sum / count);
      begin.reset();
      sum.setZero();
      count = 0.0;
    }
    if (!begin) begin = error.t;
    sum += error.position_n;
    count += 1.0;
  });
  for (const record::NavState& nav : path) comparison.add({nav, {}});
  return means;
}

}  // namespace

std::optional<ReferenceOffset> offset_from(const Reference& reference, const std::vector<record::NavState>& path) {
  const std::vector<Eigen::Vector3d> means = means_of_minutes(reference, path);
  if (means.size() < kFewestMinutes) return std::nullopt;
  const auto n = static_cast<double>(means.size());
  ReferenceOffset offset;
  for (const Eigen::Vector3d& mean : means) offset.value += mean / n;
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& mean : means) squares += (mean - offset.value).cwiseAbs2();
  offset.sd = (squares / (n * (n - 1.0))).cwiseSqrt();
  for (int i = 0; i < 3; ++i) {
    if (!(offset.sd(i) > 0.0)) continue;
    offset.ratio(i) = as_of_normal(offset.value(i) / offset.sd(i), n - 1.0);
    offset.p_value(i) = std::min(1.0, 3.0 * noise::chi2_survival(1.0, offset.ratio(i)));
  }
  return offset;
}

void tell_offset(const ReferenceOffset& offset, Diagnosis& diagnosis) {
  const auto effect = std::ranges::find_if(catalogue(), &Effect::needs_reference);
  std::erase_if(diagnosis.not_observable, [&](const NotObservable& one) { return one.hypothesis.effect == &*effect; });
  const double threshold = noise::chi2_upper_quantile(1.0, kFalseAlarm / 3.0);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Hypothesis hypothesis{&*effect, axis, effect->plausible.front()};
    if (offset.p_value(axis) < kFalseAlarm)
      diagnosis.findings.push_back({.hypothesis = hypothesis,
                                    .from = {},
                                    .to = {},
                                    .value = offset.value(axis),
                                    .sd = offset.sd(axis),
                                    .delta_log_likelihood = 0.5 * offset.ratio(axis),
                                    .p_value = offset.p_value(axis),
                                    .held_out_gain = {},
                                    .alternatives = {},
                                    .stability = {}});
    else
      diagnosis.detectable_not_found.push_back({hypothesis, minimal_detectable(offset.sd(axis), threshold)});
  }
}

}  // namespace coast::diagnose
