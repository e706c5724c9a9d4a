#pragma once
// What merging several IMUs is worth to a navigation filter: outages with known truth, the same missions for every way of
// merging.

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "coast/array/synthetic.hpp"
#include "coast/simulate/scenario.hpp"
#include "coast/study/outage.hpp"

namespace coast::study {

/// Several IMUs at one place with one set of axes and one clock, so that what is compared is merging alone.
struct ArrayOutagePlan {
  simulate::Scenario scenario;  ///< its own error model and seed are not used
  noise::ImuErrorModel slow;    ///< drawn for every sensor: constants, Gauss-Markov processes
  /// Noise of a sample, rad/s and m/s^2, by sensor; drawn for each axis.
  std::vector<noise::ArmaGarch> gyro, accel;
  noise::ArmaGarchOrders orders{3, 2, 1, 1};  ///< of the models that are fitted
  std::uint64_t first_seed = 1;
  std::size_t seeds = 1;
};

/// One way, over the seeds.
struct ArrayOutageRun {
  std::string name;  ///< single 1, ..; mean; weighted; garch; corrected; extended
  std::vector<OutageResult> outages;
};

/// Every seed: K sensors' errors are drawn on one mission, each sensor by itself and every merge of them goes through `coast
/// process`'s way with the scenario's first outage withheld. A single sensor's filter knows its slow errors and the density at
/// frequency zero of its noise; a merge has what the differences of the sensors tell (`array::remaining_errors`), with noise
/// over time where GARCH gives it; the extended mechanisation knows of every sensor what its own filter knows. On all threads;
/// the same numbers for any number of them.
/// @throws InputError  no outage in the scenario; fewer than two sensors, or different numbers of gyros and accelerometers
[[nodiscard]] std::vector<ArrayOutageRun> run_array_outages(const ArrayOutagePlan& plan,
                                                            const std::function<void(double)>& progress = {});

}  // namespace coast::study
