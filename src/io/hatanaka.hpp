#pragma once
// Decompression of Hatanaka's compact RINEX. Private to the room.

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "coast/io/input.hpp"

namespace coast::io {

/// CRINEX 1.0 (of RINEX 2) and 3.0 (of RINEX 3 and 4): epoch lines as differences of characters, numbers as differences of up
/// to ninth order in thousandths (Hatanaka 2008, Bull. GSI 55, 21-30). Clock offsets of the receiver are not restored.
class Hatanaka {
 public:
  /// Whether the first line of a file is that of compact RINEX.
  [[nodiscard]] static bool begins(std::string_view first_line);
  /// @param first_line  already read from `lines`
  Hatanaka(LineReader& lines, std::string_view first_line);

  /// The next line of the RINEX file; the view holds until the next call.
  /// @throws InputError  invalid content, with the line of the compact file
  [[nodiscard]] bool next(std::string_view& line);

 private:
  /// One number over successive epochs.
  struct Arc {
    int order = -1;  ///< of the highest known difference; -1: none
    int highest = 0;
    std::array<std::int64_t, 10> differences{};
    void begin(int highest_order, std::int64_t value);
    void continue_with(std::int64_t difference);
  };
  struct SatelliteArcs {
    std::vector<Arc> numbers;
    std::string flags;
  };

  [[nodiscard]] bool raw(std::string_view& line);
  [[noreturn]] void refuse(std::string found, std::string expected) const;
  void pass_header(std::string_view line);
  [[nodiscard]] bool decode_epoch();
  void decode_satellite(const std::string& id, std::string_view line, SatelliteArcs& arcs);
  void give_epoch_line(std::size_t satellites);
  void give_numbers(const std::string& id, const SatelliteArcs& arcs);
  [[nodiscard]] std::size_t types_of(const std::string& id) const;

  LineReader& lines_;
  bool compact3_ = false;
  bool in_header_ = true;
  std::map<char, std::size_t> types_;  ///< number of types per system; ' ' in RINEX 2
  std::string epoch_;
  std::map<std::string, SatelliteArcs> arcs_;
  std::deque<std::string> ready_;
  std::string given_;
};

}  // namespace coast::io
