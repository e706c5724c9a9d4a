#pragma once
// Compressed chunks of bags. Private to the room.

#include <cstddef>
#include <string>
#include <string_view>

namespace coast::io {

/// The content of a bzip2 stream, an LZ4 frame or a Zstandard frame, in place of what `to` has. Memory grows with what is
/// there, not with what is stated.
/// @param most  the largest size  @return false: damaged, cut off, or larger
[[nodiscard]] bool unpack_bz2(std::string_view packed, std::size_t most, std::string& to);
[[nodiscard]] bool unpack_lz4(std::string_view packed, std::size_t most, std::string& to);
[[nodiscard]] bool unpack_zstd(std::string_view packed, std::size_t most, std::string& to);

/// An LZ4 frame with the content.
[[nodiscard]] std::string pack_lz4(std::string_view content);

}  // namespace coast::io
