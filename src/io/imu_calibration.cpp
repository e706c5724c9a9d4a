#include "coast/io/imu_calibration.hpp"

#include <fmt/format.h>

#include <cmath>

#include "coast/config/quoted.hpp"
#include "coast/io/yaml.hpp"

namespace coast::io {

namespace {

using config::Node;
using record::ImuCalibration;
using record::TriadErrors;

TriadErrors triad_from(const Node& node) {
  constexpr double kLargest = 100.0;  // raw counts with their offset are hundreds of units off, wrong units more
  TriadErrors triad;
  triad.bias = node.at("bias").vector3();
  const Node gain = node.at("gain");
  const std::vector<Node> rows = gain.items();
  if (rows.size() != 3) throw gain.error(fmt::format("{} rows", rows.size()), "three rows of three numbers");
  for (std::size_t row = 0; row < 3; ++row) triad.gain.row(static_cast<Eigen::Index>(row)) = rows[row].vector3().transpose();
  if (triad.gain.cwiseAbs().maxCoeff() > kLargest)
    throw gain.error("a gain error above 100", "measured = (I + gain) true + bias");
  if (std::abs((Eigen::Matrix3d::Identity() + triad.gain).determinant()) < 1e-6)
    throw gain.error("a gain that cannot be inverted", "measured = (I + gain) true + bias");
  return triad;
}

void read_covariance(const Node& list, ImuCalibration& calibration) {
  const std::vector<Node> rows = list.items();
  if (rows.size() != ImuCalibration::kValues)
    throw list.error(fmt::format("{} rows", rows.size()),
                     fmt::format("{} rows, each one number longer", ImuCalibration::kValues));
  for (int i = 0; i < ImuCalibration::kValues; ++i) {
    const Node& row = rows[static_cast<std::size_t>(i)];
    const std::vector<double> values = row.numbers();
    if (values.size() != static_cast<std::size_t>(i) + 1)
      throw row.error(fmt::format("{} numbers", values.size()), fmt::format("{}: the lower triangle", i + 1));
    for (int j = 0; j <= i; ++j)
      calibration.covariance(i, j) = calibration.covariance(j, i) = values[static_cast<std::size_t>(j)];
    if (!(values.back() >= 0.0)) throw row.error("a variance below zero", "variances on the diagonal");
  }
  for (int i = 0; i < ImuCalibration::kValues; ++i)
    for (int j = 0; j < i; ++j)
      if (std::abs(calibration.covariance(i, j)) >
          1.001 * std::sqrt(calibration.covariance(i, i) * calibration.covariance(j, j)))
        throw rows[static_cast<std::size_t>(i)].error("a correlation above one", "a covariance");
}

std::string triad_yaml(const char* name, const char* unit, const TriadErrors& triad, const ImuCalibration& calibration,
                       int at) {
  std::string text = fmt::format("{}:\n  bias: [{:.17g}, {:.17g}, {:.17g}]  # {}, +- {:.2g}, {:.2g}, {:.2g}\n  gain:\n", name,
                                 triad.bias.x(), triad.bias.y(), triad.bias.z(), unit, calibration.bias_sd(at, 0),
                                 calibration.bias_sd(at, 1), calibration.bias_sd(at, 2));
  for (int row = 0; row < 3; ++row)
    text += fmt::format("    - [{:.17g}, {:.17g}, {:.17g}]  # +- {:.2g}, {:.2g}, {:.2g}\n", triad.gain(row, 0),
                        triad.gain(row, 1), triad.gain(row, 2), calibration.gain_sd(at, row, 0),
                        calibration.gain_sd(at, row, 1), calibration.gain_sd(at, row, 2));
  return text;
}

}  // namespace

ImuCalibration read_imu_calibration(const std::filesystem::path& file) {
  const Node root = load_yaml(file);
  const Node schema = root.at("schema");
  if (schema.text() != "coast.imu_calibration/1") throw schema.error("schema " + schema.text(), "coast.imu_calibration/1");
  ImuCalibration calibration;
  calibration.sensor = root.text("sensor", "unnamed");
  calibration.accel = triad_from(root.at("accel"));
  calibration.gyro = triad_from(root.at("gyro"));
  read_covariance(root.at("covariance"), calibration);
  root.refuse_unasked();
  return calibration;
}

std::string imu_calibration_yaml(const ImuCalibration& calibration, const std::string& comment) {
  std::string text = comment;
  text += "# measured = (I + gain) true + bias, axes of the sensor; m/s^2 and rad/s; +- one standard deviation\n";
  text += fmt::format("schema: coast.imu_calibration/1\nsensor: {}\n", config::quoted(calibration.sensor));
  text += triad_yaml("accel", "m/s^2", calibration.accel, calibration, ImuCalibration::kAccel);
  text += triad_yaml("gyro", "rad/s", calibration.gyro, calibration, ImuCalibration::kGyro);
  text += "covariance:  # lower triangle: accel bias x, y, z, gain xx, xy, .., zz; then the gyros'\n";
  for (int i = 0; i < ImuCalibration::kValues; ++i) {
    std::string row;
    for (int j = 0; j <= i; ++j) row += fmt::format("{}{:.9g}", j == 0 ? "" : ", ", calibration.covariance(i, j));
    text += fmt::format("  - [{}]\n", row);
  }
  return text;
}

}  // namespace coast::io
