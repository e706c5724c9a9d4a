#include "campaign/statistics.hpp"

#include <cmath>

namespace coast::jobs {

void DriftSums::add(const study::OutageErrors& errors) {
  horizontal_.push_back(errors.horizontal_max_m);
  if (errors.gnss_horizontal_max_m) against_gnss_.push_back(*errors.gnss_horizontal_max_m);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    largest_[axis].push_back(errors.max_m(static_cast<Eigen::Index>(axis)));
    end_[axis].push_back(std::abs(errors.end_m(static_cast<Eigen::Index>(axis))));
  }
  sigma_end_squares_ += errors.sigma_end_m.cwiseAbs2();
  sigma_max_squares_ += errors.sigma_max_m.cwiseAbs2();
  inside_ += errors.inside_95;
  tested_ += errors.tested;
}

study::Drift DriftSums::drift() const {
  study::Drift drift;
  const auto n = static_cast<double>(outages());
  drift.horizontal = study::spread_of(horizontal_);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    drift.largest[axis] = study::spread_of(largest_[axis]);
    drift.end[axis] = study::spread_of(end_[axis]);
  }
  drift.predicted_end_rms_m = (sigma_end_squares_ / n).cwiseSqrt();
  drift.predicted_largest_rms_m = (sigma_max_squares_ / n).cwiseSqrt();
  drift.inside_95 = tested_ > 0 ? static_cast<double>(inside_) / static_cast<double>(tested_) : 0.0;
  if (!against_gnss_.empty()) drift.against_gnss = study::spread_of(against_gnss_);
  return drift;
}

void GroupStatistics::add(const UnitResult& result) {
  const auto number = [&result](const std::string& column) -> std::optional<double> {
    const auto found = result.row.find(column);
    if (found == result.row.end() || !found->is_number()) return std::nullopt;
    return found->get<double>();
  };
  ++done;
  if (const auto verdict = result.row.find("verdict"); verdict != result.row.end()) ++verdicts[verdict->get<std::string>()];
  const auto nis = number("nis_mean"), expected = number("nis_expected");
  if (nis && expected && *expected > 0.0) nis_ratio.push_back(*nis / *expected);
  for (const std::size_t solution : {0U, 1U}) {
    const std::string name = solution == 0 ? "forward_rms" : "smoothed_rms";
    const auto n = number(name + "_n_m"), e = number(name + "_e_m"), d = number(name + "_d_m");
    if (!n || !e || !d) continue;
    horizontal_rms[solution].push_back(std::hypot(*n, *e));
    down_rms[solution].push_back(*d);
  }
  for (const std::string& line : result.outages) {
    const std::optional<study::OutageResult> outage = outage_from_line(line);
    if (!outage) continue;
    DurationSums& sums = durations[outage->outage.duration_s];
    sums.forward.add(outage->forward);
    if (outage->smoothed && outage->smoothed->tested > 0) sums.smoothed.add(*outage->smoothed);
  }
}

}  // namespace coast::jobs
