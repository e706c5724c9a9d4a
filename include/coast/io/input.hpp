#pragma once
// The bytes of a file: plain or gzip (recognised by content), in blocks, so that a text of any length needs only a small
// buffer. Only this code and the configuration parser open files for reading.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "coast/record/event.hpp"

namespace coast::io {

/// Sequential bytes of a file, decompressed if it is gzip.
class ByteSource {
 public:
  /// @throws InputError  missing, not readable, a directory, or empty
  explicit ByteSource(const std::filesystem::path& path);
  ~ByteSource();
  ByteSource(ByteSource&&) noexcept;
  ByteSource& operator=(ByteSource&&) noexcept;

  /// Reads up to `size` bytes; fewer only at the end, 0 when nothing is left.
  /// @throws InputError  the compressed data are damaged, end early, or expand to more than 64 MiB and more than 200 times
  ///                     their size
  [[nodiscard]] std::size_t read(char* to, std::size_t size);

  [[nodiscard]] const std::string& name() const { return name_; }  ///< as given, for messages
  /// Length of the content: the file's, or that given in the gzip trailer (modulo 2^32). For reserving memory only.
  [[nodiscard]] std::uint64_t expected_size() const { return expected_size_; }
  /// Bytes of a buffer to read it with: a quarter MiB, less where the whole file fits. Formats are told by trying: most
  /// readers of a small file read its head alone, and clearing their buffers would take longer than reading it.
  [[nodiscard]] std::size_t block() const { return block_; }

 private:
  struct Handle;
  void require_plausible_expansion() const;
  std::unique_ptr<Handle> handle_;
  std::string name_;
  std::uint64_t given_ = 0;
  std::uint64_t expected_size_ = 0;
  std::size_t block_ = 0;
};

/// The first `size` decompressed bytes (fewer if the file is shorter), for recognising formats.
[[nodiscard]] std::string read_head(const std::filesystem::path& path, std::size_t size);
/// The whole decompressed content: for binary formats and small texts.
/// @param most  maximum number of bytes
/// @throws InputError  the content is longer
[[nodiscard]] std::string read_all(const std::filesystem::path& path, std::uint64_t most = std::uint64_t{16} << 30);

/// Lines of a text in blocks. CR LF and a UTF-8 byte-order mark are removed. NUL bytes at the end (writing was interrupted) are
/// left out and reported; any other NUL is "binary data", an error that names the line.
class LineReader {
 public:
  explicit LineReader(const std::filesystem::path& path);

  /// The next line without its line end; the view is valid until the next call.
  /// @throws InputError  binary data, a line longer than 1 MiB, damaged gzip
  [[nodiscard]] bool next(std::string_view& line);

  [[nodiscard]] long line_number() const { return line_number_; }  ///< of the last line returned, 1-based
  /// False for a last line without a line feed: it may have been cut off.
  [[nodiscard]] bool terminated() const { return terminated_; }
  [[nodiscard]] const std::string& name() const { return source_.name(); }
  [[nodiscard]] std::uint64_t expected_size() const { return source_.expected_size(); }
  [[nodiscard]] std::uint64_t bytes_given() const { return bytes_given_; }
  [[nodiscard]] const record::Events& events() const { return events_; }

 private:
  [[nodiscard]] bool refill();
  void cut_at_nul(std::size_t first_new);

  ByteSource source_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0;  ///< first byte not yet returned
  std::size_t end_ = 0;    ///< end of the valid bytes
  bool exhausted_ = false;
  bool terminated_ = true;
  long line_number_ = 0;
  std::uint64_t bytes_given_ = 0;
  record::Events events_;
};

}  // namespace coast::io
