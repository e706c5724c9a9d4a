#include "coast/ins/mounting.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <string>
#include <vector>

#include "coast/config/builder.hpp"
#include "coast/geo/units.hpp"
#include "coast/record/error.hpp"
#include "support/support.hpp"

namespace coast {
namespace {

config::Node imu_node(const std::vector<std::string>& axes, const std::vector<std::string>& mounting_deg) {
  config::TreeBuilder builder("run.yaml");
  const auto root = builder.root_map(1);
  if (!axes.empty()) {
    const auto list = builder.add_list(root, "axes", 2);
    for (const std::string& text : axes) builder.add_scalar(list, "", text, 2);
  }
  if (!mounting_deg.empty()) {
    const auto list = builder.add_list(root, "mounting_deg", 3);
    for (const std::string& text : mounting_deg) builder.add_scalar(list, "", text, 3);
  }
  return builder.finish();
}

TEST(Mounting, DefaultIsTheIdentity) {
  EXPECT_EQ(ins::C_s_b(ins::MountingOptions::from(imu_node({}, {}))), Eigen::Matrix3d::Identity());
}

TEST(Mounting, AxesNameTheSensorAxesThatPointForwardRightAndDown) {
  // x backward, y right, z up: a specific force along sensor x is one along body backward.
  const Eigen::Matrix3d C = ins::C_s_b(ins::MountingOptions::from(imu_node({"-x", "y", "-z"}, {})));
  EXPECT_EQ(C * Eigen::Vector3d(1.0, 2.0, 3.0), Eigen::Vector3d(-1.0, 2.0, -3.0));
  // Forward is sensor y, right is sensor x, down is minus sensor z (east-north-up to forward-right-down).
  const Eigen::Matrix3d D = ins::C_s_b(ins::MountingOptions::from(imu_node({"y", "+x", "-z"}, {})));
  EXPECT_EQ(D * Eigen::Vector3d(1.0, 2.0, 3.0), Eigen::Vector3d(2.0, 1.0, -3.0));
}

TEST(Mounting, AnglesTakeBodyToSensor) {
  // Yaw +90 deg: C_b_s = Rz(90 deg) takes body x to sensor y, so what sensor y sees lies along body x.
  const Eigen::Matrix3d yaw = ins::C_s_b(ins::MountingOptions::from(imu_node({}, {"0", "0", "90"})));
  test::expect_near_matrix(yaw * Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitX(), 1e-15, "yaw");
  // Rz Ry Rx written out by elementary rotations, after the axes.
  const double r = 10.0 * geo::kDegree, p = -6.79 * geo::kDegree, y = 5.35 * geo::kDegree;
  const Eigen::Matrix3d C_b_s =
      (Eigen::AngleAxisd(y, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(p, Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(r, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  const Eigen::Matrix3d axes = Eigen::Vector3d(-1.0, 1.0, -1.0).asDiagonal();
  const Eigen::Matrix3d C = ins::C_s_b(ins::MountingOptions::from(imu_node({"-x", "y", "-z"}, {"10", "-6.79", "5.35"})));
  test::expect_near_matrix(C, C_b_s.transpose() * axes, 1e-15, "axes, then mounting");
}

TEST(Mounting, WrongAxesAreNamedWithTheirLine) {
  for (const auto& axes : {std::vector<std::string>{"x", "y"},
                           {"x", "x", "z"},
                           {"x", "y", "-z"},
                           {"x", "y", "w"},
                           {"x", "y", ""},
                           {"x", "y", "--z"}}) {
    try {
      (void)ins::MountingOptions::from(imu_node(axes, {}));
      FAIL() << "accepted";
    } catch (const InputError& error) {
      EXPECT_EQ(error.parts().line, 2) << error.what();
    }
  }
  EXPECT_THROW((void)ins::MountingOptions::from(imu_node({}, {"0", "91", "0"})), InputError);
  EXPECT_THROW((void)ins::MountingOptions::from(imu_node({}, {"0", "0", "-181"})), InputError);
}

TEST(Mounting, RotatesEverySampleInPlace) {
  record::ImuRecording recording;
  recording.samples.push_back({geo::GpsTime(), 0.01, Eigen::Vector3d(1.0, 2.0, 3.0), Eigen::Vector3d(4.0, 5.0, 6.0)});
  ins::to_body(recording, Eigen::Vector3d(-1.0, 1.0, -1.0).asDiagonal());
  EXPECT_EQ(recording.samples[0].dtheta, Eigen::Vector3d(-1.0, 2.0, -3.0));
  EXPECT_EQ(recording.samples[0].dv, Eigen::Vector3d(-4.0, 5.0, -6.0));
}

}  // namespace
}  // namespace coast
