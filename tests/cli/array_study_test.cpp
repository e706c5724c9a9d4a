// coast synth study.yaml: each kind of study in short, its result by schema, the shipped ones read.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "coast/jobs/array_study.hpp"
#include "coast/jobs/file_kind.hpp"
#include "program.hpp"
#include "support/schema.hpp"
#include "support/support.hpp"

namespace coast::cli {
namespace {

using namespace jobs;

namespace fs = std::filesystem;
using nlohmann::json;

/// Runs a study; its part of the result.
json studied(const std::string& yaml) {
  const test::TemporaryDirectory folder;
  write(folder.path() / "study.yaml", "schema: coast.array_study/1\n" + yaml);
  const Outcome outcome = run(fmt::format("synth '{}'", (folder.path() / "study.yaml").string()), folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_TRUE(fs::exists(folder.path() / "study.out" / "report.html"));
  json result = json::parse(text_of(folder.path() / "study.out" / "array_study.json"));
  test::expect_valid("array_study_result", result);
  return result.at(result.at("kind").get<std::string>());
}

TEST(ArrayStudy, OfModelsCountsIntervals) {
  const json result =
      studied("kind: models\nruns: 20\nsamples: 3000\nmodel: {alpha: [0.6], gamma0: 0.1, gamma: [0.1], delta: [0.8]}\n");
  ASSERT_EQ(result["parameters"].size(), 4U);
  // 80 intervals of 95 %: below 80 % has a probability of 1e-7.
  EXPECT_GT(result["pooled_coverage"].get<double>(), 0.8);
}

TEST(ArrayStudy, OfMergesSetsThemBesideTheMeanAndTheOracle) {
  const json result = studied(
      "kind: merges\nruns: 4\nsamples: 6000\norders: [1, 0, 1, 1]\nuse: [2, 3]\nmotion_rms: [0, 1]\nscale_sd: 0.01\nsensors:\n"
      "  - {alpha: [0.6], gamma0: 2.0e-6, gamma: [0.1], delta: [0.85]}\n"
      "  - {alpha: [0.6], gamma0: 8.0e-6, gamma: [0.1], delta: [0.85]}\n"
      "  - {alpha: [0.3], gamma0: 4.0e-6, gamma: [0.1], delta: [0.85]}\n");
  ASSERT_EQ(result["cases"].size(), 4U);
  const auto ratio = [](const json& one, const std::string& name) {
    for (const json& merge : one["merges"])
      if (merge["name"] == name) return merge["ratio_to_mean"].get<double>();
    ADD_FAILURE() << name;
    return 0.0;
  };
  const json& three = result["cases"][2];
  EXPECT_DOUBLE_EQ(ratio(three, "mean"), 1.0);
  EXPECT_LT(ratio(three, "weighted"), 1.0);
  EXPECT_LT(ratio(three, "corrected by errors"), ratio(three, "weighted"));
  // Nothing does better than who knows the truth; what is estimated from 6000 samples comes within a few per cent.
  EXPECT_LE(ratio(three, "oracle"), ratio(three, "corrected by errors") * 1.001);
  EXPECT_LT(ratio(three, "corrected by errors"), 1.1 * ratio(three, "oracle"));
  // Scale errors under motion are no ARMA: models from residuals are further off.
  EXPECT_GT(result["cases"][3]["residual_models"][0]["autocorrelation"].get<double>(),
            three["residual_models"][0]["true_autocorrelation"].get<double>() + 0.05);
}

TEST(ArrayStudy, OfOutagesTakesEveryWayThroughTheFilter) {
  const fs::path parts = fs::path(COAST_SOURCE_DIR) / "reference_runs" / "array-outages";
  const json result =
      studied(fmt::format("kind: outages\nruns: 2\norders: [1, 0, 1, 1]\nscenario: {}\nslow_errors: {}\n"
                          "gyro: [{{alpha: [0.5], gamma0: 2.0e-5}}, {{alpha: [0.5], gamma0: 8.0e-5}}]\n"
                          "accel: [{{alpha: [0.5], gamma0: 1.0e-4}}, {{alpha: [0.5], gamma0: 4.0e-4}}]\n",
                          (parts / "scenario.yaml").string(), (parts / "slow.yaml").string()));
  ASSERT_EQ(result["runs"].size(), 7U);
  for (const json& one : result["runs"]) {
    EXPECT_GT(one["forward"]["horizontal_rms_m"].get<double>(), 0.0);
    EXPECT_LT(one["smoothed"]["horizontal_rms_m"].get<double>(), one["forward"]["horizontal_rms_m"].get<double>());
  }
}

TEST(ArrayStudy, OfDefectsCountsThem) {
  const json result = studied("kind: defects\ninjections: 6\nclean_hours: 0.2\n");
  EXPECT_GE(result["rows"].size(), 6U);
  for (const json& row : result["rows"])
    if (row["kind"] == "stuck") {
      EXPECT_EQ(row["detected"], 1.0);
    }
}

TEST(ArrayStudy, ShippedOnesAndTheExampleAreRead) {
  std::size_t studies = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(COAST_SOURCE_DIR) / "configs" / "studies")) {
    if (!names_schema(entry.path(), "coast.array_study/")) continue;
    test::expect_valid("array_study", test::yaml_as_json(text_of(entry.path())));
    EXPECT_GE(read_array_study(entry.path()).runs, 40U) << entry.path();
    ++studies;
  }
  EXPECT_EQ(studies, 3U);
  EXPECT_EQ(test::yaml_as_json(array_study_example("")), test::schema("array_study").at("examples").at(0));
  const test::TemporaryDirectory folder;
  write(folder.path() / "study.yaml", array_study_example(""));
  EXPECT_EQ(read_array_study(folder.path() / "study.yaml").merges.sensors.size(), 3U);
}

TEST(ArrayStudy, SpoiledOnesSayWhat) {
  const test::TemporaryDirectory folder;
  for (const auto& [yaml, said] :
       {std::pair{"kind: merge\n", "merges"}, std::pair{"kind: merges\nsensors: [{gamma0: 1}]\n", "two or more"},
        std::pair{"kind: models\nmodel: {alpha: [1.2], gamma0: 1}\n", "stationary"},
        std::pair{"kind: defects\ninjection: 3\n", "injections"}}) {
    write(folder.path() / "study.yaml", std::string("schema: coast.array_study/1\n") + yaml);
    const Outcome outcome = run(fmt::format("synth '{}'", (folder.path() / "study.yaml").string()), folder.path());
    EXPECT_EQ(outcome.status, 2) << yaml;
    EXPECT_NE(outcome.error.find(said), std::string::npos) << outcome.error;
  }
}

}  // namespace
}  // namespace coast::cli
