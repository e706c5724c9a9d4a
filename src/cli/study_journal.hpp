#pragma once
// outages.partial: what a study that was interrupted goes on from.

#include <filesystem>
#include <functional>
#include <map>
#include <memory>

#include "coast/io/journal.hpp"
#include "coast/study/ensemble.hpp"

namespace coast::cli {

/// The journal of one study, in its output folder.
class StudyJournalFile {
 public:
  /// @param made_from  digest of everything that decides the numbers
  StudyJournalFile(const std::filesystem::path& folder, std::uint64_t made_from);

  [[nodiscard]] study::StudyJournal callbacks();
  [[nodiscard]] std::size_t known() const { return known_.size(); }
  void remove() { file_.remove(); }

 private:
  io::Journal file_;
  std::map<std::string, std::string> known_;  ///< values by place
};

/// Opens the journal of a study once it is known what it is made from.
using OpenJournal = std::function<study::StudyJournal(std::uint64_t made_from)>;

}  // namespace coast::cli
