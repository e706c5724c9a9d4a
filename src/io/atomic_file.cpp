#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <functional>
#include <mutex>
#include <vector>

#include "coast/io/results_folder.hpp"
#include "coast/io/writers.hpp"

namespace coast::io {

namespace fs = std::filesystem;

namespace {

// Incomplete files. A signal ends the process, not one writer: so there is one list of them, which is never destroyed.
struct Unfinished {
  std::mutex mutex;
  std::vector<fs::path> parts;
};
Unfinished& unfinished() {
  static const std::reference_wrapper<Unfinished> files(*new Unfinished);
  return files;
}

void forget(const fs::path& part) {
  const std::scoped_lock lock(unfinished().mutex);
  std::erase(unfinished().parts, part);
}

}  // namespace

void exit_without_unfinished_files(int status) {
  unfinished().mutex.lock();  // permanently: no other file is begun
  for (const fs::path& part : unfinished().parts) ::unlink(part.c_str());
  ::_exit(status);
}

AtomicFile::AtomicFile(const fs::path& path) : path_(path), written_(path) {
  std::error_code ignored;
  const auto status = fs::status(path, ignored);
  if (fs::is_directory(status)) throw OutputError(path.string(), "is a directory");
  const bool direct = fs::exists(status) && !fs::is_regular_file(status);
  if (!direct) {
    require_replaceable(path);
    note_written(path, 0);
  }
  int flags = O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC;
  if (!direct) {
    written_ += fmt::format(".part-{}", ::getpid());
    flags |= O_EXCL;
    ::unlink(written_.c_str());  // left by a killed run with the same process number
  }
  const std::scoped_lock lock(unfinished().mutex);
  descriptor_ = ::open(written_.c_str(), flags, 0666);
  if (descriptor_ < 0) throw OutputError(path_.string(), std::strerror(errno));
  if (!direct) unfinished().parts.push_back(written_);
}

AtomicFile::~AtomicFile() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  remove_part();
}

void AtomicFile::remove_part() {
  if (written_ == path_) return;
  ::unlink(written_.c_str());
  forget(written_);
}

void AtomicFile::fail(int error) {
  ::close(descriptor_);
  descriptor_ = -1;
  remove_part();
  throw OutputError(path_.string(), std::strerror(error));
}

void AtomicFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const auto n = ::write(descriptor_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(errno);
    bytes.remove_prefix(static_cast<std::size_t>(n));
    size_ += static_cast<std::size_t>(n);
  }
}

void AtomicFile::commit() {
  const int descriptor = descriptor_;
  // close() may be the first to report a full quota or network disk.
  descriptor_ = -1;
  if (::close(descriptor) != 0) {
    const int error = errno;
    remove_part();
    throw OutputError(path_.string(), std::strerror(error));
  }
  if (written_ == path_) return;
  try {
    note_written(path_, size_);
  } catch (...) {
    remove_part();
    throw;
  }
  if (::rename(written_.c_str(), path_.c_str()) != 0) {
    const int error = errno;
    remove_part();
    throw OutputError(path_.string(), std::strerror(error));
  }
  forget(written_);
}

void write_text(const fs::path& path, std::string_view text) {
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace coast::io
