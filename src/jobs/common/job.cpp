#include "coast/jobs/job.hpp"

#include <system_error>

#include "coast/io/results_folder.hpp"
#include "coast/io/writers.hpp"

namespace coast::jobs {

std::filesystem::path results_folder(const std::filesystem::path& input, const std::filesystem::path& out,
                                     std::vector<std::string> files) {
  std::filesystem::path folder = out;
  if (folder.empty()) {
    folder = input;
    folder.replace_extension(".out");
  }
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed || !std::filesystem::is_directory(folder))
    throw OutputError(folder.string(), failed ? failed.message() : "not a folder");
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
