#include "outage/study_journal.hpp"

#include <fmt/format.h>

#include <system_error>

#include "outage/outage_table.hpp"

namespace coast::jobs {

namespace {

constexpr const char* kFile = "outages.partial";

std::string key_of(const study::StudyPlace& place) {
  return fmt::format("{},{},{}", place.run, place.group, place.outage);
}

}  // namespace

StudyJournalFile::StudyJournalFile(const std::filesystem::path& folder, std::uint64_t made_from)
    : file_(folder / kFile, fmt::format("coast {} outages {:016x}", COAST_VERSION, made_from)) {
  for (const std::string& line : file_.lines()) {
    const std::size_t space = line.find(' ');
    if (space != std::string::npos) known_[line.substr(0, space)] = line.substr(space + 1);
  }
}

void StudyJournalFile::remove(const std::filesystem::path& folder) {
  std::error_code none;
  std::filesystem::remove(folder / kFile, none);
}

study::StudyJournal no_journal(const std::function<std::uint64_t()>&) {
  return {[](const study::StudyPlace&) -> std::optional<study::OutageResult> { return std::nullopt; },
          [](const study::StudyPlace&, const study::OutageResult&) {}};
}

study::StudyJournal StudyJournalFile::callbacks() {
  study::StudyJournal journal;
  journal.known = [this](const study::StudyPlace& place) -> std::optional<study::OutageResult> {
    const auto line = known_.find(key_of(place));
    if (line == known_.end()) return std::nullopt;
    return outage_from(line->second);
  };
  journal.finished = [this](const study::StudyPlace& place, const study::OutageResult& result) {
    file_.append(key_of(place) + " " + outage_values(result));
  };
  return journal;
}

}  // namespace coast::jobs
