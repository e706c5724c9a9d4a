#pragma once
// Which files in a folder coast may replace: only files that coast wrote there and that the job has not read.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace coast::io {

/// Makes a folder a results folder: a marker file, `.coast-results`, lists the files that coast wrote there, with their
/// lengths. In such a folder AtomicFile replaces only files that are listed there with their current length. A results folder
/// without a marker, from an earlier version, is recognised by its stored results. Partial files of ended processes are
/// removed.
///
/// @param folder  must exist
/// @param files   names that the job will write, checked before anything else is done
/// @throws InputError   one of `files` exists and was not written by coast, or was read by this job
/// @throws OutputError  the marker cannot be written
void open_results_folder(const std::filesystem::path& folder, const std::vector<std::string>& files);

/// Begins to replace a set of results. The last file of the set (summary.json of `coast process`) is removed and recorded in
/// the marker as pending; the job writes it last. If it is missing, the set is incomplete, or mixes files of two runs.
/// @throws InputError   the file exists and was not written by coast
/// @throws OutputError  it cannot be removed, or the marker cannot be written
void begin_results(const std::filesystem::path& closing);
/// Name of the last file of a set, if an interrupted run did not write it; nothing in a folder without a marker.
[[nodiscard]] std::optional<std::string> awaited_result(const std::filesystem::path& folder);

/// Checks that writing a file does not replace one that coast did not write. In a folder without a marker any file may be
/// written.
/// @throws InputError  the folder has a marker, the file exists, and coast did not write it or this job has read it
void require_replaceable(const std::filesystem::path& file);

/// Lists a file in the marker of its folder, if there is one; 0 bytes: writing has begun.  @throws OutputError
void note_written(const std::filesystem::path& file, std::uintmax_t bytes);
/// Records that this job has read a file: it is then not replaced.
void note_read(const std::filesystem::path& file);

}  // namespace coast::io
