#include "text_buffer.hpp"

#include <array>

namespace coast::io {

namespace {

constexpr std::array<double, 16> kPowers = {1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                            1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
constexpr std::size_t kDigits = 40;

}  // namespace

void TextBuffer::put_fixed(double value, int decimals, int width) {
  std::array<char, kDigits> digits;
  char* p = digits.data() + kDigits;
  const double scaled = std::abs(value) * kPowers[static_cast<std::size_t>(decimals)];
  if (!(scaled < 9e18)) {
    put("nan");
    return;
  }
  auto n = static_cast<std::uint64_t>(scaled);
  if (scaled - static_cast<double>(n) >= 0.5) ++n;
  const bool negative = value < 0.0 && n != 0;  // no "-0.000"
  for (int i = 0; i < decimals; ++i, n /= 10) *--p = static_cast<char>('0' + n % 10);
  if (decimals > 0) *--p = '.';
  do {
    *--p = static_cast<char>('0' + n % 10);
    n /= 10;
  } while (n != 0);
  if (negative) *--p = '-';
  const auto length = digits.data() + kDigits - p;
  if (length < width) text_.append(static_cast<std::size_t>(width - length), ' ');
  text_.append(p, static_cast<std::size_t>(length));
}

void TextBuffer::put_integer(std::int64_t value, int width, char fill) {
  std::array<char, kDigits> digits;
  char* p = digits.data() + kDigits;
  auto n = value < 0 ? ~static_cast<std::uint64_t>(value) + 1 : static_cast<std::uint64_t>(value);
  do {
    *--p = static_cast<char>('0' + n % 10);
    n /= 10;
  } while (n != 0);
  if (value < 0) *--p = '-';
  const auto length = digits.data() + kDigits - p;
  if (length < width) text_.append(static_cast<std::size_t>(width - length), fill);
  text_.append(p, static_cast<std::size_t>(length));
}

}  // namespace coast::io
