#include "coast/io/table.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include <cmath>

#include "files.hpp"

namespace coast::io {
namespace {

using test::Files;
using test::refusal;

/// All rows of two columns.
std::vector<std::array<double, 2>> rows_of(TableReader& table, const Column& a, const Column& b) {
  const auto sa = table.number_slot(a, "a");
  const auto sb = table.number_slot(b, "b");
  std::vector<std::array<double, 2>> rows;
  while (table.next()) rows.push_back({table.number(sa), table.number(sb)});
  return rows;
}

const std::vector<std::array<double, 2>> kExpected = {{1.0, -3.5}, {2.0, 1e-3}};

TEST(Table, ReadsEveryDelimiterWithAndWithoutHeader) {
  const Files files;
  for (const std::string text : {"1,9,-3.5\n2,9,1e-3\n", "1;9;-3.5\n2;9;.001\n", "1\t9\t-3.5\n2\t9\t0.001\n",
                                 "  1   9 -3.5\n2 9\t +1e-3  \n", "# note\n\n% more\n1, 9, -3.5\n#\n2 ,9 , 0.001 \n"}) {
    TableReader table(files.put("t.txt", text));
    EXPECT_EQ(rows_of(table, 1, 3), kExpected) << text;
  }
  TableReader named(files.put("t.csv", "time,x,\"value, scaled\"\n1,9,-3.5\n2,9,0.001\n"));
  EXPECT_EQ(rows_of(named, "time", "value, scaled"), kExpected);
}

TEST(Table, SeesThroughGzipByteOrderMarkAndCarriageReturns) {
  const Files files;
  TableReader table(files.put_gzip("t.csv", "\xEF\xBB\xBFtime,v\r\n1,-3.5\r\n2,1e-3\r\n"));
  EXPECT_EQ(table.header(), (std::vector<std::string>{"time", "v"}));
  EXPECT_EQ(rows_of(table, "time", "v"), kExpected);
  EXPECT_EQ(table.line(), 3);
}

TEST(Table, QuotedFieldsKeepTheirDelimiters) {
  const Files files;
  TableReader table(files.put("t.csv", "t,note,v\n1,\"a, b\",-3.5\n2,\"c\",\"1e-3\"\n"));
  const auto note = table.text_slot("note", "note");
  const auto v = table.number_slot("v", "v");
  ASSERT_TRUE(table.next());
  EXPECT_EQ(table.text(note), "a, b");
  EXPECT_EQ(table.number(v), -3.5);
  ASSERT_TRUE(table.next());
  EXPECT_EQ(table.number(v), 1e-3);
}

TEST(Table, EmptyAndNonFiniteFieldsAreNaNForTheCaller) {
  const Files files;
  TableReader table(files.put("t.csv", "1,2\n3,\n4,nan\n5,-Infinity\n6,7\n"));
  const auto b = table.number_slot(2, "b");
  std::vector<bool> finite;
  while (table.next()) finite.push_back(table.finite());
  EXPECT_EQ(finite, (std::vector<bool>{true, false, false, false, true}));
  EXPECT_EQ(table.number(b), 7.0);
}

TEST(Table, ManyBlocksGiveTheSameRowsAsOne) {
  // 60000 lines of 12 to 19 characters cross the 256 KiB blocks of the reader at all offsets.
  const Files files;
  std::string text;
  for (int i = 0; i < 60000; ++i) text += fmt::format("{},{}\n", i, 0.5 * i * (i % 3 == 0 ? 1e6 : 1.0));
  TableReader table(files.put("t.csv", text));
  const auto a = table.number_slot(1, "a");
  const auto b = table.number_slot(2, "b");
  int i = 0;
  for (; table.next(); ++i) {
    ASSERT_EQ(table.number(a), i);
    ASSERT_EQ(table.number(b), 0.5 * i * (i % 3 == 0 ? 1e6 : 1.0));
    ASSERT_EQ(table.line(), i + 1);
  }
  EXPECT_EQ(i, 60000);
}

TEST(Table, NamesLineColumnAndRemedy) {
  const Files files;
  const auto read = [&](const std::string& text, const Column& column) {
    return refusal([&] {
      TableReader table(files.put("t.csv", text));
      (void)table.number_slot(column, "gyro");
      while (table.next()) {
      }
    });
  };
  EXPECT_NE(read("a,b\n1,2\n3,x4\n5,6\n", "b").find("t.csv:3: \"x4\" in column 2 (b), expected a number"), std::string::npos);
  EXPECT_NE(read("1,2\n3\n5,6\n", 1).find("t.csv:2: 1 column, expected 2"), std::string::npos);
  EXPECT_NE(read("1,2\n3,4,5\n5,6\n", 1).find("t.csv:2: 3 columns, expected 2"), std::string::npos);
  EXPECT_NE(read("1 2\n3 4 5\n5 6\n", 1).find("t.csv:2: 3 columns, expected 2"), std::string::npos);
  EXPECT_NE(read("1;2,5\n3;4,5\n", 2).find("point, not a comma"), std::string::npos);
  EXPECT_NE(read("time,gyr_x\n1,2\n", "gyro_x").find("Do you mean \"gyr_x\"?"), std::string::npos);
  EXPECT_NE(read("1,2\n", 3).find("2 columns, expected column 3 (gyro)"), std::string::npos);
  EXPECT_NE(read("1,2\n", "w").find("no header line"), std::string::npos);
  EXPECT_NE(read("w,w\n1,2\n", "w").find("two columns named"), std::string::npos);
  EXPECT_NE(read("w,x,y\n1,2\n", "w").find("header of 3 names"), std::string::npos);
  EXPECT_NE(read("# only a note\n", 1).find("no row of numbers"), std::string::npos);
}

std::string twelve_rows() {
  std::string text;
  for (int i = 0; i < 12; ++i) text += fmt::format("{},{}.25\n", i, 10 + i);
  return text;
}

struct Tail {
  const char* text;
  long rows;
  long events;
};

TEST(Table, LeavesOutOnlyAnEndThatIsNoWholeRow) {
  const Files files;
  for (const Tail& tail : {Tail{"12,22.25", 13, 0},                // whole, without a line feed
                           Tail{"12,22.2", 12, 1},                 // shorter than the row above: digits may be lost
                           Tail{"12,", 12, 1}, Tail{"12", 12, 1},  // fields missing
                           Tail{"END OF FILE\n", 12, 1},           // a footer
                           Tail{"--\nlogger stopped\n", 12, 2}}) {
    TableReader table(files.put("t.csv", twelve_rows() + tail.text));
    (void)table.number_slot(1, "a");
    (void)table.number_slot(2, "b");
    while (table.next()) {
    }
    EXPECT_EQ(table.rows(), tail.rows) << tail.text;
    EXPECT_EQ(test::count_of(table.events(), "trailing_garbage"), tail.events) << tail.text;
  }
}

TEST(Table, ZeroBytesAtTheEndAreLeftOutElsewhereRefused) {
  const Files files;
  const std::string zeros(100000, '\0');
  TableReader table(files.put("t.csv", twelve_rows() + zeros));
  (void)table.number_slot(1, "a");
  while (table.next()) {
  }
  EXPECT_EQ(table.rows(), 12);
  EXPECT_EQ(test::count_of(table.events(), "trailing_garbage"), 1);
  EXPECT_NE(
      refusal([&] { TableReader bad(files.put("b.csv", twelve_rows() + zeros + "12,22.25\n")); }).find("b.csv:13: binary data"),
      std::string::npos);
}

TEST(Table, RefusesWhatIsNoFile) {
  const Files files;
  const auto open = [&](const std::filesystem::path& path) { return refusal([&] { TableReader table(path); }); };
  EXPECT_NE(open(files.path("missing.csv")).find("missing.csv: no such file"), std::string::npos);
  EXPECT_NE(open(files.path("")).find("is a directory"), std::string::npos);
  EXPECT_NE(open(files.put("empty.csv", "")).find("empty.csv: the file is empty"), std::string::npos);
}

TEST(Table, DamagedGzipIsRefusedNotCutShort) {
  const Files files;
  std::string text;
  for (int i = 0; i < 20000; ++i) text += fmt::format("{},{}\n", i, std::sin(i));
  files.put_gzip("t.csv.gz", text);
  const std::string whole = files.get("t.csv.gz");
  const auto read = [&] {
    TableReader table(files.path("cut.csv.gz"));
    (void)table.number_slot(1, "a");
    while (table.next()) {
    }
  };
  files.put("cut.csv.gz", whole.substr(0, whole.size() / 2));
  EXPECT_NE(refusal(read).find("cut.csv.gz: the gzip data are damaged or end early"), std::string::npos);
  std::string flipped = whole;
  flipped[whole.size() / 2] = static_cast<char>(flipped[whole.size() / 2] ^ 0x55);
  files.put("cut.csv.gz", flipped);
  EXPECT_NE(refusal(read), "");
}

std::shared_ptr<const record::Table> in_memory(std::vector<std::vector<double>> columns) {
  return std::make_shared<record::Table>(record::Table{"a frame", {"t", "x"}, std::move(columns)});
}

// What is requested by name or number, row by row; values that are not finite are for the caller, as in a file.
TEST(TableInMemory, IsReadLikeAFile) {
  TableReader table(in_memory({{1.0, 2.0, 3.0}, {0.1, std::numeric_limits<double>::quiet_NaN(), 0.3}}));
  const std::size_t x = table.number_slot("x", "x");
  const std::size_t t = table.number_slot(1, "time");
  EXPECT_EQ(table.expected_rows(), 3U);
  std::vector<double> sums;
  std::vector<bool> finite;
  while (table.next()) {
    sums.push_back(table.number(t) + table.number(x));
    finite.push_back(table.finite());
    EXPECT_EQ(table.line(), static_cast<long>(sums.size()));
  }
  EXPECT_EQ(finite, (std::vector<bool>{true, false, true}));
  EXPECT_EQ(sums[0], 1.1);
  EXPECT_EQ(sums[2], 3.3);
  EXPECT_EQ(table.rows(), 3);
}

TEST(TableInMemory, ThatIsNoneIsRefused) {
  EXPECT_THROW(TableReader(in_memory({{1.0, 2.0}, {1.0}})), InputError);
  EXPECT_THROW(TableReader(in_memory({{}, {}})), InputError);
  TableReader table(in_memory({{1.0}, {1.0}}));
  EXPECT_THROW(static_cast<void>(table.number_slot("y", "y")), InputError);
  EXPECT_THROW(static_cast<void>(table.text_slot("x", "date")), InputError);
}

}  // namespace
}  // namespace coast::io
