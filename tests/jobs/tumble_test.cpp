// The multi-position calibration as a job, its files, and their use in a run.

#include "coast/jobs/tumble.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "coast/io/imu_calibration.hpp"
#include "coast/io/yaml.hpp"
#include "coast/noise/error_model.hpp"
#include "coast/record/error.hpp"
#include "support/schema.hpp"
#include "support/support.hpp"
#include "tumble/tumbled.hpp"

namespace coast::jobs {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

struct Example {
  record::TriadErrors accel, gyro;
  test::Tumbled made;
  TumbleConfig config;
};

Example example() {
  Example e;
  std::tie(e.accel, e.gyro) = test::drawn_errors(11);
  e.made = test::tumbled({}, e.accel, e.gyro);
  e.config.file = "tumble.yaml";
  e.config.sensor = "made";
  e.config.options.gravity = 9.81;
  e.config.gravity_from = "stated";
  return e;
}

TEST(TumbleJob, WritesWhatARunTakesOut) {
  const Example e = example();
  const TumbleResult result = tumble_calibration(e.config, e.made.sensor, {});
  const test::TemporaryDirectory folder;
  write(e.config, result, folder.path());
  for (const std::string& file : files_of(e.config)) EXPECT_TRUE(std::filesystem::exists(folder.path() / file)) << file;
  test::expect_valid("tumble_result", nlohmann::json::parse(text_of(folder.path() / "tumble.json")));
  test::expect_valid("imu_calibration", test::load_yaml_as_json(folder.path() / "imu_calibration.yaml"));
  test::expect_valid("page", nlohmann::json::parse(text_of(folder.path() / "report.json")));
  const record::ImuCalibration read = io::read_imu_calibration(folder.path() / "imu_calibration.yaml");
  EXPECT_EQ(read.accel.gain, result.calibration.calibration.accel.gain);
  EXPECT_EQ(read.gyro.bias, result.calibration.calibration.gyro.bias);
  EXPECT_LT((read.covariance - result.calibration.calibration.covariance).norm(),
            1e-8 * result.calibration.calibration.covariance.norm());
  // Taken out, every rest measures gravity: the white noise of five seconds, the wander of 2e-3 and the estimate's error.
  record::ImuRecording sensor = e.made.sensor;
  record::take_out(read, sensor);
  for (const auto& [from, to] : e.made.rests) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double time = 0.0;
    for (const record::ImuSample& s : sensor.samples)
      if (const double t = s.t - sensor.samples.front().t; t > from && t < to - 0.1) sum += s.dv, time += s.dt;
    EXPECT_NEAR((sum / time).norm(), 9.81, 0.02) << from;
  }
  EXPECT_NE(told(e.config, result, folder.path()).find("25 rests"), std::string::npos);
}

TEST(TumbleJob, ReadsItsExampleAndRefusesSpoiledFiles) {
  EXPECT_EQ(test::yaml_as_json(tumble_example("")), test::schema("tumble").at("examples").at(0));
  const test::TemporaryDirectory folder;
  const std::filesystem::path file = folder.path() / "tumble.yaml";
  const auto read = [&](const std::string& from, const std::string& to) {
    std::string text = tumble_example("");
    if (!from.empty()) text.replace(text.find(from), from.size(), to);
    std::ofstream(file) << text;
    return read_tumble(file);
  };
  const TumbleConfig config = read("", "");
  EXPECT_NEAR(config.options.gravity, 9.8062, 5e-4);  // normal gravity of 45.41 deg, 60 m
  ASSERT_TRUE(config.options.latitude.has_value());
  EXPECT_THROW(static_cast<void>(read("latitude_deg: 45.41", "latitude_deg: 145")), InputError);
  EXPECT_THROW(static_cast<void>(read("place", "palce")), InputError);
  EXPECT_THROW(static_cast<void>(read("imu:", "records:")), InputError);
  EXPECT_NEAR(read("place: {latitude_deg: 45.41, height_m: 60}", "gravity_mps2: 9.81744").options.gravity, 9.81744, 1e-12);
}

TEST(ImuCalibrationFile, SpoiledOnesAreRefused) {
  const Example e = example();
  record::ImuCalibration calibration;
  calibration.covariance.diagonal().setConstant(1e-8);
  const std::string good = io::imu_calibration_yaml(calibration, "");
  const test::TemporaryDirectory folder;
  const std::filesystem::path file = folder.path() / "c.yaml";
  const auto read = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    std::ofstream(file) << text;
    return io::read_imu_calibration(file);
  };
  EXPECT_NO_THROW(static_cast<void>(read("# measured", "# measured")));
  EXPECT_THROW(static_cast<void>(read("coast.imu_calibration/1", "coast.imu_calibration/2")), InputError);
  EXPECT_THROW(static_cast<void>(read("bias: [0, 0, 0]", "bias: [0, 0]")), InputError);
  EXPECT_THROW(static_cast<void>(read("    - [0, 0, 0]", "    - [-1, 0, 0]")), InputError);  // cannot be inverted
  EXPECT_THROW(static_cast<void>(read("  - [1e-08]", "  - [-1e-08]")), InputError);
  EXPECT_THROW(static_cast<void>(read("  - [0, 1e-08]", "  - [0.1, 1e-08]")), InputError);
  EXPECT_THROW(static_cast<void>(read("  - [1e-08]\n", "")), InputError);
}

TEST(ImuCalibrationFile, TightensGainsOfTheErrorModelOnly) {
  constexpr const char* kModel = R"(schema: coast.imu_error_model/1
gyro: {all: [{process: white_noise, density: 0.1, unit: deg/sqrt(h)}, {process: scale_factor, sigma: 3000, unit: ppm}]}
accel: {all: [{process: random_constant, sigma: 1, unit: mg}, {process: misalignment, sigma: 5, unit: mrad},
              {process: scale_factor, sigma: 50, unit: ppm}]}
)";
  const noise::ImuErrorModel model = noise::ImuErrorModel::from(io::parse_yaml(kModel, "model.yaml"));
  record::ImuCalibration calibration;
  calibration.covariance.diagonal().setConstant(4e-8);  // 200 ppm
  const noise::ImuErrorModel known = model.with_gains_known(calibration);
  const auto sd = [](const noise::ProcessPtr& process) {
    Eigen::MatrixXd P(1, 1);
    process->initial_covariance(P);
    return std::sqrt(P(0, 0));
  };
  EXPECT_NEAR(sd(known.axes(noise::Sensor::kGyro)[0][1]), std::hypot(2e-4, 3e-4), 1e-12);
  EXPECT_NEAR(sd(known.axes(noise::Sensor::kAccel)[2][1]), std::hypot(2e-4, 5e-4), 1e-12);
  EXPECT_NEAR(sd(known.axes(noise::Sensor::kAccel)[2][3]), 5e-5, 1e-12);  // better known already
  EXPECT_EQ(known.bias_sd(noise::Sensor::kAccel, 1), model.bias_sd(noise::Sensor::kAccel, 1));
}

}  // namespace
}  // namespace coast::jobs
