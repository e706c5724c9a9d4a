#pragma once
// Start values for the search for an ARMA-GARCH maximum. Private to the room.

#include <vector>

#include "arma_garch_coordinates.hpp"

namespace coast::noise {

/// Starts u for a series of mean 0 and deviation 1: by Hannan & Rissanen (1982), by Yule & Walker without moving average, and a
/// slow autoregression plus white noise, as is common for inertial sensors; each with the best of three GARCH guesses.
[[nodiscard]] std::vector<Eigen::VectorXd> arma_garch_starts(const ArmaGarchSeries& series, const ArmaGarchOrders& orders,
                                                             ArmaGarchRecursion& recursion,
                                                             const ArmaGarchCoordinates& coordinates);

}  // namespace coast::noise
