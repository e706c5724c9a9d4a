#pragma once
// Results of many computations in one folder, each under a key that says what it was computed from.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace coast::io {

/// FOLDER/results/ab/abcdef.../: a folder for each key, which appears whole or not at all. Any number of processes, on any
/// number of machines that share the folder, may write to it at once, also the same key: the first result stays.
class ResultStore {
 public:
  explicit ResultStore(std::filesystem::path folder);

  /// results/ab/abcdef..., from the folder of the store on.
  [[nodiscard]] static std::string place_of(std::string_view key);
  [[nodiscard]] std::filesystem::path folder_of(std::string_view key) const;
  /// Content of a file of a result; none if there is no such result, or no such file of it.
  [[nodiscard]] std::optional<std::string> read(std::string_view key, const char* file) const;
  [[nodiscard]] bool has(std::string_view key, const char* file) const;
  /// Removes a result, so that it is computed again.  @throws OutputError
  void remove(std::string_view key) const;
  /// Removes the unfinished folders of processes of this machine that have ended.
  void remove_unfinished() const;

  /// A result that is being computed, in a folder of its own; it is removed unless it becomes the result.
  class Work {
   public:
    Work(const ResultStore& store, std::string_view key);
    ~Work();
    Work(const Work&) = delete;
    Work& operator=(const Work&) = delete;
    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
    /// Moves the folder to its place, or removes it if there is a result.
    /// @param last  its closing file: on the disk before the folder moves
    /// @throws OutputError
    void finish(const char* last);

   private:
    const ResultStore& store_;
    std::string key_;
    std::filesystem::path folder_;
  };

 private:
  std::filesystem::path folder_;
};

}  // namespace coast::io
