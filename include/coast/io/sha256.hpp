#pragma once
// SHA-256: what identifies the content of a file.

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace coast::io {

/// @see NIST (2015), FIPS PUB 180-4, Secure Hash Standard, sections 4.1.2, 5.1.1, 5.3.3 and 6.2
class Sha256 {
 public:
  void add(std::string_view bytes);
  /// Of all bytes so far, 64 hexadecimal digits. Nothing may be added afterwards.
  [[nodiscard]] std::string hex();

 private:
  void block(const unsigned char* bytes);
  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<unsigned char, 64> pending_{};
  std::size_t filled_ = 0;
  std::uint64_t bytes_ = 0;
};

[[nodiscard]] std::string sha256(std::string_view bytes);
/// Of the bytes of a file as they are on the disk; of a folder: of the names and contents of its files, in order.
/// @throws InputError  missing or not readable
[[nodiscard]] std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace coast::io
