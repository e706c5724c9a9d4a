#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "calibrate/result.hpp"
#include "calibrate/units.hpp"

namespace coast::jobs {

namespace {

std::string interval_text(const SheetValue& v) {
  if (!v.lower && !v.upper) return "not bounded";
  if (!v.lower) return fmt::format("below {:.3g}", *v.upper);
  if (!v.upper) return fmt::format("above {:.3g}", *v.lower);
  return fmt::format("{:.3g} to {:.3g}", *v.lower, *v.upper);
}

}  // namespace

std::string calibration_text(const CalibrationResult& result) {
  std::string text;
  for (const CalibratedAxis& axis : result.axes) {
    const noise::AxisCalibration& r = axis.result;
    const noise::Candidate& best = r.best();
    text += fmt::format("{}: {}, log-likelihood {:.1f}, {:.1f} s\n", axis.axis.title(), best.model.name(),
                        best.fit.log_likelihood, r.seconds);
    for (std::size_t i = 0; i < r.parameters.size(); ++i) {
      const SheetValue v = sheet_value(best.model, i, axis.axis.sensor, r.parameters[i]);
      text += fmt::format("  {:<24} {:>10.4g} {:<14} 95 %: {}\n", v.name, v.value, v.unit, interval_text(v));
    }
    if (const auto& b = r.reading.bias_instability)
      text += fmt::format("  {:<24} {:>10.4g} {:<14} at {:.0f} s\n", "bias instability",
                          in_unit(b->value, sheet_units(axis.axis.sensor).signal), sheet_units(axis.axis.sensor).signal,
                          b->tau_from);
    if (!r.band.tau.empty())
      text += fmt::format("  Allan curve {} the 95 % band of the estimate\n", r.band.inside ? "inside" : "OUTSIDE");
    if (!r.outliers.empty())
      text += fmt::format("  {} outlier{}, {} left out\n", r.outliers.size(), r.outliers.size() == 1 ? "" : "s",
                          std::ranges::count_if(r.outliers, &noise::Outlier::excluded));
    if (r.common_parameters_p)
      text += fmt::format("  one set of parameters for all records: p = {:.2g}\n", *r.common_parameters_p);
    for (const TestedRecord& tested : axis.tests)
      text += fmt::format("  on {}: variance of innovations {:.3f}{}\n",
                          std::filesystem::path(tested.source).filename().string(), tested.test.innovation_variance,
                          tested.test.band.tau.empty() ? ""
                          : tested.test.band.inside    ? ", Allan curve inside the band"
                                                       : ", Allan curve OUTSIDE the band");
    for (const std::string& remark : r.remarks) text += fmt::format("  {}\n", remark);
  }
  return text;
}

}  // namespace coast::jobs
