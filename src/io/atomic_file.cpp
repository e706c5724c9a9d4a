#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "coast/io/writers.hpp"

namespace coast::io {

namespace fs = std::filesystem;

AtomicFile::AtomicFile(const fs::path& path) : path_(path), written_(path) {
  std::error_code ignored;
  const auto status = fs::status(path, ignored);
  if (fs::is_directory(status)) throw OutputError(path.string(), "is a directory");
  const bool direct = fs::exists(status) && !fs::is_regular_file(status);
  int flags = O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC;
  if (!direct) {
    written_ += fmt::format(".part-{}", ::getpid());
    flags |= O_EXCL;
    ::unlink(written_.c_str());  // left by a run that was killed under the same process number
  }
  descriptor_ = ::open(written_.c_str(), flags, 0666);
  if (descriptor_ < 0) throw OutputError(path_.string(), std::strerror(errno));
}

AtomicFile::~AtomicFile() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  if (written_ != path_) ::unlink(written_.c_str());
}

void AtomicFile::fail(int error) {
  ::close(descriptor_);
  descriptor_ = -1;
  if (written_ != path_) ::unlink(written_.c_str());
  throw OutputError(path_.string(), std::strerror(error));
}

void AtomicFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const auto n = ::write(descriptor_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(errno);
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

void AtomicFile::commit() {
  const int descriptor = descriptor_;
  // close() can be the first to report a full quota or network disk.
  descriptor_ = -1;
  if (::close(descriptor) != 0) {
    const int error = errno;
    if (written_ != path_) ::unlink(written_.c_str());
    throw OutputError(path_.string(), std::strerror(error));
  }
  if (written_ == path_) return;
  if (::rename(written_.c_str(), path_.c_str()) != 0) {
    const int error = errno;
    ::unlink(written_.c_str());
    throw OutputError(path_.string(), std::strerror(error));
  }
}

void write_text(const fs::path& path, std::string_view text) {
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace coast::io
