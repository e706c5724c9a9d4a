#include "arma_garch_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace coast::noise {

void check_arma_garch(const ArmaGarchOrders& orders) {
  if (orders.ar < 0 || orders.ma < 0 || orders.arch < 0 || orders.garch < 0 || (orders.garch > 0 && orders.arch == 0))
    throw std::invalid_argument(fmt::format("ARMA({},{})-GARCH({},{}): orders from 0, and no garch without arch", orders.ar,
                                            orders.ma, orders.arch, orders.garch));
}

void check_arma_garch(const ArmaGarch& model) {
  const std::string defect = model.defect();
  if (!defect.empty()) throw std::invalid_argument(fmt::format("ARMA-GARCH model: {}", defect));
}

void check_arma_garch(const ArmaGarchSeries& series, const ArmaGarchOrders& orders) {
  if (!series.is_missing.empty() && series.is_missing.size() != series.y.size())
    throw std::invalid_argument(
        fmt::format("ARMA-GARCH series: is_missing of {} samples, y of {}", series.is_missing.size(), series.y.size()));
  std::size_t counted = 0;
  int unsettled = 0;
  for (std::size_t t = 0; t < series.y.size(); ++t) {
    if (!series.is_missing.empty() && series.is_missing[t] != 0) {
      unsettled = kArmaGarchSettling;
      continue;
    }
    if (!std::isfinite(series.y[t])) throw std::invalid_argument(fmt::format("ARMA-GARCH series: y[{}] is not finite", t));
    if (unsettled > 0)
      --unsettled;
    else
      ++counted;
  }
  const int parameters = 2 + orders.ar + orders.ma + orders.arch + orders.garch;
  const std::size_t least = 20 + 5 * static_cast<std::size_t>(parameters);
  if (counted < least)
    throw std::invalid_argument(fmt::format("ARMA-GARCH series: {} samples that count, {} expected", counted, least));
}

}  // namespace coast::noise
