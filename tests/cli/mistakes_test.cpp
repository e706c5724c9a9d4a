// What people do wrong with their files, and what is right but unusual: one small file each in tests/mistakes.
//
//   wrong | right   what was done, in words
//   base            drive: a folder with imu.csv, gnss.pos, error_model.yaml and the shortest run.yaml
//                   rinex: with rover.obs, base.obs, nav.rnx and the shortest ppk.yaml, of rinex-kinematic-2021-265 in
//                   COAST_DATA; skipped without it
//   edit            shell commands there
//   command         what is asked of coast there
//   status          its exit status
//   verdict         in summary.json, where there is one
//   fixed           least number of fixed epochs in ppk.json
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

constexpr const char* kShortestPpk = R"(rover: rover.obs
base: base.obs
nav: [nav.rnx]
base_position: {ecef_m: [-3959400.631, 3385704.533, 3667523.111]}
)";

int shell(const fs::path& folder, const std::string& command) {
  const int status = std::system(fmt::format("cd '{}' && {}", folder.string(), command).c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// RINEX of a car and a base station, unpacked.
fs::path rinex_of(const fs::path& data, const fs::path& folder) {
  fs::path place = folder / "rinex";
  fs::create_directory(place);
  const fs::path from = data / "rinex-kinematic-2021-265";
  EXPECT_EQ(shell(place, fmt::format("gzip -dc '{0}/SEPT265G.21O.gz' >rover.obs && gzip -dc '{0}/3034265G.21O.gz' >base.obs && "
                                     "gzip -dc '{0}/SEPT2650.21P.gz' >nav.rnx",
                                     from.string())),
            0);
  write(place / "ppk.yaml", kShortestPpk);
  return place;
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
  fs::path place;
  if (file.at("base").text() == "rinex") {
    const auto data = test::data_dir();
    if (!data) GTEST_SKIP() << "COAST_DATA is not set";
    place = rinex_of(*data, folder.path());
  } else {
    place = simulated_recording(test::kShortDrive, folder.path());
    write(place / "run.yaml", kShortestRun);
  }
  if (const auto edit = file.find("edit")) {
    write(folder.path() / "edit.sh", edit->text());
    ASSERT_EQ(shell(place, fmt::format("COAST='{}' sh -e '{}'", COAST_PROGRAM, (folder.path() / "edit.sh").string())), 0);
  }
  const int status = shell(place, fmt::format("'{}' {} >../told 2>&1", COAST_PROGRAM, file.at("command").text()));
  const std::string told = text_of(folder.path() / "told");
  EXPECT_EQ(status, file.at("status").integer()) << told;
  for (const std::string& word : words(file, "says")) EXPECT_NE(told.find(word), std::string::npos) << word << "\n" << told;
  for (const std::string& word : words(file, "never")) EXPECT_EQ(told.find(word), std::string::npos) << word << "\n" << told;
  if (const auto fixed = file.find("fixed")) {
    ASSERT_TRUE(fs::exists(place / "out" / "ppk.json")) << told;
    EXPECT_GE(nlohmann::json::parse(text_of(place / "out" / "ppk.json"))["epochs"]["fixed"], fixed->integer()) << told;
  }
  if (const auto verdict = file.find("verdict")) {
    ASSERT_TRUE(fs::exists(place / "out" / "summary.json")) << told;
    const auto summary = nlohmann::json::parse(text_of(place / "out" / "summary.json"));
    EXPECT_EQ(summary["verdict"]["standing"], verdict->text()) << summary["verdict"];
  }
}

INSTANTIATE_TEST_SUITE_P(Files, Mistakes, testing::ValuesIn(all_of_them()), [](const auto& tested) { return tested.param; });

}  // namespace
}  // namespace coast::cli
