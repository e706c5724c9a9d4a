#include "coast/io/yaml.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <random>

#include "coast/record/error.hpp"
#include "support/support.hpp"

namespace coast::io {
namespace {

std::string error_of(const std::string& text) {
  try {
    (void)parse_yaml(text, "run.yaml");
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

TEST(Yaml, ReadsBothStyles) {
  const config::Node root = parse_yaml(
      "imu: {file: a.csv, lever_arm_m: [1, 2, 3]}\n"
      "outages:\n  - {start_s: 1}\n  - start_s: 2.5\n"
      "name: 'a ''b'''\ntext: \"tab\\t\"\n",
      "run.yaml");
  EXPECT_EQ(root.at("imu").at("lever_arm_m").vector3(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(root.at("outages").items()[1].at("start_s").number(), 2.5);
  EXPECT_EQ(root.at("outages").items()[1].at("start_s").where(), "run.yaml:4: outages[1].start_s");
  EXPECT_EQ(root.at("name").text(), "a 'b'");
  EXPECT_EQ(root.at("text").text(), "tab\t");
}

TEST(Yaml, WindowsTextAndByteOrderMark) {
  const config::Node root = parse_yaml(
      "\xEF\xBB\xBF"
      "a: 1\r\nb: x\r\n",
      "run.yaml");
  EXPECT_EQ(root.at("a").integer(), 1);
  EXPECT_EQ(root.at("b").text(), "x");
}

TEST(Yaml, SpoiledTextsNameTheLine) {
  EXPECT_EQ(error_of("a: 1\nb: 2\na: 3\n"),
            "run.yaml:3: the key 'a' for the second time, expected each key once. The first is at line 1.");
  EXPECT_EQ(error_of("imu:\n\tfile: a\n"),
            "run.yaml:2: illegal map value, expected valid YAML. The line is indented with a tab; YAML allows spaces only.");
  EXPECT_EQ(error_of("a: &x [1]\nb: *x\n"),
            "run.yaml:2: an alias ('*name'), expected a value. Aliases are not supported: write the value out.");
  EXPECT_EQ(error_of("a: 1\n---\nb: 2\n"),
            "run.yaml:2: a second document, expected one document. Put it into a file of its own.");
  EXPECT_EQ(error_of("a: !include b.yaml\n"),
            "run.yaml:1: the tag '!include', expected a plain value. Tags are not supported.");
  EXPECT_EQ(error_of("[1, 2]\n"), "run.yaml:1: a list, expected a map of keys at the top of the file");
  EXPECT_EQ(error_of("hello\n"), "run.yaml:1: 'hello', expected keys with values ('key: value')");
  EXPECT_EQ(error_of(", a: 1\n"), "run.yaml:1: text that belongs to no key, expected keys with values ('key: value')");
  EXPECT_EQ(error_of("? [1]\n: 2\n"), "run.yaml:1: a list as a key, expected the name of a key");
  EXPECT_EQ(error_of("a: 1\nb: \x02\n"), "run.yaml:2: the byte 0x02: binary data, expected a YAML text in UTF-8");
  EXPECT_EQ(error_of("a: [1, 2\nb: 3\n").rfind("run.yaml:2: ", 0), 0U);
  EXPECT_NE(error_of("imu: {file: ${COAST_DATA}/a.csv}\n").find("written in quotes"), std::string::npos);
}

TEST(Yaml, EmptyTextsAreSaid) {
  for (const char* text : {"", "\n\n", "# a comment\n", "---\n", "~\n"}) {
    EXPECT_EQ(error_of(text), "run.yaml: the file is empty, expected keys with values ('key: value')") << text;
  }
}

TEST(Yaml, BombsAreRefused) {
  EXPECT_NE(error_of("a: " + std::string(100'000, '[')), "no error");
  std::string nested = "a: ";
  for (int i = 0; i < 70; ++i) nested += "{b: ";
  nested += "1" + std::string(70, '}');
  EXPECT_EQ(error_of(nested), "run.yaml:1: more than 64 levels of nesting, expected a configuration");
  std::string wide;
  for (int i = 0; i < 200'001; ++i) wide += "- 1\n";
  EXPECT_EQ(error_of("a:\n" + wide), "run.yaml:200001: more than 200000 values, expected a configuration");
  std::string laughs = "a0: &a0 [x, x]\n";
  for (int i = 1; i < 30; ++i) laughs += fmt::format("a{0}: &a{0} [*a{1}, *a{1}]\n", i, i - 1);
  EXPECT_EQ(error_of(laughs).rfind("run.yaml:2: an alias", 0), 0U);
}

TEST(Yaml, FilesThatCannotBeRead) {
  const test::TemporaryDirectory folder;
  EXPECT_THROW((void)load_yaml(folder.path() / "missing.yaml"), InputError);
  EXPECT_THROW((void)load_yaml(folder.path()), InputError);
  const auto path = folder.path() / "empty.yaml";
  std::ofstream(path).close();
  EXPECT_THROW((void)load_yaml(path), InputError);
  std::ofstream(folder.path() / "big.yaml") << "a: " << std::string((16U << 20) + 1, 'x');
  EXPECT_THROW((void)load_yaml(folder.path() / "big.yaml"), InputError);
}

TEST(Yaml, RandomBytesGiveAnInputErrorOrATree) {
  std::mt19937 random(5);
  const std::string alphabet = "ab:,-[]{}#&*!|>'\"%@` \n\n  ?~1.\\\t";
  std::uniform_int_distribution<std::size_t> letter(0, alphabet.size() - 1);
  for (int i = 0; i < 20'000; ++i) {
    std::string text;
    for (int j = 0; j < 24; ++j) text += alphabet[letter(random)];
    EXPECT_NO_THROW((void)error_of(text)) << text;  // anything but InputError is a defect
  }
}

TEST(Yaml, ResolvedFileGivesTheSameNumbersFromAnotherFolder) {
  const test::TemporaryDirectory folder;
  std::filesystem::create_directories(folder.path() / "a" / "out");
  std::ofstream(folder.path() / "a" / "run.yaml") << "imu: {file: \"im u.csv\", rate_hz: 100.10, note: \"#: \\\"x\\\"\"}\n"
                                                     "outages: [{start_s: 457000}, {start_s: 457100.25}]\n"
                                                     "quoted: \"null\"\n";
  std::mt19937_64 random(6);
  std::vector<double> defaults;
  while (defaults.size() < 200) {
    const auto value = std::bit_cast<double>(std::uint64_t{random()});
    if (std::isfinite(value)) defaults.push_back(value);
  }
  defaults.push_back(std::numeric_limits<double>::denorm_min());
  defaults.push_back(1e22);

  const auto read = [&](const config::Node& root, double shift) {
    std::vector<std::string> texts = {root.at("imu").at("file").path().string(), root.at("imu").at("note").text(),
                                      root.at("quoted").text()};
    std::vector<double> values = {root.at("imu").at("rate_hz").number()};
    for (const config::Node& outage : root.at("outages").items()) values.push_back(outage.at("start_s").number());
    const config::Node filter = root.section("filter");
    // Another default the second time: it must not be taken.
    for (std::size_t i = 0; i < defaults.size(); ++i)
      values.push_back(filter.number(fmt::format("k{}", i), defaults[i] + shift));
    values.push_back(filter.vector3("v", Eigen::Vector3d(0.1 + shift, 1.0 / 3.0, -1e-300)).sum());
    texts.push_back(filter.text("word", shift == 0.0 ? "- odd: [text" : "other"));
    root.refuse_unasked();
    return std::pair(texts, values);
  };
  const config::Node first = load_yaml(folder.path() / "a" / "run.yaml");
  const auto expected = read(first, 0.0);
  const auto resolved = folder.path() / "a" / "out" / "run.resolved.yaml";
  std::ofstream(resolved) << first.resolved_yaml();
  const config::Node second = load_yaml(resolved);
  EXPECT_EQ(read(second, 1.0), expected);
}

}  // namespace
}  // namespace coast::io
