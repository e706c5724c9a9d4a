#include "coast/io/result_store.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#include "coast/record/error.hpp"

namespace coast::io {

namespace {

namespace fs = std::filesystem;

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? std::string(name.data()) : "unknown";
}

void make_folder(const fs::path& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) throw OutputError(folder.string(), failed.message());
}

/// Waits until the disk has a file: a machine that loses its power must not leave a result with nothing in it.
void flush_to_disk(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  const bool done = descriptor >= 0 && ::fsync(descriptor) == 0;
  const int error = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (!done) throw OutputError(file.string(), std::strerror(error));
}

/// The process in "key.host.process.number" if it is one of this machine that has ended.
bool is_left_behind(const std::string& name, const std::string& host) {
  const std::size_t number = name.rfind('.');
  if (number == std::string::npos || number == 0) return false;
  const std::size_t process = name.rfind('.', number - 1);
  const std::size_t key = name.find('.');
  if (process == std::string::npos || key >= process || name.substr(key + 1, process - key - 1) != host) return false;
  pid_t id = 0;
  const auto [end, error] = std::from_chars(name.data() + process + 1, name.data() + number, id);
  return error == std::errc() && end == name.data() + number && id > 0 && ::kill(id, 0) != 0 && errno == ESRCH;
}

}  // namespace

ResultStore::ResultStore(fs::path folder) : folder_(std::move(folder)) {}

std::string ResultStore::place_of(std::string_view key) {
  return fmt::format("results/{}/{}", key.substr(0, 2), key);
}

fs::path ResultStore::folder_of(std::string_view key) const {
  return folder_ / place_of(key);
}

std::optional<std::string> ResultStore::read(std::string_view key, const char* file) const {
  std::ifstream in(folder_of(key) / file, std::ios::binary);
  if (!in) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(in), {});
}

bool ResultStore::has(std::string_view key, const char* file) const {
  return ::access((folder_of(key) / file).c_str(), R_OK) == 0;
}

void ResultStore::remove(std::string_view key) const {
  std::error_code failed;
  fs::remove_all(folder_of(key), failed);
  if (failed) throw OutputError(folder_of(key).string(), failed.message());
}

void ResultStore::remove_unfinished() const {
  std::error_code none;
  const std::string host = host_name();
  for (const auto& entry : fs::directory_iterator(folder_ / "unfinished", none))
    if (is_left_behind(entry.path().filename().string(), host)) fs::remove_all(entry.path(), none);
}

ResultStore::Work::Work(const ResultStore& store, std::string_view key) : store_(store), key_(key) {
  static std::atomic<unsigned> number{0};
  folder_ = store.folder_ / "unfinished" / fmt::format("{}.{}.{}.{}", key.substr(0, 16), host_name(), ::getpid(), number++);
  make_folder(folder_);
}

ResultStore::Work::~Work() {
  std::error_code ignored;
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

void ResultStore::Work::finish(const char* last) {
  flush_to_disk(folder_ / last);
  const fs::path place = store_.folder_of(key_);
  make_folder(place.parent_path());
  if (std::rename(folder_.c_str(), place.c_str()) == 0) {
    folder_.clear();
    return;
  }
  // Somebody else has computed the same: his stays, and this one is removed.
  if (errno != ENOTEMPTY && errno != EEXIST) throw OutputError(place.string(), std::strerror(errno));
}

}  // namespace coast::io
