#pragma once
// Results of long work, saved line by line, so that they survive an interruption.

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace coast::io {

/// A text file that grows by whole lines, each on the disk before the next begins. The first line identifies the work; a file
/// with another first line is from other work and is overwritten.
class Journal {
 public:
  /// @param of  one line that identifies the work
  /// @throws OutputError  the file cannot be written
  Journal(const std::filesystem::path& path, std::string_view of);

  /// Lines from an earlier run, without the first line and without an incomplete last line.
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
