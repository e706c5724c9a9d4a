// `coast calibrate` with a study of the estimators: files, exit status, messages.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "coast/jobs/file_kind.hpp"
#include "coast/record/error.hpp"
#include "estimator_study/result.hpp"
#include "support/schema.hpp"
#include "support/support.hpp"

namespace coast::cli {
namespace {

using namespace jobs;

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kStudy = R"(schema: coast.estimator_study/1
title: a small study
signal_unit: deg/s
truth:
  processes: [{process: white_noise, density: 0.09}, {process: gauss_markov, beta: 0.05, sigma2: 0.25}]
  slope: 1e-3
interval_s: 1
samples: 400
runs: 3
estimators:
  - {name: default, kind: default, intervals: true}
  - name: EM
    kind: em
    iterations: 5
    start: [{process: white_noise, density: 0.5}, {process: gauss_markov, beta: 0.1, sigma2: 0.1}]
  - {kind: wavelet_moments, sum: [white_noise, random_walk], mean: level}
choices: [{sum: [white_noise]}, {sum: [white_noise, gauss_markov]}]
restitution: {estimator: EM, runs: 2, realisations: 3}
readings:
  - name: Table I
    processes: [{process: white_noise, density: 0.09}, {process: gauss_markov, beta: 0.05, sigma2: 0.25, first_order: table1}]
)";

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

int status_of(const fs::path& study, const fs::path& out, const fs::path& log) {
  const std::string command = fmt::format("'{}' calibrate '{}' --out '{}' --threads 2 >/dev/null 2>'{}'", COAST_PROGRAM,
                                          study.string(), out.string(), log.string());
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

fs::path written(const test::TemporaryDirectory& folder, const std::string& text) {
  fs::path file = folder.path() / "study.yaml";
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

std::string with(const std::string& from, const std::string& to) {
  std::string text = kStudy;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(EstimatorStudyCommand, WritesWhatItsSchemaSays) {
  const test::TemporaryDirectory folder;
  const fs::path out = folder.path() / "out";
  const fs::path log = folder.path() / "stderr.txt";
  ASSERT_EQ(status_of(written(folder, kStudy), out, log), 0) << text_of(log);
  const json result = json::parse(text_of(out / "estimator_study.json"));
  test::expect_valid("estimator_study_result", result);
  ASSERT_EQ(result.at("estimators").size(), 3U);
  const json& first = result.at("estimators").at(0);
  EXPECT_EQ(first.at("parameters").size(), 5U);  // of the processes, level, slope
  EXPECT_EQ(first.at("parameters").at(1).at("name"), "gauss_markov beta");
  EXPECT_EQ(first.at("parameters").at(0).at("unit"), "(deg/s)^2/Hz");
  EXPECT_NEAR(first.at("parameters").at(1).at("truth").get<double>(), 0.05, 1e-15);
  EXPECT_EQ(first.at("pooled_coverage").at("intervals"), 9);
  EXPECT_EQ(first.at("by_run").at("values").at("slope").size(), 3U);
  EXPECT_EQ(result.at("estimators").at(1).at("mean_iterations"), 5.0);
  EXPECT_FALSE(result.at("estimators").at(2).at("parameters").at(1).contains("truth"));  // a random walk that is not there
  EXPECT_EQ(result.at("choices").at(0).at("runs").get<int>() + result.at("choices").at(1).at("runs").get<int>(), 3);
  EXPECT_EQ(result.at("readings").at(0).at("name"), "Table I");
  test::expect_valid("page", json::parse(text_of(out / "report.json")));
  const std::string page = text_of(out / "report.html");
  for (const char* panel : {"estimates", "coverage", "way", "restitution", "reading-allan"})
    EXPECT_NE(page.find(fmt::format("\"id\":\"{}\"", panel)), std::string::npos) << panel;
}

TEST(EstimatorStudyCommand, NamesLineOfWhatIsWrong) {
  const test::TemporaryDirectory folder;
  const fs::path log = folder.path() / "stderr.txt";
  struct SpoiledEstimatorStudy {
    const char* from;
    const char* to;
    int line;
  };
  for (const SpoiledEstimatorStudy& s : {SpoiledEstimatorStudy{"samples: 400", "samples: 40", 8},
                                         {"runs: 3", "rums: 3", 1},
                                         {"density: 0.09", "density: -1", 5},
                                         {"beta: 0.05,", "", 5},
                                         {"kind: em", "kind: emm", 13},
                                         {"estimator: EM", "estimator: ME", 18},
                                         {"  - {kind: wavelet_moments", "  - {kind: wavelet_moments, name: EM", 16},
                                         {"sum: [white_noise]}", "sum: [pink_noise]}", 17},
                                         {"interval_s: 1", "interval_s: 0", 7},
                                         {"title: a", "titel: a", 2}}) {
    const fs::path study = written(folder, with(s.from, s.to));
    EXPECT_EQ(status_of(study, folder.path() / "out", log), 2) << s.to;
    EXPECT_NE(text_of(log).find(fmt::format("study.yaml:{}", s.line)), std::string::npos) << s.to << ": " << text_of(log);
  }
}

TEST(EstimatorStudyConfig, TakesAutoregressionsByTheirCoefficients) {
  const test::TemporaryDirectory folder;
  const auto study = [&](const char* coefficients) {
    return read_estimator_study(
               written(folder,
                       with("{process: gauss_markov, beta: 0.05, sigma2: 0.25}]\n  slope",
                            fmt::format("{{process: ar, coefficients: {}, innovation2: 0.01}}]\n  slope", coefficients))))
        .study;
  };
  const noise::EstimatorStudy two = study("[1.8, -0.9]");
  ASSERT_EQ(two.truth.u.size(), 4U);
  EXPECT_NEAR(two.truth.model.values(two.truth.u).at(1), 1.8 / 1.9, 1e-14);  // rho(1) = a1/(1 - a2)
  EXPECT_NEAR(two.truth.model.values(two.truth.u).at(2), -0.9, 1e-14);
  EXPECT_EQ(study("[0.5, 0.1, 0.1]").truth.u.size(), 5U);
  EXPECT_THROW(study("[1.0, 0.5]"), InputError);
  EXPECT_THROW(study("[]"), InputError);
}

TEST(EstimatorStudyConfig, FirstOrderFormsBecomeTheExactProcesses) {
  const test::TemporaryDirectory folder;
  const EstimatorStudyConfig config = read_estimator_study(written(folder, kStudy));
  const std::vector<double> values = config.readings.at(0).truth.model.values(config.readings.at(0).truth.u);
  // x' = (1 - beta dt) x + dt w: phi and the stationary variance q/(1 - phi^2) as they are.
  EXPECT_NEAR(std::exp(-values[1]), 0.95, 1e-14);
  EXPECT_NEAR(values[2], 2.0 * 0.05 * 0.25 / (1.0 - 0.95 * 0.95), 1e-14);
}

TEST(EstimatorStudyConfig, ShippedStudiesAndTheExampleAreRead) {
  std::size_t studies = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(COAST_SOURCE_DIR) / "configs" / "studies")) {
    if (!names_schema(entry.path(), "coast.estimator_study/")) continue;
    EXPECT_GE(read_estimator_study(entry.path()).study.runs, 24U) << entry.path();
    ++studies;
  }
  EXPECT_EQ(studies, 4U);
  const std::string example = estimator_study_example("");
  EXPECT_EQ(test::yaml_as_json(example), test::schema("estimator_study").at("examples").at(0));
  const test::TemporaryDirectory folder;
  EXPECT_EQ(read_estimator_study(written(folder, example)).study.choices.size(), 2U);
}

}  // namespace
}  // namespace coast::cli
