// `coast calibrate` as a user runs it, on a sensor that is known and on recordings of real ones.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "calibrate/units.hpp"
#include "coast/jobs/calibrate.hpp"
#include "program.hpp"
#include "support/schema.hpp"
#include "support/support.hpp"

namespace coast::cli {
namespace {

using namespace jobs;

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double kRate = 100.0;          // Hz
constexpr double kGyroDensity = 3e-5;    // rad/s/sqrt(Hz)
constexpr double kGyroWalk = 2e-5;       // rad/s/sqrt(s)
constexpr double kAccelDensity = 6e-4;   // m/s^2/sqrt(Hz)
constexpr std::size_t kHole = 3000;      // the first of seven samples that are missing
constexpr std::size_t kSamples = 12000;  // two minutes

/// White noise and, of gyros, a random walk about a level, written as the default CSV without a GPS week.
std::string simulated_csv(std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  std::string text = "time_s,gyro_x_radps,gyro_y_radps,gyro_z_radps,accel_x_mps2,accel_y_mps2,accel_z_mps2\n";
  std::array<double, 3> walk{1e-3, -2e-3, 5e-4};
  for (std::size_t k = 0; k < kSamples; ++k) {
    std::string row = fmt::format("{:.2f}", static_cast<double>(k + 1) / kRate);
    for (double& rate : walk) {
      row += fmt::format(",{:.12g}", rate + kGyroDensity * std::sqrt(kRate) * normal(generator));
      rate += kGyroWalk / std::sqrt(kRate) * normal(generator);
    }
    for (const double level : {0.05, -0.1, -9.81})
      row += fmt::format(",{:.12g}", level + kAccelDensity * std::sqrt(kRate) * normal(generator));
    if (k < kHole || k >= kHole + 7) text += row + "\n";
  }
  return text;
}

json calibrated(const fs::path& out) {
  json result = json::parse(text_of(out / "calibration.json"));
  test::expect_valid("calibration", result, out.string());
  test::expect_valid("page", json::parse(text_of(out / "report.json")));
  test::expect_valid("imu_error_model", test::load_yaml_as_json(out / "error_model.yaml"));
  EXPECT_GT(fs::file_size(out / "report.html"), 100000U);
  return result;
}

/// The estimate of a parameter is within four of its standard deviations (once in 16 thousand, by the Cramer-Rao bound).
void expect_estimate(const json& axis, const std::string& name, double truth) {
  const auto found = std::ranges::find_if(axis["parameters"], [&](const json& p) { return p["name"] == name; });
  ASSERT_NE(found, axis["parameters"].end()) << name << " not in " << axis["model"];
  const double sd = (*found)["cramer_rao_relative_sd"].get<double>();
  EXPECT_LT(sd, 0.35) << name;
  EXPECT_LT(std::abs(std::log((*found)["value"].get<double>() / truth)), 4.0 * sd) << axis["sensor"] << axis["axis"] << name;
}

/// A simulated sensor, calibrated once for the tests of this file.
const fs::path& simulated() {
  static const test::TemporaryDirectory folder;
  static const fs::path made = [] {
    write(folder.path() / "one.csv", simulated_csv(5));
    write(folder.path() / "two.csv", simulated_csv(6));
    write(folder.path() / "three.csv", simulated_csv(7));
    write(folder.path() / "calibration.yaml",
          "schema: coast.calibration_run/1\nsensor: two runs of it\nmost_gauss_markov: 0\nrealisations: 40\n"
          "records:\n  - {file: one.csv}\n  - {file: two.csv}\ntested_on:\n  - {file: three.csv}\n"
          "turn_on_bias: {accel: {sigma: 3, unit: mg}}\n");
    const Outcome outcome = run(fmt::format("calibrate '{}' --out '{}'", (folder.path() / "calibration.yaml").string(),
                                            (folder.path() / "out").string()),
                                folder.path());
    EXPECT_EQ(outcome.status, 0) << outcome.error;
    EXPECT_NE(outcome.error.find("1 hole of 8 intervals"), std::string::npos) << outcome.error;
    for (const char* stage : {" s: reading", " s: estimating", " s: writing"})
      EXPECT_NE(outcome.error.find(stage), std::string::npos) << outcome.error;
    return folder.path();
  }();
  return made;
}

TEST(Calibrate, FindsTheSensorThatWasSimulated) {
  const json result = calibrated(simulated() / "out");
  EXPECT_NEAR(result["rate_hz"].get<double>(), kRate, 1e-6);
  ASSERT_EQ(result["records"].size(), 2U);
  ASSERT_EQ(result["tested_on"].size(), 1U);
  EXPECT_EQ(result["records"][0]["holes"], 1);
  // Seven samples are missing, and the one behind them, which carried the bridge, is left out.
  EXPECT_EQ(result["records"][0]["samples"], kSamples - 8);
  ASSERT_EQ(result["axes"].size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    const json& axis = result["axes"][i];
    EXPECT_EQ(axis["sensor"], i < 3 ? "gyro" : "accel");
    EXPECT_EQ(axis["model"], i < 3 ? "WN + RW + level" : "WN + level") << i;
    expect_estimate(axis, "white_noise density", i < 3 ? kGyroDensity * kGyroDensity : kAccelDensity * kAccelDensity);
    if (i < 3) expect_estimate(axis, "random_walk density2", kGyroWalk * kGyroWalk);
    EXPECT_EQ(axis["records_alone"].size(), 2U);
    EXPECT_GT(axis["common_parameters_p_value"].get<double>(), 1e-4);  // they have one set of parameters
    EXPECT_EQ(axis["allan"].size(), 2U);
    EXPECT_EQ(std::ranges::count_if(axis["candidates"], [](const json& c) { return c["chosen"].get<bool>(); }), 1);
  }
  // 0.5 % of a standard deviation by 24 thousand samples; in the unit of data sheets.
  const json& sheet = result["axes"][3]["parameters"][0]["data_sheet"];
  EXPECT_EQ(sheet["unit"], "m/s/sqrt(h)");
  EXPECT_NEAR(sheet["value"].get<double>(), kAccelDensity * 60.0, 0.02 * kAccelDensity * 60.0);
}

// The third record is of the same sensor: the mean of 12 thousand squared normals is 1 within 0.013, and the estimate from
// twice as many adds 0.009; five of both together.
TEST(Calibrate, HoldsTheEstimateAgainstAnotherRecord) {
  const json result = calibrated(simulated() / "out");
  for (const json& axis : result["axes"]) {
    ASSERT_EQ(axis["tests"].size(), 1U);
    const json& test = axis["tests"][0];
    EXPECT_NE(test["source"].get<std::string>().find("three.csv"), std::string::npos);
    EXPECT_NEAR(test["innovation_variance"].get<double>(), 1.0, 5.0 * 0.016);
    EXPECT_GT(test["innovations"]["p_value"].get<double>(), 1e-5);
    EXPECT_NEAR(test["log_likelihood_per_sample"].get<double>(),
                axis["log_likelihood"].get<double>() / axis["samples"].get<double>(), 5.0 * 0.016);
    EXPECT_EQ(test["allan_band"]["tau_s"].size(), test["allan"]["tau_s"].size());
  }
}

TEST(Calibrate, ErrorModelSaysWhereItsValuesComeFrom) {
  static_cast<void>(simulated());
  const std::string text = text_of(simulated() / "out" / "error_model.yaml");
  const json model = test::yaml_as_json(text);
  EXPECT_EQ(model["sensor"], "two runs of it");
  EXPECT_EQ(model["gyro"]["x"].size(), 3U);  // white noise, random walk, turn-on bias
  EXPECT_NEAR(model["accel"]["y"][1]["sigma"].get<double>(), 3e-3 * 9.80665, 1e-12);
  EXPECT_NE(text.find("turn-on bias: stated in the calibration file"), std::string::npos);
  EXPECT_NE(text.find("turn-on bias: root mean square of the levels"), std::string::npos);
  // Levels of 1, -2 and 0.5 mrad/s and walks of 2e-5 sqrt(120) about them: 1.3 mrad/s.
  EXPECT_NEAR(model["gyro"]["z"][2]["sigma"].get<double>(), std::sqrt((1.0 + 4.0 + 0.25) / 3.0) * 1e-3, 4e-4);
  EXPECT_NE(text.find("# WN density"), std::string::npos);
}

TEST(Calibrate, ProcessReadsTheErrorModelAsItIs) {
  const test::TemporaryDirectory folder;
  write(folder.path() / "scenario.yaml", R"(
schema: coast.scenario/1
trajectory: {kind: car_roundabout, duration_s: 340, static_s: 30, origin_deg_m: [46.52, 6.57, 400], course_deg: 30}
imu: {rate_hz: 100, error_model: model.yaml, lever_arm_m: [0.3, -0.2, -1.1]}
gnss: {rate_hz: 5, sd_m: [0.01, 0.01, 0.02]}
start_gps: {week: 2374, sow: 208800}
seed: 4
)");
  fs::copy_file(simulated() / "out" / "error_model.yaml", folder.path() / "model.yaml");
  const std::string here = folder.path().string();
  const Outcome simulation = run(fmt::format("simulate '{}/scenario.yaml' --out '{}/rec'", here, here), folder.path());
  ASSERT_EQ(simulation.status, 0) << simulation.error;
  fs::copy_file(folder.path() / "model.yaml", folder.path() / "rec" / "error_model.yaml", fs::copy_options::overwrite_existing);
  const Outcome processed = run(fmt::format("process '{}/rec/run.yaml' --out '{}/out'", here, here), folder.path());
  EXPECT_EQ(processed.status, 0) << processed.error;
}

TEST(Calibrate, TwoRunsWriteTheSameBytes) {
  const test::TemporaryDirectory folder;
  write(folder.path() / "one.csv", simulated_csv(5));
  write(folder.path() / "calibration.yaml",
        "schema: coast.calibration_run/1\naxes: [gyro_x, accel_x]\nrealisations: 0\nrecords:\n  - {file: one.csv}\n"
        "processes: {gyro: {sum: [white_noise]}, accel: {sum: [white_noise]}}\n");
  for (const char* out : {"first", "second"}) {
    const Outcome outcome = run(
        fmt::format("calibrate '{}' --out '{}'", (folder.path() / "calibration.yaml").string(), (folder.path() / out).string()),
        folder.path());
    ASSERT_EQ(outcome.status, 0) << outcome.error;
  }
  for (const char* file : {"calibration.json", "error_model.yaml", "report.json"})
    EXPECT_EQ(text_of(folder.path() / "first" / file), text_of(folder.path() / "second" / file)) << file;
}

TEST(Calibrate, ReportIsMadeAgainFromStoredResults) {
  const test::TemporaryDirectory folder;
  fs::copy_file(simulated() / "out" / "report.json", folder.path() / "report.json");
  EXPECT_EQ(run(fmt::format("report '{}'", folder.path().string()), folder.path()).status, 0);
  EXPECT_EQ(text_of(folder.path() / "report.html"), text_of(simulated() / "out" / "report.html"));
}

TEST(Calibrate, TakesAnImuFileAloneAndSaysWhatIsDefault) {
  const test::TemporaryDirectory folder;
  std::string text = simulated_csv(7);
  text.resize(text.find("\n5.00,") + 1);  // 5 s
  write(folder.path() / "imu.csv", text);
  const Outcome outcome = run(fmt::format("calibrate '{}'", (folder.path() / "imu.csv").string()), folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  const json result = calibrated(folder.path() / "imu.out");
  EXPECT_GE(result["axes"][0]["candidates"].size(), 4U);  // it went at least one step from white noise
  EXPECT_NE(text_of(folder.path() / "imu.out" / "error_model.yaml").find("default, 20 mg"), std::string::npos);
  const std::string shown = text_of(folder.path() / "stdout.txt");
  EXPECT_NE(shown.find("Gyro x: WN"), std::string::npos) << shown;
  EXPECT_NE(shown.find("deg/sqrt(h)"), std::string::npos) << shown;
}

TEST(Calibrate, TooShortARecordFailsByItsNumbers) {
  const test::TemporaryDirectory folder;
  std::string text = simulated_csv(7);
  text.resize(text.find("\n0.90,") + 1);
  write(folder.path() / "imu.csv", text);
  const Outcome outcome = run(fmt::format("calibrate '{}'", (folder.path() / "imu.csv").string()), folder.path());
  EXPECT_EQ(outcome.status, 3) << outcome.error;
  EXPECT_NE(outcome.error.find("too few samples"), std::string::npos) << outcome.error;
  EXPECT_FALSE(fs::exists(folder.path() / "imu.out" / "calibration.json"));
}

TEST(Calibrate, ExampleOfTheHelpPageIsThatOfTheSchema) {
  EXPECT_EQ(test::yaml_as_json(calibration_example("")), test::schema("calibration_run").at("examples").at(0));
  const test::TemporaryDirectory folder;
  EXPECT_EQ(run("calibrate --help", folder.path()).status, 0);
  EXPECT_NE(text_of(folder.path() / "stdout.txt").find(calibration_example("  ")), std::string::npos);
}

// --- configuration

struct SpoiledCalibration {
  const char* what;
  const char* from;  ///< replaced in the example of the help page
  const char* to;
  const char* message;  ///< must be part of standard error
};
class SpoiledCalibrations : public testing::TestWithParam<SpoiledCalibration> {};

TEST_P(SpoiledCalibrations, EndWithStatusTwoAndNameTheLine) {
  const test::TemporaryDirectory folder;
  std::string text = calibration_example("");
  const auto at = text.find(GetParam().from);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, std::string(GetParam().from).size(), GetParam().to);
  write(folder.path() / "spoiled.yaml", text);
  const Outcome outcome = run(fmt::format("calibrate '{}'", (folder.path() / "spoiled.yaml").string()), folder.path());
  EXPECT_EQ(outcome.status, 2) << outcome.error;
  EXPECT_NE(outcome.error.find("spoiled.yaml:"), std::string::npos) << outcome.error;
  EXPECT_NE(outcome.error.find(GetParam().message), std::string::npos) << outcome.error;
}

INSTANTIATE_TEST_SUITE_P(
    Commands, SpoiledCalibrations,
    testing::Values(SpoiledCalibration{"an unknown key", "turn_on_bias:", "turn_on_bais:", "turn_on_bias"},
                    SpoiledCalibration{"an unknown key of a record", "from_s:", "form_s:", "from_s"},
                    SpoiledCalibration{"no records", "records:", "record:", "records"},
                    SpoiledCalibration{"a part that ends before it begins", "from_s: 60", "from_s: 60, to_s: 50",
                                       "after from_s"},
                    SpoiledCalibration{"a process that does not exist", "[white_noise, ", "[wite_noise, ", "white_noise"},
                    SpoiledCalibration{"an empty sum", "[white_noise, gauss_markov, random_walk]", "[]", "empty list"},
                    SpoiledCalibration{"a unit of the other sensor", "unit: deg/s}}", "unit: mg}}", "deg/s"},
                    SpoiledCalibration{"a criterion that does not exist", "processes:", "criterion: aic\nprocesses:", "aicc"},
                    SpoiledCalibration{"an axis that does not exist", "processes:", "axes: [gyro_w]\nprocesses:", "gyro_"},
                    SpoiledCalibration{"too many processes", "processes:", "most_gauss_markov: 7\nprocesses:", "from 0 to 6"},
                    SpoiledCalibration{"another schema", "coast.calibration_run/1", "coast.run/1", "coast.calibration_run/1"}),
    [](const testing::TestParamInfo<SpoiledCalibration>& spoiled) { return fmt::format("n{}", spoiled.index); });

TEST(CalibrationUnits, ParametersReadAsDataSheetsStateThem) {
  const noise::SumModel model({&noise::estimable("white_noise"), &noise::estimable("gauss_markov"),
                               &noise::estimable("gauss_markov"), &noise::estimable("random_walk")},
                              noise::Mean::kLevel);
  const auto sheet = [&](std::size_t i, noise::Sensor sensor, double value, std::optional<double> lower = {}) {
    noise::ParameterEstimate estimate;
    estimate.value = value;
    estimate.lower = lower;
    estimate.relative_bound = 0.2;
    return sheet_value(model, i, sensor, estimate);
  };
  constexpr double kDegree = 3.14159265358979323846 / 180.0;
  const double arw = 0.1 * kDegree / 60.0;  // 0.1 deg/sqrt(h)
  const SheetValue density = sheet(0, noise::Sensor::kGyro, arw * arw, 0.81 * arw * arw);
  EXPECT_EQ(density.name, "WN density");
  EXPECT_EQ(density.unit, "deg/sqrt(h)");
  EXPECT_NEAR(density.value, 0.1, 1e-14);
  EXPECT_NEAR(*density.lower, 0.09, 1e-14);
  EXPECT_FALSE(density.upper);
  EXPECT_NEAR(density.relative_bound, 0.1, 1e-15);  // of a square root
  const SheetValue time = sheet(3, noise::Sensor::kGyro, 0.01, 0.005);
  EXPECT_EQ(time.name, "GM 2 correlation time");
  EXPECT_NEAR(time.value, 100.0, 1e-12);
  EXPECT_NEAR(*time.upper, 200.0, 1e-12);  // the slowest rate is the longest time
  EXPECT_FALSE(time.lower);
  const SheetValue sigma = sheet(2, noise::Sensor::kAccel, 1e-10 * 9.80665 * 9.80665);
  EXPECT_EQ(sigma.name, "GM 1 sigma");
  EXPECT_EQ(sigma.unit, "ug");
  EXPECT_NEAR(sigma.value, 10.0, 1e-12);
  EXPECT_EQ(si_unit_of("signal^2/Hz", noise::Sensor::kAccel), "(m/s^2)^2/Hz");
}

// --- real recordings

std::vector<fs::path> shipped() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(COAST_SOURCE_DIR) / "configs" / "calibrations"))
    files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

/// A shipped file with its first seconds and other options alone.
void shorten(const fs::path& from, const fs::path& to, const std::string& seconds, const std::string& options) {
  std::string text = text_of(from);
  const std::string mark = "    format:";
  ASSERT_NE(text.find(mark), std::string::npos) << from;
  const std::string part = fmt::format("    to_s: {}\n", seconds);
  for (auto at = text.find(mark); at != std::string::npos; at = text.find(mark, at + part.size() + mark.size()))
    text.insert(at, part);
  write(to, text + options);
}

TEST(Calibrate, EveryShippedCalibrationRunsInShort) {
  if (!test::data_dir()) GTEST_SKIP() << "COAST_DATA is not set: the real recordings are not at hand";
  const test::TemporaryDirectory folder;
  ASSERT_EQ(shipped().size(), 6U);
  for (const fs::path& file : shipped()) {
    const fs::path config = folder.path() / file.filename();
    shorten(file, config, "20", "processes: {gyro: {sum: [white_noise]}, accel: {sum: [white_noise]}}\nrealisations: 0\n");
    const fs::path out = folder.path() / file.stem();
    const Outcome outcome = run(fmt::format("calibrate '{}' --out '{}'", config.string(), out.string()), folder.path());
    ASSERT_EQ(outcome.status, 0) << file << outcome.error;
    EXPECT_EQ(calibrated(out)["axes"].size(), 6U) << file;
  }
}

// The README beside the data: Allan deviation of gyro x 0.0409 deg/s at 1 s, other runs within a few per cent; 2.4 deg/sqrt(h).
TEST(Calibrate, Adis16405HasThePublishedAllanCurve) {
  if (!test::data_dir()) GTEST_SKIP() << "COAST_DATA is not set: the real recordings are not at hand";
  const test::TemporaryDirectory folder;
  const fs::path config = folder.path() / "part.yaml";
  shorten(fs::path(COAST_SOURCE_DIR) / "configs" / "calibrations" / "adis16405-run1.yaml", config, "300",
          "axes: [gyro_x]\nprocesses: {gyro: {sum: [white_noise, gauss_markov, gauss_markov], drift: false}}\n");
  const Outcome outcome =
      run(fmt::format("calibrate '{}' --out '{}'", config.string(), (folder.path() / "out").string()), folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  const json axis = calibrated(folder.path() / "out")["axes"].at(0);
  EXPECT_EQ(axis["samples"], 30000);
  const json& allan = axis["allan"][0];
  const auto& tau = allan["tau_s"];
  const auto second = std::ranges::find_if(tau, [](const json& t) { return t.get<double>() > 0.99; }) - tau.begin();
  const auto at = static_cast<std::size_t>(second);
  constexpr double kDegree = 3.14159265358979323846 / 180.0;
  EXPECT_NEAR(tau[at].get<double>(), 1.0, 0.05);
  EXPECT_GT(0.0409 * kDegree, allan["lower_95"][at].get<double>());
  EXPECT_LT(0.0409 * kDegree, allan["upper_95"][at].get<double>());
  // Nothing but the gyro was calibrated, and the file that a filter reads says so.
  const std::string model = text_of(folder.path() / "out" / "error_model.yaml");
  EXPECT_NE(model.find("# not calibrated: zero error"), std::string::npos);
  EXPECT_NE(model.find("# not calibrated: taken from axis x"), std::string::npos);
}

}  // namespace
}  // namespace coast::cli
