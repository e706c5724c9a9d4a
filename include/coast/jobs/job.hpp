#pragma once
// Common interface of all jobs. Each job, here x, has one public header with:
//
//     XConfig read_x(file or root)              its configuration, checked before any data are read
//     XResult x(config, progress)               the job: values, no files
//     files_of(config)                          the names that write() will write
//     write(config, result, folder)             the second step: results as files
//     told(config, result, folder)              the lines that end the job on a terminal
//
// All throw InputError (bad input or configuration), NumericalError (a computation failed) or OutputError (a file cannot be
// written); see coast/record/error.hpp.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "coast/record/error.hpp"

namespace coast::jobs {

/// Callbacks for messages of a job while it runs. Any of the three may be empty.
struct Progress {
  /// Current step, and the fraction of it that is done; 0 if not known.
  std::function<void(const char* what, double fraction)> stage;
  std::function<void(const std::string& line)> say;   ///< how input was interpreted, what was found or adapted
  std::function<void(const std::string& line)> warn;  ///< what the user should check

  void operator()(const char* what, double fraction) const {
    if (stage) stage(what, fraction);
  }
};

/// `out`, or the input's name + ".out"; created if missing, and marked as a results folder (io/results_folder.hpp).
/// @param files  names that will be written: an error now, not after the computation, if coast may not replace them
/// @throws OutputError, InputError
[[nodiscard]] std::filesystem::path results_folder(const std::filesystem::path& input, const std::filesystem::path& out,
                                                   std::vector<std::string> files);

/// Ends the process at once and removes unfinished files: for use on a signal, from any thread.
[[noreturn]] void exit_without_unfinished_files(int status);

}  // namespace coast::jobs
