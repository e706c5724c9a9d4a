// A run knows when it is wrong: `verdict` in summary.json, and the exit status.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "process_result.hpp"
#include "program.hpp"
#include "support/schema.hpp"
#include "support/support.hpp"

namespace coast::cli {
namespace {

namespace fs = std::filesystem;

const fs::path& short_drive() {
  static const test::TemporaryDirectory folder;
  static const fs::path made = simulated_recording(kShortDrive, folder.path());
  return made;
}

struct Mistake {
  const char* name;
  const char* from;
  const char* to;
  int status;
  const char* words;  ///< in what is told; empty: none are asked for
};

class OneMistake : public testing::TestWithParam<Mistake> {};

TEST_P(OneMistake, IsToldByStatusAndWords) {
  const test::TemporaryDirectory folder;
  const Mistake& mistake = GetParam();
  std::string yaml = text_of(short_drive() / "run.yaml");
  const auto at = yaml.find(mistake.from);
  ASSERT_NE(at, std::string::npos) << yaml;
  yaml.replace(at, std::string(mistake.from).size(), mistake.to);
  const fs::path file = short_drive() / fmt::format("{}.yaml", mistake.name);
  write(file, yaml);
  const Outcome outcome =
      run(fmt::format("process '{}' --out '{}'", file.string(), (folder.path() / "out").string()), folder.path());
  EXPECT_EQ(outcome.status, mistake.status) << outcome.error;
  const std::string told = outcome.error + text_of(folder.path() / "stdout.txt");
  EXPECT_NE(told.find(mistake.words), std::string::npos) << told;
  if (fs::exists(folder.path() / "out" / "summary.json")) {
    const auto summary = nlohmann::json::parse(text_of(folder.path() / "out" / "summary.json"));
    EXPECT_EQ(summary["verdict"]["standing"] == "unusable", mistake.status == 3) << summary["verdict"];
  }
}

INSTANTIATE_TEST_SUITE_P(
    Mistakes, OneMistake,
    testing::Values(Mistake{"none", "schema", "schema", 0, "verdict: good"},
                    Mistake{"z_up", "axes: [x, y, z]", "axes: [x, -y, -z]", 3, "axes: ["},
                    Mistake{"arm_signs", "lever_arm_m: [0.29999999999999999, -0.20000000000000001, -1.1000000000000001]",
                            "lever_arm_m: [-0.3, 0.2, 1.1]", 0, "The recording shows the antenna at ("},
                    Mistake{"arm_millimetres", "lever_arm_m: [0.29999999999999999, -0.20000000000000001, -1.1000000000000001]",
                            "lever_arm_m: [300, -200, -1100]", 2, "millimetres"}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST(Verdict, IsThatOfTheWorstCheck) {
  const Check good{"a", 0.1, 1.0, 2.0, "a is fine"};
  const Check doubtful{"b", 1.5, 1.0, 2.0, "b is large"};
  const Check without_bound{"c", 1e9, 1.0, {}, "c is huge"};
  const Check not_a_number{"d", std::nan(""), 1.0, 2.0, "d is nothing"};
  EXPECT_EQ(good.standing(), Standing::kGood);
  EXPECT_EQ(doubtful.standing(), Standing::kDoubtful);
  EXPECT_EQ(without_bound.standing(), Standing::kDoubtful);
  EXPECT_EQ(not_a_number.standing(), Standing::kUnusable);
  const Judgement judgement{{good, doubtful}, "a cable"};
  EXPECT_EQ(judgement.standing(), Standing::kDoubtful);
  EXPECT_EQ(judgement.line(), "verdict: doubtful: b is large. Most likely cause: a cable");
}

}  // namespace
}  // namespace coast::cli
