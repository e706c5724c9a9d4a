
#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "coast/noise/arma_garch.hpp"
#include "coast/parallel.hpp"

namespace coast::noise {

std::vector<ArmaGarchOrders> arma_garch_grid() {
  constexpr std::array<std::pair<int, int>, 4> kVariances{{{0, 0}, {1, 0}, {1, 1}, {2, 1}}};
  std::vector<ArmaGarchOrders> all;
  for (int ar = 0; ar <= 3; ++ar)
    for (int ma = 0; ma <= 2; ++ma)
      for (const auto& [arch, garch] : kVariances) all.push_back({ar, ma, arch, garch});
  return all;
}

ArmaGarchChoice choose_arma_garch(const ArmaGarchSeries& series, const std::vector<ArmaGarchOrders>& orders,
                                  const ArmaGarchOptions& options) {
  if (orders.empty()) throw std::invalid_argument("choose_arma_garch: no orders");
  ArmaGarchChoice choice;
  choice.fits.resize(orders.size());
  coast::parallel_for(std::size_t{0}, orders.size(),
                      [&](std::size_t i) { choice.fits[i] = fit_arma_garch(series, orders[i], options); });
  const auto least = [&](auto criterion) {
    return static_cast<std::size_t>(std::ranges::min_element(choice.fits, {}, criterion) - choice.fits.begin());
  };
  choice.by_aic = least(&ArmaGarchFit::aic);
  choice.by_aicc = least(&ArmaGarchFit::aicc);
  return choice;
}

}  // namespace coast::noise
