#include "coast/io/file_digests.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <ctime>
#include <fstream>
#include <utility>

#include "coast/io/sha256.hpp"
#include "coast/io/writers.hpp"

namespace coast::io {

namespace {

constexpr std::size_t kDigits = 64;

struct Stamp {
  std::string text;
  bool settled = false;  ///< not changed lately
};

/// None of what is no regular file: it is read each time.
std::optional<Stamp> stamp_of(const std::filesystem::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  constexpr std::time_t kSettled = 2;  // s
  return Stamp{fmt::format("{}:{}:{}.{:09}:{}.{:09}", status.st_size, status.st_ino, status.st_mtim.tv_sec,
                           status.st_mtim.tv_nsec, status.st_ctim.tv_sec, status.st_ctim.tv_nsec),
               std::time(nullptr) - status.st_mtim.tv_sec > kSettled && std::time(nullptr) - status.st_ctim.tv_sec > kSettled};
}

}  // namespace

FileDigests::FileDigests(std::filesystem::path memory) : memory_(std::move(memory)) {
  read();
}

// A line: digest, stamp, path.
void FileDigests::read() {
  if (memory_.empty()) return;
  std::ifstream in(memory_);
  for (std::string line; std::getline(in, line);) {
    const std::size_t space = line.find(' ', kDigits + 1);
    if (line.size() < kDigits + 2 || line[kDigits] != ' ' || space == std::string::npos) continue;
    known_.try_emplace(line.substr(space + 1), Known{line.substr(kDigits + 1, space - kDigits - 1), line.substr(0, kDigits)});
  }
}

std::string FileDigests::of(const std::filesystem::path& path) {
  const std::string name = path.string();
  const std::optional<Stamp> stamp = stamp_of(path);
  if (stamp) {
    const std::scoped_lock lock(mutex_);
    const auto known = known_.find(name);
    if (known != known_.end() && known->second.stamp == stamp->text) return known->second.digest;
  }
  std::string digest = sha256_of_file(path);
  if (stamp && stamp->settled && name.find('\n') == std::string::npos) {
    const std::scoped_lock lock(mutex_);
    known_[name] = {stamp->text, digest};
    changed_ = true;
  }
  return digest;
}

void FileDigests::save() {
  if (memory_.empty() || !changed_) return;
  read();  // what is known here stays: it is newer
  std::string text;
  for (const auto& [path, known] : known_) text += fmt::format("{} {} {}\n", known.digest, known.stamp, path);
  write_text(memory_, text);
  changed_ = false;
}

}  // namespace coast::io
