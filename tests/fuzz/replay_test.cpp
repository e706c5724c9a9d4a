// Every file of the corpus through the entry that it was found with. Runs in every build.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>

#include "fuzz/entries.hpp"

namespace coast::fuzz {
namespace {

const std::filesystem::path kCorpus = std::filesystem::path(COAST_SOURCE_DIR) / "tests/fuzz/corpus";

TEST(FuzzCorpus, EveryFileIsReadOrRefused) {
  for (const Entry& entry : entries()) {
    int files = 0;
    for (const auto& file : std::filesystem::directory_iterator(kCorpus / entry.name)) {
      std::ifstream stream(file.path(), std::ios::binary);
      const std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
      EXPECT_NO_THROW(entry.run(bytes)) << file.path();
      ++files;
    }
    EXPECT_GE(files, 3) << entry.name;
  }
}

/// Messages of receivers, cut off anywhere and with any one byte wrong.
TEST(FuzzCorpus, FilesOfReceiversAreReadOrRefusedCutOrSpoiled) {
  constexpr std::size_t kStep = 5;  // of the places tried; no field is a multiple of it long throughout
  for (const Entry& entry : entries()) {
    constexpr std::array kOfMessages = {"ubx",     "vectornav", "ulog", "rosbag", "mcap",
                                        "rosbag2", "dataflash", "rtcm", "sbf",    "novatel"};
    if (std::ranges::find(kOfMessages, entry.name) == kOfMessages.end()) continue;
    for (const auto& file : std::filesystem::directory_iterator(kCorpus / entry.name)) {
      std::ifstream stream(file.path(), std::ios::binary);
      const std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
      for (std::size_t at = 1; at < bytes.size(); at += kStep) {
        std::string spoiled = bytes;
        spoiled[at] = static_cast<char>(~spoiled[at]);
        ASSERT_NO_THROW(entry.run(bytes.substr(0, at))) << file.path() << " cut at " << at;
        ASSERT_NO_THROW(entry.run(spoiled)) << file.path() << " spoiled at " << at;
      }
    }
  }
}

TEST(FuzzCorpus, EveryFolderHasItsEntry) {
  for (const auto& folder : std::filesystem::directory_iterator(kCorpus)) {
    const auto& all = entries();
    EXPECT_TRUE(std::any_of(all.begin(), all.end(), [&](const Entry& e) { return e.name == folder.path().filename(); }))
        << folder.path();
  }
}

}  // namespace
}  // namespace coast::fuzz
