#include "coast/jobs/job.hpp"

#include <optional>
#include <system_error>

#include "coast/io/results_folder.hpp"
#include "coast/io/shipped.hpp"
#include "coast/io/writers.hpp"

namespace coast::jobs {

namespace {

/// Beside the input; of what is installed in the current folder.
std::filesystem::path default_folder(const std::filesystem::path& input) {
  std::error_code failed;
  const std::optional<std::filesystem::path> shipped = io::shipped_file(input);
  const bool is_shipped = shipped && (!std::filesystem::exists(input, failed) || *shipped == input.lexically_normal());
  std::filesystem::path folder = is_shipped ? input.filename() : input;
  return folder.replace_extension(".out");
}

}  // namespace

std::filesystem::path results_folder(const std::filesystem::path& input, const std::filesystem::path& out,
                                     std::vector<std::string> files) {
  std::filesystem::path folder = out.empty() ? default_folder(input) : out;
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed || !std::filesystem::is_directory(folder))
    throw OutputError(folder.string(),
                      (failed ? failed.message() : "not a folder") + (out.empty() ? "; name another folder: --out" : ""));
  // A run that repeats another would overwrite its own input file at the end.
  const std::string name = input.filename().string();
  if (name.ends_with(".resolved.yaml")) files.push_back(name);
  io::open_results_folder(folder, files);
  return folder;
}

void exit_without_unfinished_files(int status) {
  io::exit_without_unfinished_files(status);
}

}  // namespace coast::jobs
