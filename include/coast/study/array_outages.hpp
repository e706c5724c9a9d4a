#pragma once
// Benefit of merging several IMUs for a navigation filter: outages with known truth, the same missions for every merging
// method.

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "coast/array/synthetic.hpp"
#include "coast/simulate/scenario.hpp"
#include "coast/study/outage.hpp"

namespace coast::study {

/// Several IMUs at one position with common axes and clock, so that only merging is compared.
struct ArrayOutagePlan {
  simulate::Scenario scenario;  ///< its own error model and seed are not used
  noise::ImuErrorModel slow;    ///< drawn for every sensor: constants, Gauss-Markov processes
  /// Noise of a sample, rad/s and m/s^2, by sensor; drawn for each axis.
  std::vector<noise::ArmaGarch> gyro, accel;
  noise::ArmaGarchOrders orders{3, 2, 1, 1};  ///< of the models that are fitted
  std::uint64_t first_seed = 1;
  std::size_t seeds = 1;
};

/// One merging method, over the seeds.
struct ArrayOutageRun {
  std::string name;  ///< single 1, ..; mean; weighted; garch; corrected; extended
  std::vector<OutageResult> outages;
};

/// For every seed the errors of K sensors are drawn on one mission; each single sensor and every merge is processed as by
/// `coast process`, with the scenario's first outage withheld. The error model of a single sensor has its slow errors and the
/// density of its noise at frequency zero; that of a merge comes from the differences of the sensors
/// (`array::remaining_errors`), with noise over time if GARCH gives it; the extended mechanisation uses the single-sensor
/// models. Runs on all threads; the result is the same for any number of them.
/// @throws InputError  no outage in the scenario; fewer than two sensors, or different numbers of gyros and accelerometers
[[nodiscard]] std::vector<ArrayOutageRun> run_array_outages(const ArrayOutagePlan& plan,
                                                            const std::function<void(double)>& progress = {});

}  // namespace coast::study
