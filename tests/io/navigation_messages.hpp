#pragma once
// Navigation messages bit by bit as satellites send them, in the words in which u-blox passes them on.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "io/receiver_messages.hpp"

namespace coast::test {

/// The value of a field: n 2^exponent, and the same in semicircles.
inline double scaled(double n, int exponent) {
  return std::ldexp(n, exponent);
}
inline double angle(double n, int exponent) {
  return std::acos(-1.0) * scaled(n, exponent);
}

/// Bits one after another.
class BitString {
 public:
  /// The lowest bits of a number; beyond its 64 those of its sign.
  BitString& put(std::int64_t value, int count) {
    for (int bit = count - 1; bit >= 0; --bit) bits_.push_back((value >> std::min(bit, 63) & 1) != 0);
    return *this;
  }
  /// Sign and magnitude.
  BitString& put_signed(std::int64_t value, int count) {
    return put(value < 0 ? 1 : 0, 1).put(value < 0 ? -value : value, count - 1);
  }
  BitString& put(const BitString& more) {
    bits_.insert(bits_.end(), more.bits_.begin(), more.bits_.end());
    return *this;
  }
  [[nodiscard]] std::size_t size() const { return bits_.size(); }
  [[nodiscard]] bool at(std::size_t i) const { return bits_.at(i); }
  [[nodiscard]] std::uint32_t number(std::size_t at, std::size_t count) const {
    std::uint32_t value = 0;
    for (std::size_t i = at; i < at + count; ++i) value = value << 1 | (i < bits_.size() && bits_[i] ? 1U : 0U);
    return value;
  }
  [[nodiscard]] BitString part(std::size_t at, std::size_t count) const {
    BitString part;
    for (std::size_t i = at; i < at + count; ++i) part.bits_.push_back(bits_.at(i));
    return part;
  }
  [[nodiscard]] std::vector<std::uint32_t> words() const {
    std::vector<std::uint32_t> words;
    for (std::size_t at = 0; at < size(); at += 32) words.push_back(number(at, 32));
    return words;
  }

 private:
  std::vector<bool> bits_;
};

/// How a receiver gives the words of LNAV.
enum class LnavForm { kWordInverted, kDataInverted };

/// 240 bits of data to ten words with parity, by the equations of IS-GPS-200 table 20-XIV.
inline std::vector<std::uint32_t> lnav_words(const BitString& data, LnavForm form = LnavForm::kWordInverted) {
  static const std::array<std::vector<int>, 6> sums = {{{1, 2, 3, 5, 6, 10, 11, 12, 13, 14, 17, 18, 20, 23},
                                                        {2, 3, 4, 6, 7, 11, 12, 13, 14, 15, 18, 19, 21, 24},
                                                        {1, 3, 4, 5, 7, 8, 12, 13, 14, 15, 16, 19, 20, 22},
                                                        {2, 4, 5, 6, 8, 9, 13, 14, 15, 16, 17, 20, 21, 23},
                                                        {1, 3, 5, 6, 7, 9, 10, 14, 15, 16, 17, 18, 21, 22, 24},
                                                        {3, 5, 6, 8, 9, 10, 11, 13, 15, 19, 22, 23, 24}}};
  static const std::array<int, 6> before = {29, 30, 29, 30, 30, 29};
  std::vector<std::uint32_t> words;
  bool d29 = false, d30 = false;
  for (std::size_t word = 0; word < 10; ++word) {
    const BitString source = data.part(24 * word, 24);
    std::uint32_t parity = 0;
    for (std::size_t row = 0; row < 6; ++row) {
      bool bit = before[row] == 29 ? d29 : d30;
      for (const int d : sums[row]) bit = bit != source.at(static_cast<std::size_t>(d - 1));
      parity = parity << 1 | (bit ? 1U : 0U);
    }
    const bool whole = form == LnavForm::kWordInverted && d30;
    words.push_back(source.number(0, 24) << 6 | (whole ? parity ^ 0x3fU : parity));
    d29 = (parity & 2U) != 0;
    d30 = (parity & 1U) != 0;
  }
  return words;
}

/// Hands over two bits of words 2 and 10 so that their parity ends with zeros, as the standard has it.
inline std::vector<std::uint32_t> lnav_subframe(int number, const BitString& words3to10, LnavForm form, unsigned tow = 6000) {
  for (unsigned spare = 0; spare < 16; ++spare) {
    BitString data;
    data.put(0x8b, 8).put(0, 16).put(tow, 17).put(0, 2).put(number, 3).put(spare >> 2, 2);
    data.put(words3to10.part(0, words3to10.size() - 2)).put(spare & 3U, 2);
    const auto words = lnav_words(data, LnavForm::kDataInverted);
    if ((words[1] & 3U) == 0 && (words[9] & 3U) == 0) return lnav_words(data, form);
  }
  return {};
}

/// Even and odd part of an I/NAV page around a word of 128 bits, in eight words.
inline std::vector<std::uint32_t> inav_page(const BitString& word, bool alert = false) {
  BitString even, odd, checked;
  even.put(0, 1).put(alert ? 1 : 0, 1).put(word.part(0, 112));
  odd.put(1, 1).put(alert ? 1 : 0, 1).put(word.part(112, 16)).put(0, 64);
  checked.put(0, 4).put(even).put(odd);
  std::string bytes;
  for (std::size_t at = 0; at < checked.size(); at += 8) bytes += static_cast<char>(checked.number(at, 8));
  odd.put(crc_bit_by_bit(bytes, 0x864CFB, 24), 24).put(0, 14);
  even.put(0, 14);
  return BitString().put(even).put(odd).put(0, 8).words();
}

/// 77 bits of a GLONASS string, from bit 85 down to bit 9, with their checks by the sums that the ICD lists (table 4.13), in
/// four words, the last the number of the frame.
inline std::vector<std::uint32_t> glonass_string(const BitString& data, std::uint32_t frame) {
  const auto range = [](int from, int to) {
    std::vector<int> all;
    for (int i = from; i <= to; ++i) all.push_back(i);
    return all;
  };
  const auto join = [](const std::vector<std::vector<int>>& parts) {
    std::vector<int> all;
    for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
  };
  const std::array<std::vector<int>, 7> sums = {
      {{9,  10, 12, 13, 15, 17, 19, 20, 22, 24, 26, 28, 30, 32, 34, 35, 37, 39, 41, 43, 45,
        47, 49, 51, 53, 55, 57, 59, 61, 63, 65, 66, 68, 70, 72, 74, 76, 78, 80, 82, 84},
       {9,  11, 12, 14, 15, 18, 19, 21, 22, 25, 26, 29, 30, 33, 34, 36, 37, 40, 41, 44, 45,
        48, 49, 52, 53, 56, 57, 60, 61, 64, 65, 67, 68, 71, 72, 75, 76, 79, 80, 83, 84},
       join({range(10, 12),
             range(16, 19),
             range(23, 26),
             range(31, 34),
             range(38, 41),
             range(46, 49),
             range(54, 57),
             range(62, 65),
             range(69, 72),
             range(77, 80),
             {85}}),
       join({range(13, 19), range(27, 34), range(42, 49), range(58, 65), range(73, 80)}),
       join({range(20, 34), range(50, 65), range(81, 85)}),
       range(35, 65),
       range(66, 85)}};
  const auto bit = [&](int icd) { return data.at(static_cast<std::size_t>(85 - icd)); };
  std::array<bool, 8> checks{};
  bool sum = false;
  for (int icd = 9; icd <= 85; ++icd) sum = sum != bit(icd);
  for (std::size_t i = 0; i < sums.size(); ++i) {
    for (const int icd : sums[i]) checks[i] = checks[i] != bit(icd);
    sum = sum != checks[i];
  }
  checks[7] = sum;
  BitString string;
  string.put(data);
  for (int i = 7; i >= 0; --i) string.put(checks[static_cast<std::size_t>(i)] ? 1 : 0, 1);
  string.put(0, 11);
  auto words = string.words();
  words.push_back(frame);
  return words;
}

/// Four bits of check of eleven of data: remainder of their polynomial times x^4 by x^4 + x + 1, by long division.
inline std::uint32_t bch_checks(const BitString& data) {
  std::vector<bool> bits;
  for (std::size_t i = 0; i < 11; ++i) bits.push_back(data.at(i));
  bits.resize(15);
  for (std::size_t i = 0; i < 11; ++i)
    if (bits[i])
      for (const std::size_t term : {0U, 3U, 4U}) bits[i + term] = !bits[i + term];
  std::uint32_t checks = 0;
  for (std::size_t i = 11; i < 15; ++i) checks = checks << 1 | (bits[i] ? 1U : 0U);
  return checks;
}

/// How a receiver gives the checks of a word of BeiDou: those of its halves one after the other, or bit by bit in turn.
enum class BeidouForm { kHalves, kInTurn };

/// 224 bits of data of D1 or D2, from the preamble on, to ten words with checks.
inline std::vector<std::uint32_t> beidou_words(const BitString& data, BeidouForm form = BeidouForm::kHalves) {
  std::vector<std::uint32_t> words = {data.number(0, 26) << 4 | bch_checks(data.part(15, 11))};
  for (std::size_t word = 1; word < 10; ++word) {
    const std::size_t at = 26 + 22 * (word - 1);
    const std::uint32_t first = bch_checks(data.part(at, 11)), second = bch_checks(data.part(at + 11, 11));
    std::uint32_t checks = first << 4 | second;
    if (form == BeidouForm::kInTurn) {
      checks = 0;
      for (int bit = 3; bit >= 0; --bit) checks = checks << 2 | (first >> bit & 1U) << 1 | (second >> bit & 1U);
    }
    words.push_back(data.number(at, 22) << 8 | checks);
  }
  return words;
}

/// A page of F/NAV around 214 bits, in eight words.
inline std::vector<std::uint32_t> fnav_page(const BitString& data) {
  BitString checked, page;
  checked.put(0, 2).put(data);  // zeros in front do not change the CRC
  std::string bytes;
  for (std::size_t at = 0; at < checked.size(); at += 8) bytes += static_cast<char>(checked.number(at, 8));
  return page.put(data).put(crc_bit_by_bit(bytes, 0x864CFB, 24), 24).put(0, 6 + 12).words();
}

}  // namespace coast::test
