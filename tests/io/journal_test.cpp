#include "coast/io/journal.hpp"

#include <gtest/gtest.h>

#include "coast/record/error.hpp"
#include "files.hpp"

namespace coast::io {
namespace {

using Lines = std::vector<std::string>;

TEST(Journal, HasWhatEarlierWorkLeft) {
  const test::Files files;
  {
    Journal first(files.path("work.partial"), "work 1");
    EXPECT_TRUE(first.lines().empty());
    first.append("a 1.5");
    EXPECT_EQ(files.get("work.partial"), "work 1\na 1.5\n");  // whoever is killed now has left it
    first.append("");
    first.append("b,2");
  }
  {
    Journal second(files.path("work.partial"), "work 1");
    EXPECT_EQ(second.lines(), (Lines{"a 1.5", "", "b,2"}));
    second.append("c");
    EXPECT_EQ(second.lines().size(), 3U);  // what was left, not what is added
  }
  EXPECT_EQ(files.get("work.partial"), "work 1\na 1.5\n\nb,2\nc\n");
  EXPECT_EQ(Journal(files.path("work.partial"), "work 1").lines(), (Lines{"a 1.5", "", "b,2", "c"}));
}

TEST(Journal, DropsALastLineThatHasNoEnd) {
  const test::Files files;
  files.put("work.partial", "work 1\na 1.5\nb 2.");
  Journal journal(files.path("work.partial"), "work 1");
  EXPECT_EQ(journal.lines(), (Lines{"a 1.5"}));
  journal.append("b 2.5");
  EXPECT_EQ(files.get("work.partial"), "work 1\na 1.5\nb 2.5\n");
}

TEST(Journal, BeginsAnewWhereTheFileIsOfOtherWork) {
  for (const char* left :
       {"", "\n", "work 1", "work 1\n", "work 2", "work 21\na\n", " work 2\na\n", "work 2\r\na\n", "a\nwork 2\n"}) {
    const test::Files files;
    files.put("work.partial", left);
    Journal journal(files.path("work.partial"), "work 2");
    EXPECT_TRUE(journal.lines().empty()) << left;
    journal.append("b");
    EXPECT_EQ(files.get("work.partial"), "work 2\nb\n") << left;
  }
}

TEST(Journal, IsRemovedWhenTheWorkIsDone) {
  const test::Files files;
  Journal journal(files.path("work.partial"), "work 1");
  journal.append("a");
  journal.remove();
  EXPECT_FALSE(std::filesystem::exists(files.path("work.partial")));
  EXPECT_TRUE(Journal(files.path("work.partial"), "work 1").lines().empty());
}

TEST(Journal, SaysWhereItCannotWrite) {
  const test::Files files;
  const std::filesystem::path path = files.path("none") / "work.partial";
  try {
    const Journal journal(path, "work 1");
    FAIL() << "no folder";
  } catch (const OutputError& error) {
    EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace coast::io
