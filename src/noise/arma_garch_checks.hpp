#pragma once
// Checks of the arguments of the ARMA-GARCH functions. Private to the room.

#include "coast/noise/arma_garch.hpp"

namespace coast::noise {

/// @throws std::invalid_argument  with the defect
void check_arma_garch(const ArmaGarchOrders& orders);
void check_arma_garch(const ArmaGarch& model);
void check_arma_garch(const ArmaGarchSeries& series, const ArmaGarchOrders& orders);

}  // namespace coast::noise
