#pragma once
// A short identifier of the input of a study.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace coast::jobs {

/// FNV-1a, 64 bits: detects accidental changes, not deliberate ones.
/// @see Fowler, Noll & Vo; draft-eastlake-fnv
class Digest {
 public:
  void add(std::string_view bytes) {
    constexpr std::uint64_t kPrime = 0x100000001b3;
    for (const char c : bytes) value_ = (value_ ^ static_cast<unsigned char>(c)) * kPrime;
  }
  void add(double value) { add(std::string_view(reinterpret_cast<const char*>(&value), sizeof value)); }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325;
};

}  // namespace coast::jobs
