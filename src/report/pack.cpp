#include "pack.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>

namespace coast::report {
namespace {

constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr int kCompressionLevel = 4;                  // level 9 saves 3 % and takes five times as long
constexpr std::size_t kMostWords = 64 * 1024 * 1024;  // do not allocate more because of a damaged file

std::array<int, 256> make_inverse_alphabet() {
  std::array<int, 256> inverse;
  inverse.fill(-1);
  for (std::size_t i = 0; i < kAlphabet.size(); ++i) inverse[static_cast<unsigned char>(kAlphabet[i])] = static_cast<int>(i);
  return inverse;
}

// Byte 0 of all words, then byte 1 of all words, ...: sign, exponent and high bits change slowly and compress well.
std::string deflate_words(const std::vector<std::uint32_t>& words) {
  std::vector<std::uint8_t> bytes(words.size() * 4);
  for (std::size_t rank = 0; rank < 4; ++rank) {
    for (std::size_t i = 0; i < words.size(); ++i) {
      bytes[rank * words.size() + i] = static_cast<std::uint8_t>(words[i] >> (8 * rank));
    }
  }
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::vector<std::uint8_t> packed(size);
  if (compress2(packed.data(), &size, bytes.data(), static_cast<uLong>(bytes.size()), kCompressionLevel) != Z_OK) {
    throw std::bad_alloc();  // the only possible failure with compressBound of memory
  }
  packed.resize(size);
  return base64_encode(packed);
}

std::vector<std::uint32_t> inflate_words(const std::string& text, std::size_t count) {
  if (count > kMostWords) throw std::invalid_argument(fmt::format("an array of {} numbers", count));
  const std::vector<std::uint8_t> packed = base64_decode(text);
  std::vector<std::uint8_t> bytes(std::max<std::size_t>(count * 4, 1));
  uLongf size = static_cast<uLongf>(bytes.size());
  const int status = uncompress(bytes.data(), &size, packed.data(), static_cast<uLong>(packed.size()));
  if (status != Z_OK || size != count * 4) throw std::invalid_argument(fmt::format("does not decode to {} numbers", count));
  std::vector<std::uint32_t> words(count, 0);
  for (std::size_t rank = 0; rank < 4; ++rank) {
    for (std::size_t i = 0; i < count; ++i) words[i] |= std::uint32_t{bytes[rank * count + i]} << (8 * rank);
  }
  return words;
}

bool is_increasing_and_finite(std::span<const double> values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i]) || (i > 0 && values[i] < values[i - 1])) return false;
  }
  return true;
}

}  // namespace

std::string base64_encode(std::span<const std::uint8_t> bytes) {
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t available = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < available ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) out += k <= available ? kAlphabet[group >> (18 - 6 * k) & 63U] : '=';
  }
  return out;
}

std::vector<std::uint8_t> base64_decode(std::string_view text) {
  static const std::array<int, 256> inverse = make_inverse_alphabet();
  if (text.size() % 4 != 0) throw std::invalid_argument(fmt::format("base64 of {} characters", text.size()));
  std::size_t padding = 0;
  while (padding < 2 && padding < text.size() && text[text.size() - 1 - padding] == '=') ++padding;
  std::vector<std::uint8_t> out;
  out.reserve(text.size() / 4 * 3);
  for (std::size_t i = 0; i < text.size(); i += 4) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const bool is_padding = i + k >= text.size() - padding;
      const int digit = is_padding ? 0 : inverse[static_cast<unsigned char>(text[i + k])];
      if (digit < 0) throw std::invalid_argument(fmt::format("base64 with the character '{}'", text[i + k]));
      group = group << 6 | static_cast<std::uint32_t>(digit);
    }
    for (int shift = 16; shift >= 0; shift -= 8) out.push_back(static_cast<std::uint8_t>(group >> shift));
  }
  out.resize(out.size() - padding);
  return out;
}

nlohmann::json pack_floats(std::span<const double> values) {
  std::vector<std::uint32_t> words(values.size());
  std::transform(values.begin(), values.end(), words.begin(),
                 [](double value) { return std::bit_cast<std::uint32_t>(static_cast<float>(value)); });
  return {{"n", values.size()}, {"z", deflate_words(words)}};
}

nlohmann::json pack_abscissae(std::span<const double> values) {
  if (values.empty() || !is_increasing_and_finite(values)) return pack_floats(values);
  const double span = values.back() - values.front();
  const double quantum = span > 0.0 ? std::pow(10.0, std::ceil(std::log10(span / 4e9))) : 1.0;
  if (!std::isfinite(span) || !(quantum > 0.0)) return pack_floats(values);
  std::vector<std::uint32_t> steps(values.size());
  std::uint32_t previous = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto count = static_cast<std::uint32_t>(std::llround((values[i] - values.front()) / quantum));
    steps[i] = count - previous;
    previous = count;
  }
  return {{"n", values.size()}, {"x0", values.front()}, {"q", quantum}, {"z", deflate_words(steps)}};
}

std::vector<double> unpack(const nlohmann::json& packed) {
  const std::vector<std::uint32_t> words = inflate_words(packed.at("z").get<std::string>(), packed.at("n").get<std::size_t>());
  std::vector<double> values(words.size());
  if (!packed.contains("q")) {
    std::transform(words.begin(), words.end(), values.begin(),
                   [](std::uint32_t word) { return static_cast<double>(std::bit_cast<float>(word)); });
    return values;
  }
  const double x0 = packed.at("x0").get<double>();
  const double quantum = packed.at("q").get<double>();
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < words.size(); ++i) {
    count += words[i];
    values[i] = x0 + quantum * count;
  }
  return values;
}

}  // namespace coast::report
