// Files that expand without end, or have no end of a line.

#include "coast/io/input.hpp"

#include <gtest/gtest.h>

#include <string>

#include "coast/record/error.hpp"
#include "files.hpp"

namespace coast::io {
namespace {

using test::Files;
using test::refusal;

TEST(Input, GzipThatExpandsWithoutEndIsRefusedEarly) {
  const Files files;
  const auto bomb = files.put_gzip("bomb.gz", std::string(std::size_t{200} << 20, 'a'));
  const std::string all = refusal([&] { static_cast<void>(read_all(bomb)); });
  EXPECT_NE(all.find("expand to more than"), std::string::npos) << all;
  // It is seen at 64 MiB, and not at its end.
  ByteSource source(bomb);
  std::string block(std::size_t{1} << 20, '\0');
  std::size_t given = 0;
  static_cast<void>(refusal([&] {
    while (const std::size_t n = source.read(block.data(), block.size())) given += n;
  }));
  EXPECT_LE(given, std::size_t{65} << 20);
  LineReader lines(bomb);
  std::string_view line;
  const std::string endless = refusal([&] { static_cast<void>(lines.next(line)); });
  EXPECT_NE(endless.find("a line of more than 1 MiB"), std::string::npos) << endless;
}

TEST(Input, ATextThatCompressesWellIsRead) {
  const Files files;
  std::string table;
  for (int i = 0; table.size() < (std::size_t{80} << 20); ++i) table += std::to_string(i) + ",0,0,0,0,0,-9.8\n";
  EXPECT_EQ(read_all(files.put_gzip("table.gz", table)).size(), table.size());
}

TEST(Input, ALimitOfSizeIsHeeded) {
  const Files files;
  const std::string text(std::size_t{3} << 20, 'a');
  for (const auto& file : {files.put("plain", text), files.put_gzip("packed", text)}) {
    EXPECT_EQ(read_all(file, text.size()).size(), text.size());
    const std::string said = refusal([&] { static_cast<void>(read_all(file, std::size_t{2} << 20)); });
    EXPECT_NE(said.find("more than 2 MiB"), std::string::npos) << said;
  }
}

TEST(Input, ZerosFromTheFirstByteAreRefusedAtOnce) {
  const Files files;
  const auto zeros = files.put_gzip("zeros.gz", std::string(std::size_t{100} << 20, '\0'));
  const std::string said = refusal([&] { const LineReader lines(zeros); });
  EXPECT_NE(said.find("binary data (a zero byte)"), std::string::npos) << said;
}

}  // namespace
}  // namespace coast::io
