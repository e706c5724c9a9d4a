#pragma once
// Arrays of numbers as text: 32 bit words, bytes of equal rank gathered, zlib, base64. The page's decode.ts is the counterpart.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace coast::report {

[[nodiscard]] std::string base64_encode(std::span<const std::uint8_t> bytes);
/// @throws std::invalid_argument a length that is no multiple of four, or a character outside the alphabet
[[nodiscard]] std::vector<std::uint8_t> base64_decode(std::string_view text);

/// Rounded to 32 bit floats: {"n", "z"}.
[[nodiscard]] nlohmann::json pack_floats(std::span<const double> values);
/// Increasing finite values as x0 + q k, q a power of ten finer than 3e-9 of the span: {"n", "x0", "q", "z"}, z with the
/// differences of k; values in any other order as floats.
[[nodiscard]] nlohmann::json pack_abscissae(std::span<const double> values);
/// For either form.  @throws std::invalid_argument the text does not decode to n words; nlohmann::json::exception a key is
/// missing
[[nodiscard]] std::vector<double> unpack(const nlohmann::json& packed);

}  // namespace coast::report
