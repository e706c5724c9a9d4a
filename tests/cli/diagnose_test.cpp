// coast diagnose as a user runs it, and `effects:` of a run.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "diagnose/result.hpp"
#include "program.hpp"
#include "support/schema.hpp"
#include "support/support.hpp"

namespace coast::cli {
namespace {

using namespace jobs;

namespace fs = std::filesystem;

constexpr const char* kCityDrive = R"(
schema: coast.scenario/1
trajectory: {kind: city, duration_s: 300, static_s: 20, origin_deg_m: [46.52, 6.57, 400], course_deg: 30}
imu: {rate_hz: 50, error_model: model.yaml, lever_arm_m: [0.3, -0.2, -1.1]}
gnss: {rate_hz: 2, phase_s: 0.013, sd_m: [0.01, 0.01, 0.02], velocity_sd_mps: [0.03, 0.03, 0.05]}
start_gps: {week: 2374, sow: 208800}
seed: 2
)";

/// A simulated recording, made once for the tests of this file; its scenario.yaml is in the folder above.
const fs::path& city_drive() {
  static const test::TemporaryDirectory folder;
  static const fs::path made = simulated_recording(kCityDrive, folder.path());
  return made;
}

constexpr double kTooFarRight = 0.2;  // m

/// A run of the recording with the antenna too far right.
fs::path wrong_lever_arm() {
  std::string text = text_of(city_drive() / "run.yaml");
  const std::string key = "lever_arm_m: [";
  const auto from = text.find(key);
  const auto to = text.find(']', from);
  EXPECT_NE(to, std::string::npos) << text;
  // As it is stated: `process` would find the arm by itself.
  text.replace(from, to - from + 1, fmt::format("{}0.3, {}, -1.1]\n  lever_arm_sd_m: 0", key, -0.2 + kTooFarRight));
  write(city_drive() / "wrong.yaml", text);
  return city_drive() / "wrong.yaml";
}

/// What `coast diagnose` with three twins says; valid, with all its files.
nlohmann::json diagnosed(const fs::path& run_yaml, const fs::path& out, const std::string& options, const fs::path& folder) {
  const Outcome outcome =
      run(fmt::format("diagnose '{}' --twins 3 {} --out '{}'", run_yaml.string(), options, out.string()), folder);
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  if (outcome.status != 0) return {};
  for (const char* name : {"diagnosis.json", "run.diagnosed.yaml", "report.json", "report.html"})
    EXPECT_TRUE(fs::exists(out / name)) << name;
  nlohmann::json diagnosis = nlohmann::json::parse(text_of(out / "diagnosis.json"));
  test::expect_valid("diagnosis", diagnosis);
  test::expect_valid("run", test::load_yaml_as_json(out / "run.diagnosed.yaml"));
  return diagnosis;
}

/// The effect of that name and axis; null where there is none.
nlohmann::json named_in(const nlohmann::json& effects, const std::string& name, const std::string& axis) {
  for (const nlohmann::json& effect : effects)
    if (effect.at("name").get<std::string>() == name && effect.at("axis").get<std::string>() == axis) return effect;
  return nullptr;
}

/// Mean of NIS over its expectation of a run.
double nis_of_run(const fs::path& run_yaml, const fs::path& out, const fs::path& folder) {
  const Outcome outcome = run(fmt::format("process '{}' --out '{}'", run_yaml.string(), out.string()), folder);
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  if (outcome.status != 0) return std::nan("");
  const auto nis = nlohmann::json::parse(text_of(out / "summary.json")).at("nis");
  return nis.at("mean").get<double>() / nis.at("expected").get<double>();
}

TEST(DiagnoseCommand, FindsAWrongLeverArmAndTheRunWithoutItFits) {
  const test::TemporaryDirectory folder;
  const fs::path wrong = wrong_lever_arm();
  const fs::path out = folder.path() / "found";
  const nlohmann::json diagnosis = diagnosed(wrong, out, "", folder.path());
  ASSERT_TRUE(diagnosis.is_object());
  EXPECT_TRUE(diagnosis["mismatch"].get<bool>());
  EXPECT_FALSE(diagnosis.contains("simulation"));
  const nlohmann::json effect = named_in(diagnosis["effects"], "lever_arm_error", "y");
  ASSERT_TRUE(effect.is_object()) << diagnosis["effects"];
  EXPECT_FALSE(effect.contains("in_simulation"));
  const nlohmann::json& size = effect["parameters"][0];
  EXPECT_NEAR(size["value"].get<double>(), -kTooFarRight, 4.0 * size["std"].get<double>());
  EXPECT_FALSE(diagnosis["twins"].empty());
  const nlohmann::json& verification = diagnosis["verification"];
  EXPECT_LT(verification["nis"][1].get<double>(), verification["nis"][0].get<double>());
  EXPECT_TRUE(verification.contains("twins"));
  EXPECT_TRUE(verification.contains("held_out"));

  const double before = nis_of_run(wrong, folder.path() / "before", folder.path());
  const double after = nis_of_run(out / "run.diagnosed.yaml", folder.path() / "after", folder.path());
  EXPECT_LT(after, before);
  // Over 500 epochs of six components: the mean has a standard deviation of sqrt(2 / 3000) = 0.026.
  EXPECT_NEAR(after, 1.0, 0.1);

  // What a key can state is stated by it.
  const nlohmann::json written = test::load_yaml_as_json(out / "run.diagnosed.yaml");
  EXPECT_FALSE(written.contains("effects"));
  const nlohmann::json stated = test::load_yaml_as_json(wrong);
  EXPECT_NEAR(written["imu"]["lever_arm_m"][1].get<double>(),
              stated["imu"]["lever_arm_m"][1].get<double>() + size["value"].get<double>(), 1e-4);

  // The page begins with what was found in plain words, and with the line to write and no other.
  const nlohmann::json plain = nlohmann::json::parse(text_of(out / "report.json"))["sections"][0];
  EXPECT_EQ(plain["id"], "plain");
  EXPECT_EQ(plain["notes"][0]["title"], effect["sentence"]);
  EXPECT_TRUE(effect["sentence"].get<std::string>().ends_with(" cm further left than stated.")) << effect["sentence"];
  const std::string to_write = plain["notes"].back()["text"];
  write(folder.path() / "to_write.yaml", to_write);
  const nlohmann::json lines = test::load_yaml_as_json(folder.path() / "to_write.yaml");
  EXPECT_EQ(lines["imu"]["lever_arm_m"], written["imu"]["lever_arm_m"]) << to_write;
  EXPECT_EQ(lines["imu"].size(), 1U) << to_write;
}

TEST(DiagnoseCommand, QuickFindsItWithoutTwinsAndSaysWhatIsLeftOut) {
  const test::TemporaryDirectory folder;
  const fs::path out = folder.path() / "quick";
  const Outcome outcome =
      run(fmt::format("diagnose '{}' --quick --out '{}'", wrong_lever_arm().string(), out.string()), folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_NE(text_of(out / "report.json").find("without --quick"), std::string::npos);
  const nlohmann::json diagnosis = nlohmann::json::parse(text_of(out / "diagnosis.json"));
  test::expect_valid("diagnosis", diagnosis);
  EXPECT_TRUE(diagnosis["quick"].get<bool>());
  EXPECT_TRUE(diagnosis["twins"].empty());
  EXPECT_TRUE(named_in(diagnosis["effects"], "lever_arm_error", "y").is_object()) << diagnosis["effects"];
  const Outcome both = run(fmt::format("diagnose '{}' --quick --twins 3", wrong_lever_arm().string()), folder.path());
  EXPECT_NE(both.status, 0);
  EXPECT_NE(both.error.find("--quick"), std::string::npos) << both.error;
}

TEST(DiagnoseCommand, LeavesThePageOfProcessAlone) {
  const fs::path& folder = city_drive();
  const Outcome processed = run(fmt::format("process '{}'", (folder / "run.yaml").string()), folder);
  ASSERT_EQ(processed.status, 0) << processed.error;
  const std::string page = text_of(folder / "run.out" / "report.html");
  const Outcome diagnosed = run(fmt::format("diagnose '{}' --quick", (folder / "run.yaml").string()), folder);
  ASSERT_EQ(diagnosed.status, 0) << diagnosed.error;
  EXPECT_EQ(text_of(folder / "run.out" / "report.html"), page);
  EXPECT_TRUE(fs::exists(folder / "run.diagnosis.out" / "report.html"));
}

TEST(DiagnoseCommand, SaysWhatTheUsersOwnSimulationLacks) {
  const test::TemporaryDirectory folder;
  const fs::path scenario = city_drive().parent_path() / "scenario.yaml";
  const nlohmann::json diagnosis =
      diagnosed(wrong_lever_arm(), folder.path() / "found", fmt::format("--simulation '{}'", scenario.string()), folder.path());
  ASSERT_TRUE(diagnosis.contains("simulation"));
  EXPECT_EQ(diagnosis["simulation"]["source"].get<std::string>(), scenario.string());
  EXPECT_TRUE(named_in(diagnosis["simulation"]["effects"], "lever_arm_error", "y").is_null());
  const nlohmann::json effect = named_in(diagnosis["effects"], "lever_arm_error", "y");
  ASSERT_TRUE(effect.is_object()) << diagnosis["effects"];
  EXPECT_FALSE(effect["in_simulation"].get<bool>());
  EXPECT_FALSE(diagnosis["twins"].empty());  // three seeds in their place
}

TEST(DiagnoseCommand, WarnsOfASimulationOfAnotherDrive) {
  const test::TemporaryDirectory folder;
  std::string text = text_of(city_drive().parent_path() / "scenario.yaml");
  const std::string course = "course_deg: 30";
  ASSERT_NE(text.find(course), std::string::npos);
  text.replace(text.find(course), course.size(), "course_deg: 120");
  write(city_drive().parent_path() / "other.yaml", text);
  const fs::path run_yaml = city_drive() / "run.yaml";
  const auto warning_of = [&](const char* scenario) {
    const Outcome outcome = run(fmt::format("diagnose '{}' --twins 0 --simulation '{}' --out '{}'", run_yaml.string(),
                                            (city_drive().parent_path() / scenario).string(), (folder.path() / "out").string()),
                                folder.path());
    EXPECT_EQ(outcome.status, 0) << outcome.error;
    return outcome.error.find("may be the drive") != std::string::npos;
  };
  EXPECT_TRUE(warning_of("other.yaml"));
  EXPECT_NE(text_of(folder.path() / "out" / "report.json").find("may be the drive"), std::string::npos);
  EXPECT_FALSE(warning_of("scenario.yaml"));
}

TEST(DiagnoseCommand, TakesNoSimulationThatIsNotThere) {
  const test::TemporaryDirectory folder;
  const Outcome outcome = run(fmt::format("diagnose '{}' --simulation none.yaml --out '{}'", wrong_lever_arm().string(),
                                          (folder.path() / "out").string()),
                              folder.path());
  EXPECT_EQ(outcome.status, 2) << outcome.error;
  EXPECT_NE(outcome.error.find("none.yaml"), std::string::npos) << outcome.error;
}

TEST(DiagnosisJson, SaysWhyAnEffectWasGivenUp) {
  DiagnosisResult result;
  diagnose::Diagnosis& diagnosis = result.diagnosis;
  diagnosis.runs = 1;
  diagnosis.rejected = {{"harmonic_disturbance accel y", diagnose::Rejected::Reason::kHeldOut},
                        {"bias_step gyro x", diagnose::Rejected::Reason::kOutages}};
  const auto written = nlohmann::json::parse(diagnosis_json(result));
  test::expect_valid("diagnosis", written);
  const nlohmann::json& rejected = written.at("verification").at("rejected");
  ASSERT_EQ(rejected.size(), 2U);
  EXPECT_EQ(rejected[0].at("effect"), "harmonic_disturbance accel y");
  EXPECT_NE(rejected[0].at("reason").get<std::string>().find("half"), std::string::npos);
  EXPECT_EQ(rejected[1].at("effect"), "bias_step gyro x");
  EXPECT_NE(rejected[1].at("reason").get<std::string>().find("outages"), std::string::npos);
}

// One entry for people, every time for machines and in the run file.
TEST(DiagnosisJson, HasEachTimeOfWhatHappenedOften) {
  DiagnosisResult result;
  result.end = geo::GpsTime::from_week(2374, 2000.0);
  diagnose::Diagnosis& diagnosis = result.diagnosis;
  diagnosis.runs = 1;
  const auto effect = std::ranges::find(diagnose::catalogue(), "gnss_wrong_fix", &diagnose::Effect::name);
  const auto fix = [&](Eigen::Index axis, double value, double second) {
    diagnose::Finding f;
    f.hypothesis = {&*effect, axis, 0.5};
    f.from = geo::GpsTime::from_week(2374, second);
    f.value = value;
    f.sd = 0.01;
    return f;
  };
  diagnosis.findings = {fix(0, 0.14, 1300.0)};
  diagnosis.findings[0].further = {fix(2, -0.08, 1100.0)};
  const auto written = nlohmann::json::parse(diagnosis_json(result));
  test::expect_valid("diagnosis", written);
  ASSERT_EQ(written.at("effects").size(), 1U);
  const nlohmann::json& times = written.at("effects")[0].at("times");
  ASSERT_EQ(times.size(), 2U);
  EXPECT_EQ(times[0].at("axis"), "d");
  EXPECT_EQ(times[0].at("t_start_s"), 1100.0);
  EXPECT_EQ(times[1].at("value"), 0.14);
  EXPECT_EQ(times[1].at("t_end_s"), 2000.0);
  const std::string yaml = diagnosed_yaml("", diagnosis, "");
  EXPECT_NE(yaml.find("axis: n, start_s: 1300.000000, value: 0.14"), std::string::npos) << yaml;
  EXPECT_NE(yaml.find("axis: d, start_s: 1100.000000, value: -0.08"), std::string::npos) << yaml;
}

// In words, by the odds of the likeliest other reading.
TEST(DiagnosisPage, SaysHowSureANameIs) {
  const auto said = [](double log_odds) {
    DiagnosisResult result;
    diagnose::NoiseFinding noise;
    noise.name = "flicker_noise";
    noise.sensor = "gyro";
    noise.unit = "rad/s";
    noise.alternatives = {{"bias_step", "gyro", "y", log_odds}};
    result.diagnosis.noise = {noise};
    return diagnosis_page("", result, "", "").sections.front().notes.front().text;
  };
  EXPECT_EQ(said(3.0), "Less likely, but possible: bias_step gyro y.");
  EXPECT_EQ(said(-0.1), "It may as well be bias_step gyro y: this recording does not tell them apart.");
  EXPECT_EQ(said(-3.0), "bias_step gyro y would explain more, but was not selected.");
}

struct SpoiledEffect {
  const char* what;
  const char* entry;    ///< of `effects:`
  const char* message;  ///< must be part of standard error
};

class SpoiledEffects : public testing::TestWithParam<SpoiledEffect> {};

TEST_P(SpoiledEffects, EndWithStatusTwoAndNameFileAndLine) {
  const test::TemporaryDirectory folder;
  const std::string good = text_of(city_drive() / "run.yaml");
  const fs::path file = city_drive() / "spoiled_effects.yaml";
  write(file,
        good + "effects:\n  - {name: lever_arm_error, sensor: antenna, axis: y, value: 0.1}\n  - " + GetParam().entry + "\n");
  const Outcome outcome =
      run(fmt::format("process '{}' --out '{}'", file.string(), (folder.path() / "out").string()), folder.path());
  EXPECT_EQ(outcome.status, 2) << outcome.error;
  const auto line = std::count(good.begin(), good.end(), '\n') + 3;
  EXPECT_NE(outcome.error.find(fmt::format("spoiled_effects.yaml:{}:", line)), std::string::npos) << outcome.error;
  EXPECT_NE(outcome.error.find(GetParam().message), std::string::npos) << outcome.error;
  EXPECT_FALSE(fs::exists(folder.path() / "out" / "summary.json"));
}

INSTANTIATE_TEST_SUITE_P(
    Runs, SpoiledEffects,
    testing::Values(
        SpoiledEffect{"a name with a slip", "{name: gyro_scale_faktor, sensor: gyro, axis: z, value: 0.01}",
                      "The nearest is 'gyro_scale_factor'"},
        SpoiledEffect{"noise of the error model", "{name: flicker_noise, sensor: gyro, axis: z, value: 1e-5}",
                      "'flicker_noise'"},
        SpoiledEffect{"another sensor", "{name: gyro_scale_factor, sensor: accel, axis: z, value: 0.01}",
                      "no gyro_scale_factor of accel"},
        SpoiledEffect{"a sensor that no form is of", "{name: unknown, sensor: gnss, axis: x, relation: speed, value: 1}",
                      "no unknown of gnss"},
        SpoiledEffect{"no axis", "{name: gyro_scale_factor, sensor: gyro, value: 0.01}", "'axis' is missing"},
        SpoiledEffect{"an axis of another effect", "{name: gyro_scale_factor, sensor: gyro, axis: zy, value: 0.01}",
                      "x | y | z"},
        SpoiledEffect{"an axis where there is one", "{name: gnss_time_offset, sensor: clock, axis: x, value: 0.01}", "axis"},
        SpoiledEffect{"a converter that ends", "{name: saturation, sensor: gyro, axis: z, value: 1, end_s: 208900}",
                      "the same all the time"},
        SpoiledEffect{"a base that moves", "{name: base_coordinate_offset, sensor: gnss, axis: n, value: 0.1, start_s: 208900}",
                      "the base stays where it is"},
        SpoiledEffect{"no size", "{name: gyro_scale_factor, sensor: gyro, axis: z}", "'value' is missing"},
        SpoiledEffect{"a word for a size", "{name: gyro_scale_factor, sensor: gyro, axis: z, value: large}", "large"},
        SpoiledEffect{"a relation that is none", "{name: unknown, sensor: gyro, axis: x, relation: omega_z*f_w, value: 0.02}",
                      "omega_z*f_w"},
        SpoiledEffect{"no relation", "{name: unknown, sensor: gyro, axis: x, value: 0.02}", "'relation' is missing"},
        SpoiledEffect{"no frequency", "{name: harmonic_disturbance, sensor: accel, axis: y, phase_rad: 0, value: 0.05}",
                      "'frequency_hz' is missing"},
        SpoiledEffect{"a frequency of what has none",
                      "{name: bias_step, sensor: accel, axis: y, frequency_hz: 1, value: 0.05, start_s: 208900}",
                      "frequency_hz"}),
    [](const testing::TestParamInfo<SpoiledEffect>& spoiled) { return fmt::format("n{}", spoiled.index); });

}  // namespace
}  // namespace coast::cli
