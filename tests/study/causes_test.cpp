// A recording that is read wrongly: what is wrong is named first, and nothing is where it is read rightly.

#include "coast/study/causes.hpp"

#include <gtest/gtest.h>

#include <ostream>

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

}  // namespace
}  // namespace coast::study
