#pragma once
// Which files of a folder coast may replace: those that it wrote there itself, and that the job has not read.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace coast::io {

/// Makes a folder one of results: a mark in it, `.coast-results`, lists what coast wrote there, with the length of each file.
/// AtomicFile replaces in such a folder only what the mark lists at its present length. A folder of results without a mark,
/// from an earlier version, is recognised by its stored results. What dead processes left half written is removed.
///
/// @param folder  exists
/// @param files   names that the job will write, checked before anything else is done
/// @throws InputError   one of `files` is there and is not coast's, or was read by this job
/// @throws OutputError  the mark cannot be written
void open_results_folder(const std::filesystem::path& folder, const std::vector<std::string>& files);

/// Begins to replace a set of results. The file that closes the set (summary.json of `coast process`) is removed and awaited by
/// the mark, and the job writes it last: where it is missing the folder holds part of a set, or files of two runs.
/// @throws InputError   the file is there and is not coast's
/// @throws OutputError  it cannot be removed, or the mark cannot be written
void begin_results(const std::filesystem::path& closing);
/// Name of the closing file that a run which was interrupted did not write; nothing in a folder without a mark.
[[nodiscard]] std::optional<std::string> awaited_result(const std::filesystem::path& folder);

/// Whether a file can be written without the loss of one that is not coast's. In a folder without a mark every file can.
/// @throws InputError  the file is there, in a folder with a mark, and coast did not write it or this job has read it
void require_replaceable(const std::filesystem::path& file);

/// Lists a file in the mark of its folder, if that has one; 0 bytes: it is begun.  @throws OutputError
void note_written(const std::filesystem::path& file, std::uintmax_t bytes);
/// A file that this job has read: it is not replaced any more.
void note_read(const std::filesystem::path& file);

}  // namespace coast::io
