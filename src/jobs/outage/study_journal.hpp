#pragma once
// outages.partial: from which an interrupted study is resumed.

#include <filesystem>
#include <functional>
#include <map>
#include <memory>

#include "coast/io/journal.hpp"
#include "coast/study/ensemble.hpp"

namespace coast::jobs {

/// The journal of one study, in its output folder.
class StudyJournalFile {
 public:
  /// @param made_from  digest of all input that determines the numbers
  StudyJournalFile(const std::filesystem::path& folder, std::uint64_t made_from);

  [[nodiscard]] study::StudyJournal callbacks();
  [[nodiscard]] std::size_t known() const { return known_.size(); }
  /// Removes the journal after the results are written.
  static void remove(const std::filesystem::path& folder);

 private:
  io::Journal file_;
  std::map<std::string, std::string> known_;  ///< values by place
};

/// For a study without journal.
[[nodiscard]] study::StudyJournal no_journal(const std::function<std::uint64_t()>& made_from);

/// Opens the journal of a study once its input is known.
/// @param made_from  digest of all input that determines the numbers, computed only if needed
using OpenJournal = std::function<study::StudyJournal(const std::function<std::uint64_t()>& made_from)>;

}  // namespace coast::jobs
