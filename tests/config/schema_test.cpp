// The schemas of docs/schema: their own examples, every shipped configuration, and what they must refuse.

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "coast/geo/units.hpp"
#include "support/schema.hpp"

namespace coast {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const fs::path kSource = COAST_SOURCE_DIR;

TEST(Schemas, AreOfOneDraft) {
  for (const auto& file : fs::directory_iterator(kSource / "docs" / "schema")) {
    const json schema = test::schema(file.path().stem().stem().string());
    EXPECT_EQ(schema.at("$schema"), "http://json-schema.org/draft-07/schema#") << file.path();
  }
}

TEST(Schemas, OwnExamplesAreValid) {
  for (const char* name :
       {"calibration", "calibration_run", "campaign", "diagnosis", "estimator_study", "estimator_study_result", "fleet",
        "imu_calibration", "imu_error_model", "outage", "ppk", "ppk_result", "run", "scenario", "study", "summary", "tumble"}) {
    const json examples = test::schema(name).at("examples");
    ASSERT_FALSE(examples.empty()) << name;
    for (const json& example : examples) test::expect_valid(name, example, "example");
  }
}

TEST(Schemas, ShippedConfigurationsAreValid) {
  int count = 0;
  for (const auto& file : fs::recursive_directory_iterator(kSource / "configs")) {
    if (file.path().extension() != ".yaml") continue;
    const json document = test::load_yaml_as_json(file.path());
    test::expect_valid(test::schema_of(document), document, file.path().string());
    ++count;
  }
  EXPECT_GE(count, 12);
}

bool refused(const std::string& name, const json& patch) {
  json document = test::schema(name).at("examples").at(0);
  document.merge_patch(patch);
  return !test::schema_violations(name, document).empty();
}

TEST(Schemas, RefuseWhatTheProgramRefuses) {
  const json hundred_seeds = {{"first", 1}, {"count", 100}};
  EXPECT_FALSE(refused("run", json::object()));
  EXPECT_TRUE(refused("run", {{"imu", {{"fromat", "csv"}}}}));
  EXPECT_TRUE(refused("run", {{"imu", {{"lever_arm_m", {1, 2}}}}}));
  EXPECT_TRUE(refused("run", {{"imu", {{"error_model", nullptr}}}}));  // a merge patch with null removes the key
  EXPECT_TRUE(refused("run", {{"smoother", "kalman"}}));
  EXPECT_TRUE(refused("run", {{"outages", {{{"start_s", 1}}}}}));
  EXPECT_TRUE(refused("run", {{"start", {{"time_s", 1}}}}));
  EXPECT_FALSE(refused("run", {{"vehicle", "car"}}));
  EXPECT_FALSE(refused("run", {{"outages", {{"durations_s", {20, 60}}}}}));
  EXPECT_TRUE(refused("study", {{"sweep", {{"durations_s", {0}}}}}));
  EXPECT_FALSE(refused("study", {{"run", nullptr}, {"sweep", nullptr}, {"scenario", "s.yaml"}, {"seeds", hundred_seeds}}));
  EXPECT_TRUE(refused("study", {{"run", nullptr}, {"sweep", nullptr}, {"scenario", "s.yaml"}}));
  EXPECT_TRUE(refused("study", {{"sweep", nullptr}, {"scenario", "s.yaml"}, {"seeds", hundred_seeds}}));
  EXPECT_TRUE(refused("study", {{"scenario", "s.yaml"}, {"seeds", hundred_seeds}}));
  EXPECT_TRUE(refused("study", {{"floors", json::array()}}));
  const json simulated = {{"run", nullptr}, {"scenario", "s.yaml"}, {"seeds", hundred_seeds}};
  const auto with = [](json patch, const json& more) {
    patch.merge_patch(more);
    return patch;
  };
  EXPECT_FALSE(refused("study", with(simulated, {{"sweep", {{"durations_s", {20}}}}})));
  EXPECT_TRUE(refused("study", with(simulated, {{"sweep", {{"satellites", 4}}}})));
  EXPECT_TRUE(refused("study", with(simulated, {{"outages", {{{"start_s", 100}, {"duration_s", 20}}}}})));  // beside a sweep
  const auto model_with = [](const char* key, const char* value) {
    return json{{"error_models", {{{"name", "a"}, {"file", "a.yaml"}, {key, value}}}}};
  };
  EXPECT_FALSE(refused("study", model_with("noise", "estimated")));
  EXPECT_TRUE(refused("study", model_with("noise", "guessed")));
  EXPECT_TRUE(refused("study", model_with("smoother", "batch")));  // of a recording
  EXPECT_FALSE(refused("study", with(simulated, model_with("smoother", "batch"))));
  EXPECT_TRUE(refused("study", with(simulated, model_with("noise", "estimated"))));
  EXPECT_FALSE(refused("outage", {{"more", 1}}));  // outputs may gain keys
  EXPECT_TRUE(refused("outage", {{"outages", json::array()}}));
  EXPECT_TRUE(refused("outage", {{"seeds", {{"count", 0}}}}));
  EXPECT_FALSE(refused("calibration_run", {{"criterion", "aicc"}}));
  EXPECT_TRUE(refused("calibration_run", {{"records", nullptr}}));
  EXPECT_TRUE(refused("calibration_run", {{"records", json::array()}}));
  EXPECT_TRUE(refused("calibration_run", {{"axes", {"gyro_w"}}}));
  EXPECT_TRUE(refused("calibration_run", {{"turn_on_bias", {{"gyro", {{"unit", "mg"}}}}}}));
  EXPECT_TRUE(refused("calibration", {{"axes", nullptr}}));
  EXPECT_FALSE(refused("calibration", {{"more", 1}}));  // outputs may gain keys
  EXPECT_FALSE(refused("estimator_study", {{"mean", "level"}}));
  EXPECT_TRUE(refused("estimator_study", {{"runs", nullptr}}));
  EXPECT_TRUE(refused("estimator_study", {{"estimators", {{{"kind", "em"}}}}}));  // without a start
  EXPECT_TRUE(refused("estimator_study", {{"truth", {{"processes", {{{"process", "white_noise"}, {"density", 0}}}}}}}));
  EXPECT_TRUE(refused("estimator_study_result", {{"estimators", json::array()}}));
  EXPECT_FALSE(refused("estimator_study_result", {{"more", 1}}));  // outputs may gain keys
  EXPECT_FALSE(refused("diagnosis", {{"more", 1}}));               // outputs may gain keys
  EXPECT_TRUE(refused("diagnosis", {{"effects", {{{"name", "unknown"}}}}}));
  EXPECT_TRUE(refused("diagnosis", {{"grade", "toy"}}));
  EXPECT_TRUE(refused("diagnosis", {{"verification", {{"held_out", nullptr}}}}));  // its log-likelihoods stay
  EXPECT_TRUE(refused("scenario", {{"trajectory", {{"kind", "rocket"}}}}));
  EXPECT_TRUE(refused("scenario", {{"schema", nullptr}}));
  EXPECT_FALSE(refused(
      "run", {{"gnss", {{"file", nullptr}, {"format", nullptr}, {"ppk", {{"rover", "r"}, {"base", "b"}, {"nav", "n"}}}}}}));
  EXPECT_TRUE(refused("run", {{"gnss", {{"file", nullptr}}}}));
  EXPECT_FALSE(refused("ppk", {{"base_position", "header"}, {"fix", false}}));
  EXPECT_TRUE(refused("ppk", {{"nav", nullptr}}));
  EXPECT_TRUE(refused("ppk", {{"base_position", {{"ecef_m", {1, 2}}}}}));
  EXPECT_TRUE(refused("ppk", {{"elevation_mask_deg", 80}}));
  EXPECT_FALSE(refused("ppk_result", {{"more", 1}}));  // outputs may gain keys
  EXPECT_TRUE(refused("ppk_result", {{"fix_rate", 2}}));
  EXPECT_TRUE(refused("summary", {{"gnss", {{"used", -1}}}}));
  EXPECT_FALSE(refused("summary", {{"more", 1}}));  // outputs may gain keys
}

json with_gyro_entry(const json& entry) {
  return {{"gyro", {{"x", {entry}}}}};
}

TEST(Schemas, ErrorModelEntriesNeedAUnitThatFits) {
  const std::string name = "imu_error_model";
  EXPECT_FALSE(refused(name, with_gyro_entry({{"process", "white_noise"}, {"density", 0.1}, {"unit", "deg/sqrt(h)"}})));
  EXPECT_TRUE(refused(name, with_gyro_entry({{"process", "white_noise"}, {"density", 0.1}})));
  EXPECT_TRUE(refused(name, with_gyro_entry({{"process", "white_noise"}, {"density", 0.1}, {"unit", "ug/sqrt(Hz)"}})));
  EXPECT_TRUE(refused(name, with_gyro_entry({{"process", "white_noise"}, {"sigma", 0.1}, {"unit", "deg/sqrt(h)"}})));
  EXPECT_TRUE(refused(name, with_gyro_entry({{"process", "pink"}, {"density", 0.1}, {"unit", "deg/sqrt(h)"}})));
  EXPECT_TRUE(refused(name, with_gyro_entry({{"process", "gauss_markov"}, {"sigma", 0.1}, {"unit", "deg/h"}})));
  EXPECT_FALSE(refused(name, with_gyro_entry({{"process", "drift"}, {"slope", -0.1}, {"unit", "deg/h/h"}})));
  EXPECT_TRUE(refused(name, with_gyro_entry({{"process", "rate_ramp"}, {"coefficient", -0.1}, {"unit", "deg/h/h"}})));
  EXPECT_TRUE(refused(name, with_gyro_entry({{"process", "quantisation"}, {"step", 1}, {"unit", "m/s"}})));
  EXPECT_TRUE(refused(name, with_gyro_entry({{"process", "ar"}, {"coefficients", {0.5}}, {"unit", "deg/h"}, {"rate_hz", 1}})));
}

// Collects the units that a schema allows in the entries of one sensor and one key.
std::set<std::string> units_of(const json& schema, const std::string& sensor, const std::string& process, const char* key) {
  std::set<std::string> units;
  for (const json& entry : schema.at("definitions").at(sensor + "_entry").at("oneOf")) {
    const json& properties = entry.at("properties");
    if (properties.at("process").at("const") != process || !properties.contains(key)) continue;
    for (const json& unit : properties.at("unit").at("enum")) units.insert(unit.get<std::string>());
  }
  return units;
}

std::set<std::string> table_of(geo::Dimension dimension) {
  std::set<std::string> units;
  for (const geo::Unit& unit : geo::units()) {
    if (unit.dimension == dimension) units.emplace(unit.name);
  }
  return units;
}

TEST(Schemas, UnitsAreThoseOfTheTable) {
  using geo::Dimension;
  const json schema = test::schema("imu_error_model");
  const auto expect = [&](const char* sensor, const char* process, const char* key, Dimension dimension) {
    EXPECT_EQ(units_of(schema, sensor, process, key), table_of(dimension)) << sensor << " " << process;
  };
  expect("gyro", "white_noise", "density", Dimension::kAngularRateNoise);
  expect("gyro", "white_noise", "variance_per_sample", Dimension::kAngularRateVariance);
  expect("gyro", "random_walk", "density", Dimension::kAngularRateWalk);
  expect("gyro", "gauss_markov", "sigma", Dimension::kAngularRate);
  expect("gyro", "random_constant", "sigma", Dimension::kAngularRate);
  expect("accel", "white_noise", "density", Dimension::kSpecificForceNoise);
  expect("accel", "white_noise", "variance_per_sample", Dimension::kSpecificForceVariance);
  expect("accel", "random_walk", "density", Dimension::kSpecificForceWalk);
  expect("accel", "gauss_markov", "sigma", Dimension::kSpecificForce);
  expect("accel", "scale_factor", "sigma", Dimension::kRatio);
  expect("gyro", "misalignment", "sigma", Dimension::kAngle);
  expect("gyro", "drift", "slope", Dimension::kAngularRateRamp);
  expect("accel", "drift", "slope", Dimension::kSpecificForceRamp);
  expect("gyro", "rate_ramp", "coefficient", Dimension::kAngularRateRamp);
  expect("accel", "rate_ramp", "coefficient", Dimension::kSpecificForceRamp);
  expect("gyro", "flicker", "coefficient", Dimension::kAngularRate);
  expect("accel", "flicker", "coefficient", Dimension::kSpecificForce);
  expect("gyro", "ar", "innovation_sigma", Dimension::kAngularRate);
  expect("accel", "ar", "innovation_sigma", Dimension::kSpecificForce);
  const auto either = [](std::set<std::string> a, const std::set<std::string>& b) {
    a.insert(b.begin(), b.end());
    return a;
  };
  EXPECT_EQ(units_of(schema, "gyro", "quantisation", "step"),
            either(table_of(Dimension::kAngle), table_of(Dimension::kAngularRate)));
  EXPECT_EQ(units_of(schema, "accel", "quantisation", "step"),
            either(table_of(Dimension::kVelocity), table_of(Dimension::kSpecificForce)));
}

}  // namespace
}  // namespace coast
