#include "bit_field.hpp"

#include <cmath>

namespace coast::io {

double BitCursor::number(std::size_t count, int exponent) {
  return std::ldexp(static_cast<double>(field_.bits(advance(count), count)), exponent);
}

double BitCursor::signed_number(std::size_t count, int exponent) {
  return std::ldexp(static_cast<double>(field_.signed_bits(advance(count), count)), exponent);
}

double BitCursor::magnitude_number(std::size_t count, int exponent) {
  return std::ldexp(static_cast<double>(field_.magnitude_bits(advance(count), count)), exponent);
}

}  // namespace coast::io
