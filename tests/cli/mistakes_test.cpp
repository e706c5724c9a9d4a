// What people do wrong with their files, and what is right but unusual: one small file each in tests/mistakes.
//
//   wrong | right   what was done, in words
//   edit            shell commands in a folder with imu.csv, gnss.pos, error_model.yaml and the shortest run.yaml
//   command         what is asked of coast there
//   status          its exit status
//   verdict         in summary.json, where there is one
//   says, never     words that the terminal has to show, and that would be wrong advice

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "coast/io/yaml.hpp"
#include "program.hpp"
#include "support/support.hpp"

namespace coast::cli {
namespace {

namespace fs = std::filesystem;

fs::path folder_of_mistakes() {
  return fs::path(COAST_SOURCE_DIR) / "tests" / "mistakes";
}

std::vector<std::string> all_of_them() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder_of_mistakes())) names.push_back(entry.path().stem().string());
  std::ranges::sort(names);
  return names;
}

constexpr const char* kShortestRun = R"(imu:
  file: imu.csv
  format: csv
  gps_week: 2374
  axes: [x, y, z]
  error_model: error_model.yaml
  lever_arm_m: [0.3, -0.2, -1.1]
gnss: {file: gnss.pos}
)";

int shell(const fs::path& folder, const std::string& command) {
  const int status = std::system(fmt::format("cd '{}' && {}", folder.string(), command).c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::vector<std::string> words(const config::Node& file, const char* key) {
  std::vector<std::string> all;
  if (const auto list = file.find(key))
    for (const config::Node& item : list->items()) all.push_back(item.text());
  return all;
}

class Mistakes : public testing::TestWithParam<std::string> {};

TEST_P(Mistakes, AreAnsweredAsTheirFileSays) {
  const config::Node file = io::load_yaml(folder_of_mistakes() / (GetParam() + ".yaml"));
  const test::TemporaryDirectory folder;
  const fs::path place = simulated_recording(kShortDrive, folder.path());
  write(place / "run.yaml", kShortestRun);
  if (const auto edit = file.find("edit")) {
    write(folder.path() / "edit.sh", edit->text());
    ASSERT_EQ(shell(place, fmt::format("COAST='{}' sh -e '{}'", COAST_PROGRAM, (folder.path() / "edit.sh").string())), 0);
  }
  const int status = shell(place, fmt::format("'{}' {} >../told 2>&1", COAST_PROGRAM, file.at("command").text()));
  const std::string told = text_of(folder.path() / "told");
  EXPECT_EQ(status, file.at("status").integer()) << told;
  for (const std::string& word : words(file, "says")) EXPECT_NE(told.find(word), std::string::npos) << word << "\n" << told;
  for (const std::string& word : words(file, "never")) EXPECT_EQ(told.find(word), std::string::npos) << word << "\n" << told;
  if (const auto verdict = file.find("verdict")) {
    ASSERT_TRUE(fs::exists(place / "out" / "summary.json")) << told;
    const auto summary = nlohmann::json::parse(text_of(place / "out" / "summary.json"));
    EXPECT_EQ(summary["verdict"]["standing"], verdict->text()) << summary["verdict"];
  }
}

INSTANTIATE_TEST_SUITE_P(Files, Mistakes, testing::ValuesIn(all_of_them()), [](const auto& tested) { return tested.param; });

}  // namespace
}  // namespace coast::cli
