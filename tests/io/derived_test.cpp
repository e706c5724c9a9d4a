// Configurations made from others, and what they are known by.

#include "coast/config/derived.hpp"

#include <gtest/gtest.h>

#include "coast/io/yaml.hpp"

namespace coast::config {
namespace {

std::string canonical_text(const Node& root, const std::set<std::string>& without = {}) {
  return canonical(
      root, [](const std::filesystem::path& path) { return "<" + path.filename().string() + ">"; }, without);
}

TEST(Derived, ValuesAreReplacedAddedAndTakenAway) {
  const Node run = io::parse_yaml("imu: {file: imu.csv, error_model: a.yaml}\noutages: [{start_s: 1}]\n", "/tmp/run.yaml");
  const Node sets = io::parse_yaml("sweep: {durations_s: [20, 60]}\n", "plan.yaml");
  const Node other = with(run, {{{"imu", "error_model"}, value_of("/models/b.yaml")},
                                {{"outages"}, sets.at("sweep")},
                                {{"filter", "passes"}, value_of("3")}});
  EXPECT_EQ(other.at("imu").at("file").path(), "/tmp/imu.csv");  // from the folder of the run
  EXPECT_EQ(other.at("imu").at("error_model").path(), "/models/b.yaml");
  EXPECT_EQ(other.at("outages").at("durations_s").numbers(), (std::vector<double>{20.0, 60.0}));
  EXPECT_EQ(other.at("filter").at("passes").integer(), 3);
  EXPECT_EQ(run.at("imu").at("error_model").text(), "a.yaml");
  EXPECT_FALSE(with(run, {{{"outages"}, {}}}).find("outages"));
  EXPECT_THROW(static_cast<void>(with(run, {{{"imu", "file", "name"}, value_of("x")}})), InputError);
}

TEST(Derived, TheSameContentHasTheSameTextWhereverItStands) {
  const Node one = io::parse_yaml("b: [1, 2]  # with a comment\na: {file: data/x.csv}\n", "/here/run.yaml");
  const Node two = io::parse_yaml("a:\n  file: y/../x.csv\n\nb:\n  - 1\n  - 2\n", "/there/other.yaml");
  for (const Node& root : {one, two}) static_cast<void>(root.at("a").at("file").path());
  EXPECT_EQ(canonical_text(one), canonical_text(two));
  EXPECT_EQ(paths_read(one), (std::vector<std::filesystem::path>{"/here/data/x.csv"}));
  EXPECT_NE(canonical_text(one), canonical_text(io::parse_yaml("a: {file: data/x.csv}\nb: [1, 3]\n", "/here/run.yaml")));
  EXPECT_EQ(canonical_text(one, {"a.file"}), canonical_text(two, {"a.file"}));
  EXPECT_EQ(canonical_text(one, {"a"}), canonical_text(io::parse_yaml("b: [1, 2]\n", "x.yaml")));
}

TEST(Derived, ListsAndTextsOfTheSameLettersDiffer) {
  EXPECT_NE(canonical_text(io::parse_yaml("a: [1, 2]\n", "")), canonical_text(io::parse_yaml("a: '[1, 2]'\n", "")));
  EXPECT_NE(canonical_text(io::parse_yaml("a: [[1], 2]\n", "")), canonical_text(io::parse_yaml("a: [1, [2]]\n", "")));
}

}  // namespace
}  // namespace coast::config
