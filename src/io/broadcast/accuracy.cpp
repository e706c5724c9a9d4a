#include "accuracy.hpp"

#include <cmath>

namespace coast::io {

double ura_metres(int index) {
  constexpr int kTurn = 6;
  // The values that the standard rounds: 2.8, 5.7, 11.3.
  if (index <= kTurn) return std::round(10.0 * std::exp2(1.0 + 0.5 * index)) / 10.0;
  return std::exp2(index - 2.0);
}

double sisa_metres(int index) {
  if (index < 50) return 0.01 * index;
  if (index < 75) return 0.5 + 0.02 * (index - 50);
  if (index < 100) return 1.0 + 0.04 * (index - 75);
  return index <= 125 ? 2.0 + 0.16 * (index - 100) : 0.0;
}

}  // namespace coast::io
