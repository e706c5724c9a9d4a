#include <numeric>

#include "calibration_checks.hpp"

namespace coast::noise {

RecordTest test_on(const StaticSignal& record, const SumModel& model, const std::vector<double>& u,
                   const CalibrationOptions& options) {
  check_record(record);
  const Likelihood likelihood({record}, model);
  const LikelihoodValue value = likelihood.value(u);
  const std::vector<double> innovations = likelihood.standardised_innovations(u, 0);
  const auto n = static_cast<double>(innovations.size());
  RecordTest test;
  test.log_likelihood_per_sample = value.log_likelihood / n;
  test.innovation_variance = std::inner_product(innovations.begin(), innovations.end(), innovations.begin(), 0.0) / n;
  test.whiteness = whiteness_of(innovations, 0);
  test.curve = allan_curve(record);
  const Eigen::VectorXd& mean = value.means.front().value;
  test.band = band_of(test.curve, model, u, record, mean.size() > 1 ? mean(1) : 0.0, options);
  return test;
}

}  // namespace coast::noise
