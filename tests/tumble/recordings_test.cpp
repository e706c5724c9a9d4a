// The recording of an XSens MTi that its makers' toolkit publishes (imu-tk, BSD-3): raw counts, with their offset.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "coast/io/imu.hpp"
#include "coast/io/yaml.hpp"
#include "coast/tumble/calibration.hpp"
#include "support/support.hpp"

namespace coast::tumble {
namespace {

record::ImuRecording half(const char* file) {
  const std::string yaml = fmt::format(
      "file: '${{COAST_DATA}}/imu-tk-tumble/{}'\ncolumns: {{time: 1, accel: [2, 3, 4], gyro: [2, 3, 4]}}\n"
      "scale: {{accel: 0.0024, gyro: 1.598e-4}}\ntime: {{kind: elapsed}}\n",
      file);
  return io::read_imu(io::ImuFileOptions::from(io::parse_yaml(yaml, "imu.yaml")), geo::GpsTime{});
}

record::ImuRecording tumble_recording() {
  record::ImuRecording sensor = half("xsens_acc.mat.gz");
  const record::ImuRecording gyro = half("xsens_gyro.mat.gz");
  for (std::size_t i = 0; i < sensor.samples.size(); ++i) sensor.samples[i].dtheta = gyro.samples[i].dtheta;
  return sensor;
}

/// The ellipsoid x'Qx + 2q'x = 1 through the rests, by linear least squares: no attitudes, no iterations. Its symmetric root is
/// the inverse of the accelerometers' I + gain, its centre their bias.
record::TriadErrors ellipsoid(const std::vector<RestFit>& rests, double gravity) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (const RestFit& rest : rests)
    if (rest.used) centre += rest.rest.accel, count += 1.0;
  centre /= count;
  Eigen::MatrixXd A(0, 9);
  for (const RestFit& rest : rests) {
    if (!rest.used) continue;
    const Eigen::Vector3d f = (rest.rest.accel - centre) / gravity;
    A.conservativeResize(A.rows() + 1, 9);
    A.bottomRows<1>() << f.x() * f.x(), f.y() * f.y(), f.z() * f.z(), 2 * f.x() * f.y(), 2 * f.x() * f.z(), 2 * f.y() * f.z(),
        2 * f.x(), 2 * f.y(), 2 * f.z();
  }
  const Eigen::VectorXd p = A.colPivHouseholderQr().solve(Eigen::VectorXd::Ones(A.rows()));
  Eigen::Matrix3d Q;
  Q << p[0], p[3], p[4], p[3], p[1], p[5], p[4], p[5], p[2];
  const Eigen::Vector3d offset = -Q.inverse() * p.tail<3>();
  const double size = 1.0 + offset.dot(Q * offset);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(Q / size);
  const Eigen::Matrix3d root = eigen.operatorSqrt();
  return {root.inverse() - Eigen::Matrix3d::Identity(), centre + gravity * offset};
}

TEST(TumbleRecordings, XsensIsCalibratedAndAgreesWithAnEllipsoid) {
  if (!test::data_dir()) GTEST_SKIP() << "COAST_DATA is not set: no recordings here";
  Options options;
  options.gravity = 9.81744;  // as published with the recording
  options.gravity_sd = 1e-5;
  const Result result = calibrate(tumble_recording(), options);
  const record::ImuCalibration& found = result.calibration;
  EXPECT_GE(result.rests.size(), 25U);
  // Measured: 1.1 mm/s^2 a rest, 0.11 % of the angle turned. A wrong axis, unit or rest gives tens of times as much.
  EXPECT_LT(result.levels.accel, 0.003);
  EXPECT_LT(result.levels.turn, 0.003);
  const record::TriadErrors other = ellipsoid(result.rests, options.gravity);
  for (int i = 0; i < 3; ++i) {
    // Two estimators of one thing from the same rests, one of them weighted otherwise: within a few standard deviations.
    EXPECT_NEAR(found.accel.bias[i], other.bias[i], 4.0 * found.bias_sd(record::ImuCalibration::kAccel, i)) << i;
    for (int j = 0; j < 3; ++j)
      EXPECT_NEAR(found.accel.gain(i, j), other.gain(i, j), 4.0 * found.gain_sd(record::ImuCalibration::kAccel, i, j))
          << i << j;
  }
  // Stable: without the last third of the rests the same within what both state.
  record::ImuRecording part = tumble_recording();
  part.samples.resize(result.rests[result.rests.size() * 2 / 3].rest.last);
  const record::ImuCalibration shorter = calibrate(part, options).calibration;
  for (int triad : {record::ImuCalibration::kAccel, record::ImuCalibration::kGyro})
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const double a = (triad == record::ImuCalibration::kAccel ? found.accel : found.gyro).gain(i, j);
        const double b = (triad == record::ImuCalibration::kAccel ? shorter.accel : shorter.gyro).gain(i, j);
        EXPECT_NEAR(a, b, 4.0 * shorter.gain_sd(triad, i, j)) << triad << i << j;
      }
}

}  // namespace
}  // namespace coast::tumble
