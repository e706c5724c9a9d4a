// What a run file says, as the jobs get it.

#include "coast/jobs/run_file.hpp"

#include <gtest/gtest.h>

#include "coast/io/writers.hpp"
#include "coast/record/error.hpp"
#include "support/short_drive.hpp"
#include "support/support.hpp"

namespace coast::jobs {
namespace {

class RunFile : public testing::Test {
 protected:
  RunFile() { io::write_text(folder_.path() / "model.yaml", test::kTestModel); }
  [[nodiscard]] noise::ImuErrorModel model_with(const std::string& noise) const {
    io::write_text(folder_.path() / "run.yaml",
                   "schema: coast.run/1\nimu: {file: imu.csv, error_model: model.yaml, lever_arm_m: [0, 0, 0], noise: " +
                       noise + "}\ngnss: {file: gnss.csv}\n");
    return read_run_config(folder_.path() / "run.yaml").setup.model;
  }

  test::TemporaryDirectory folder_;
};

TEST_F(RunFile, FactorsOfWhiteNoiseAreOfAllAxesOrOfEach) {
  const noise::ImuErrorModel stated = model_with("stated");
  const noise::ImuErrorModel model = model_with("{gyro_factor: 3, accel_factor: [1, 2, 0.5]}");
  const Eigen::Vector3d accel(1.0, 2.0, 0.5);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(model.white_density(noise::Sensor::kGyro, axis).value,
                9.0 * stated.white_density(noise::Sensor::kGyro, axis).value, 1e-20);
    EXPECT_NEAR(model.white_density(noise::Sensor::kAccel, axis).value,
                accel(axis) * accel(axis) * stated.white_density(noise::Sensor::kAccel, axis).value, 1e-18);
  }
}

TEST_F(RunFile, FactorsThatNoNoiseHasAreRefused) {
  for (const char* spoiled : {"{gyro_factor: [1, 2]}", "{gyro_factor: [1, 0, 2]}", "{accel_factor: [1, 2, 1e9]}",
                              "{accel_factor: -1}", "{gyro_factor: [a, b, c]}"}) {
    try {
      static_cast<void>(model_with(spoiled));
      ADD_FAILURE() << spoiled;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find("run.yaml:2"), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find("_factor"), std::string::npos) << e.what();
    }
  }
}

}  // namespace
}  // namespace coast::jobs
