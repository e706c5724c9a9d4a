// A recording that is read wrongly: what is wrong is named first, and nothing is where it is read rightly.

#include "coast/study/causes.hpp"

#include <gtest/gtest.h>

#include <ostream>
#include <random>

#include "coast/geo/units.hpp"
#include "simulated.hpp"

namespace coast::study {
namespace {

struct Mistake {
  const char* name;
  const char* told;
  Eigen::Matrix3d gyro;
  double late_s;
};
std::ostream& operator<<(std::ostream& out, const Mistake& mistake) {
  return out << mistake.name;
}

Eigen::Matrix3d signs(double x, double y, double z) {
  return Eigen::Vector3d(x, y, z).asDiagonal();
}

Eigen::Matrix3d exchanged(Eigen::Index i, Eigen::Index j) {
  Eigen::Matrix3d M = Eigen::Matrix3d::Identity();
  M.row(i).swap(M.row(j));
  return M;
}

std::vector<Cause> causes_of(const Mistake& mistake) {
  const simulate::Scenario scenario = test::drive(360.0, 61);
  simulate::SimulatedMission recording = simulate::simulate(scenario);
  for (record::ImuSample& s : recording.imu.samples) {
    s.dtheta = mistake.gyro * s.dtheta;
    s.t = s.t + mistake.late_s;
  }
  Setup setup = test::setup_of(scenario);
  setup.unstated = {.noise = {.gnss_scale = true, .correlated_gnss = true, .imu_white_noise = true}, .time_offset = true};
  return rank_causes(excerpt_of(recording.imu, recording.gnss), setup);
}

class ReadWrongly : public testing::TestWithParam<Mistake> {};

TEST_P(ReadWrongly, IsNamedFirst) {
  const std::vector<Cause> causes = causes_of(GetParam());
  ASSERT_FALSE(causes.empty());
  EXPECT_NE(causes.front().what.find(GetParam().told), std::string::npos) << causes.front().what;
  EXPECT_FALSE(causes.front().remedy.empty());
}

INSTANTIATE_TEST_SUITE_P(Kinds, ReadWrongly,
                         testing::Values(Mistake{"sign_x", "the sign of the gyro about body x", signs(-1, 1, 1), 0.0},
                                         Mistake{"sign_z", "the sign of the gyro about body z", signs(1, 1, -1), 0.0},
                                         Mistake{"x_y", "body x and y are exchanged", exchanged(0, 1), 0.0},
                                         Mistake{"y_z", "body y and z are exchanged", exchanged(1, 2), 0.0},
                                         Mistake{"all_signs", "all signs of the gyro", signs(-1, -1, -1), 0.0},
                                         Mistake{"turned_about_z", "by 180 deg about body z", signs(-1, -1, 1), 0.0},
                                         Mistake{"gyro_degrees", "the gyro is in deg/s", signs(1, 1, 1) / geo::kDegree, 0.0},
                                         Mistake{"leap_seconds", "the time offset is -18.2", signs(1, 1, 1), 18.25}),
                         [](const auto& kind) { return kind.param.name; });

TEST(Causes, AreNoneWhereTheRecordingIsReadRightly) {
  for (const Cause& cause : causes_of({"", "", signs(1, 1, 1), 0.0})) ADD_FAILURE() << cause.what << ' ' << cause.gain;
}

// Advice that the run file has followed already is none.
TEST(Causes, NoiseThatIsFittedIsNotAdvisedAgain) {
  const simulate::Scenario scenario = test::drive(360.0, 61);
  simulate::SimulatedMission recording = simulate::simulate(scenario);
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  const auto draw = [&](double sigma) -> Eigen::Vector3d {
    return sigma * Eigen::Vector3d(normal(random), normal(random), normal(random));
  };
  for (record::ImuSample& s : recording.imu.samples) {  // far beyond the model's densities
    s.dtheta += s.dt * draw(0.05);
    s.dv += s.dt * draw(1.0);
  }
  const Excerpt excerpt = excerpt_of(recording.imu, recording.gnss);
  study::Setup setup = test::setup_of(scenario);
  const auto noise = [&] {
    for (const Cause& cause : rank_causes(excerpt, setup))
      if (cause.what.find("the IMU's noise is about") != std::string::npos) return cause.remedy;
    return std::string();
  };
  EXPECT_EQ(noise(), "`imu: {noise: estimated}`");
  setup.noise_fit = estimate::NoiseFitChoice{.gnss_scale = false, .correlated_gnss = false, .imu_white_noise = true};
  EXPECT_EQ(noise(), "");
}

}  // namespace
}  // namespace coast::study
