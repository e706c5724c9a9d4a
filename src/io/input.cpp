#include "coast/io/input.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "coast/io/results_folder.hpp"
#include "coast/io/shipped.hpp"
#include "coast/record/error.hpp"

namespace coast::io {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBlock = std::size_t{1} << 18;
constexpr std::size_t kLeastBlock = std::size_t{1} << 12;
constexpr std::size_t kMaxLine = std::size_t{1} << 20;
// Tables of numbers compress by less than 20, gzip of one repeated byte by 1000.
constexpr std::uint64_t kMaxExpansion = 200;
constexpr std::uint64_t kFreeExpansion = std::uint64_t{64} << 20;  // bytes allowed for any file

[[noreturn]] void refuse(const std::string& name, std::string found, std::string expected, std::string what_to_do) {
  throw InputError({name, 0, std::move(found), std::move(expected), std::move(what_to_do)});
}

void check_is_readable_file(const fs::path& path) {
  std::error_code error;
  const auto status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found)
    refuse(path.string(), "no such file", "",
           "Relative paths count from the folder of the file that names them, on a command line from the current one.");
  if (fs::is_directory(status)) refuse(path.string(), "is a directory", "a file", "");
  if (fs::is_regular_file(status) && fs::file_size(path, error) == 0) refuse(path.string(), "the file is empty", "", "");
}

struct StoredSize {
  std::uint64_t size = 0;  ///< of the content, 0 where it is not known
  bool compressed = false;
};

/// A gzip member ends with its uncompressed length modulo 2^32, little endian (RFC 1952, 2.3.1).
StoredSize stored_size_of(const fs::path& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) return {};
  std::error_code error;
  const auto stored = fs::file_size(path, error);
  if (error) return {};
  std::array<unsigned char, 4> b{};
  const bool is_gzip = std::fread(b.data(), 1, 2, file.get()) == 2 && b[0] == 0x1f && b[1] == 0x8b;
  if (!is_gzip) return {stored, false};
  if (std::fseek(file.get(), -4, SEEK_END) != 0 || std::fread(b.data(), 1, 4, file.get()) != 4) return {0, true};
  const auto stated = std::uint64_t{b[0]} | std::uint64_t{b[1]} << 8 | std::uint64_t{b[2]} << 16 | std::uint64_t{b[3]} << 24;
  // A damaged trailer must not reserve the machine's memory: tables of numbers compress by less than 20.
  return {std::min<std::uint64_t>(stated, 20 * stored), true};
}

/// One byte more than a plain file has, so that its end is seen in the first reading.
std::size_t block_for(const StoredSize& stored) {
  if (stored.compressed || stored.size == 0) return kBlock;
  return static_cast<std::size_t>(std::clamp<std::uint64_t>(stored.size + 1, kLeastBlock, kBlock));
}

}  // namespace

struct ByteSource::Handle {
  gzFile file = nullptr;
  ~Handle() {
    if (file != nullptr) gzclose_r(file);
  }
};

ByteSource::ByteSource(const fs::path& stated) : handle_(std::make_unique<Handle>()) {
  std::error_code failed;
  const fs::path path = fs::exists(stated, failed) ? stated : shipped_file(stated).value_or(stated);
  name_ = path.string();
  check_is_readable_file(path);
  handle_->file = gzopen(path.c_str(), "rb");
  if (handle_->file == nullptr) refuse(name_, fmt::format("cannot be opened: {}", std::strerror(errno)), "", "");
  const StoredSize size = stored_size_of(path);
  expected_size_ = size.size;
  block_ = block_for(size);
  gzbuffer(handle_->file, static_cast<unsigned>(block_));
  note_read(path);
}

ByteSource::~ByteSource() = default;
ByteSource::ByteSource(ByteSource&&) noexcept = default;
ByteSource& ByteSource::operator=(ByteSource&&) noexcept = default;

std::size_t ByteSource::read(char* to, std::size_t size) {
  std::size_t done = 0;
  while (done < size) {
    // In small pieces: a file that expands without end must be detected early.
    const auto chunk = static_cast<unsigned>(std::min(size - done, std::size_t{16} << 20));
    const int n = gzread(handle_->file, to + done, chunk);
    int status = Z_OK;
    const char* text = gzerror(handle_->file, &status);
    // zlib returns Z_BUF_ERROR, with data still delivered, if the compressed stream ends before its trailer.
    if (n < 0 || status == Z_BUF_ERROR)
      refuse(name_, fmt::format("the gzip data are damaged or end early ({})", status == Z_BUF_ERROR ? "no end mark" : text),
             "a whole file", "Copy or download the file again.");
    if (n == 0) break;
    done += static_cast<std::size_t>(n);
    given_ += static_cast<std::uint64_t>(n);
    require_plausible_expansion();
  }
  return done;
}

void ByteSource::require_plausible_expansion() const {
  if (given_ <= kFreeExpansion) return;
  const auto compressed = static_cast<std::uint64_t>(std::max<z_off_t>(gzoffset(handle_->file), 1));
  if (given_ > kMaxExpansion * compressed)
    refuse(name_, fmt::format("{} MiB of gzip expand to more than {} MiB", (compressed >> 20) + 1, given_ >> 20),
           fmt::format("at most {} times the size", kMaxExpansion), "Unpack the file and look at it: is it one of numbers?");
}

std::string read_head(const fs::path& path, std::size_t size) {
  ByteSource source(path);
  std::string text(size, '\0');
  text.resize(source.read(text.data(), size));
  return text;
}

std::string read_all(const fs::path& path, std::uint64_t most) {
  ByteSource source(path);
  const auto require_within = [&](std::uint64_t size) {
    if (size > most)
      refuse(path.string(), fmt::format("more than {} MiB", most >> 20), "a smaller file", "Is this the right file?");
  };
  require_within(source.expected_size());
  std::string text;
  // One byte more than expected, so that the end is detected without a second growth.
  std::size_t size = std::max<std::size_t>(static_cast<std::size_t>(source.expected_size()) + 1, 4096);
  std::size_t used = 0;
  while (true) {
    text.resize(size);
    const std::size_t n = source.read(text.data() + used, size - used);
    used += n;
    require_within(used);
    if (used < size) break;
    size *= 2;
  }
  text.resize(used);
  return text;
}

LineReader::LineReader(const fs::path& path) : source_(path), buffer_(source_.block()) {
  (void)refill();
  if (end_ - begin_ >= 3 && std::memcmp(buffer_.data() + begin_, "\xEF\xBB\xBF", 3) == 0) begin_ += 3;
}

bool LineReader::next(std::string_view& line) {
  std::size_t searched = begin_;
  while (true) {
    const char* found =
        searched < end_ ? static_cast<const char*>(std::memchr(buffer_.data() + searched, '\n', end_ - searched)) : nullptr;
    if (found != nullptr || exhausted_) {
      if (found == nullptr && begin_ == end_) return false;
      const auto stop = found != nullptr ? static_cast<std::size_t>(found - buffer_.data()) : end_;
      line = std::string_view(buffer_.data() + begin_, stop - begin_);
      begin_ = found != nullptr ? stop + 1 : stop;
      terminated_ = found != nullptr;
      ++line_number_;
      bytes_given_ += line.size() + 1;
      if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
      return true;
    }
    const std::size_t pending = end_ - begin_;
    if (pending > kMaxLine)
      throw InputError({name(), line_number_ + 1, "a line of more than 1 MiB", "text in lines", "Is this a binary file?"});
    exhausted_ = !refill();
    searched = begin_ + pending;
  }
}

bool LineReader::refill() {
  const std::size_t pending = end_ - begin_;
  if (begin_ > 0) std::memmove(buffer_.data(), buffer_.data() + begin_, pending);
  begin_ = 0;
  end_ = pending;
  if (pending > buffer_.size() / 2) buffer_.resize(buffer_.size() * 2);
  const std::size_t n = source_.read(buffer_.data() + pending, buffer_.size() - pending);
  end_ += n;
  if (n > 0 && std::memchr(buffer_.data() + pending, '\0', n) != nullptr) cut_at_nul(pending);
  return n > 0;
}

void LineReader::cut_at_nul(std::size_t first_new) {
  const char* base = buffer_.data();
  const auto nul =
      static_cast<std::size_t>(static_cast<const char*>(std::memchr(base + first_new, '\0', end_ - first_new)) - base);
  const long line = line_number_ + 1 + std::count(base + begin_, base + nul, '\n');
  const auto only_filling = [](const char* p, std::size_t n) {
    return std::all_of(p, p + n, [](char c) { return c == '\0' || c == '\x1a' || c == '\n' || c == '\r'; });
  };
  bool tail = nul > 0 && only_filling(base + nul, end_ - nul);
  std::size_t length = end_ - nul;
  std::vector<char> rest(source_.block());
  while (tail) {
    const std::size_t n = source_.read(rest.data(), rest.size());
    if (n == 0) break;
    tail = only_filling(rest.data(), n);
    length += n;
  }
  if (!tail)
    throw InputError({name(), line, "binary data (a zero byte)", "text", "Is this the right file, and the right `format:`?"});
  events_.push_back({record::Event::Severity::kWarning, "trailing_garbage",
                     fmt::format("{}:{}: the file ends with {} zero bytes; they were left out", name(), line, length),
                     std::nullopt, 1});
  end_ = nul;
}

}  // namespace coast::io
