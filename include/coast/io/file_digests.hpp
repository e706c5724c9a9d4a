#pragma once
// Digests of input files, remembered from one run to the next.

#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>

namespace coast::io {

/// SHA-256 of files. A file that has kept its length, inode and time of last change to the nanosecond is not read again. A
/// digest is remembered only if the file had not changed for two seconds before it was read: a change within the same tick of
/// the disk's clock would otherwise go unseen.
class FileDigests {
 public:
  /// @param memory  file of remembered digests; whatever in it is damaged is ignored. Empty: nothing is remembered
  explicit FileDigests(std::filesystem::path memory);

  /// May be called by several threads.  @throws InputError  missing or not readable
  [[nodiscard]] std::string of(const std::filesystem::path& path);
  /// Writes what is remembered, if there is anything new, with what others have remembered meanwhile.  @throws OutputError
  void save();

 private:
  struct Known {
    std::string stamp;  ///< length, inode, time of change
    std::string digest;
  };
  void read();
  std::filesystem::path memory_;
  std::mutex mutex_;
  std::map<std::string, Known> known_;
  bool changed_ = false;
};

}  // namespace coast::io
