#pragma once
// Lines that survive an interruption of long work.

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace coast::io {

/// A text file that grows by whole lines, each on the disk before the next begins. The first line says what the others are
/// results of; a file that begins otherwise is of other work, and is begun anew.
class Journal {
 public:
  /// @param of  one line
  /// @throws OutputError  the file cannot be written
  Journal(const std::filesystem::path& path, std::string_view of);

  /// What earlier work left, without the first line and without a last one that has no end.
  [[nodiscard]] const std::vector<std::string>& lines() const { return lines_; }
  /// @throws OutputError
  void append(std::string_view line);
  /// The work is done: closes and removes the file.
  void remove();

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::filesystem::path path_;
  std::vector<std::string> lines_;
  std::unique_ptr<std::FILE, CloseFile> file_;
};

}  // namespace coast::io
