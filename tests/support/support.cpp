#include "support/support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

namespace coast::test {

void expect_near_matrix(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double relative_tolerance,
                        const std::string& what) {
  ASSERT_EQ(a.rows(), b.rows()) << what;
  ASSERT_EQ(a.cols(), b.cols()) << what;
  const double scale = std::max(b.norm(), 1e-300);
  EXPECT_LE((a - b).norm() / scale, relative_tolerance) << what << "\n" << a << "\nagainst\n" << b;
}

Eigen::MatrixXd finite_difference(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& f, int inputs, double step) {
  Eigen::MatrixXd jacobian;
  for (int j = 0; j < inputs; ++j) {
    Eigen::VectorXd dx = Eigen::VectorXd::Zero(inputs);
    dx(j) = step;
    const Eigen::VectorXd column = (f(dx) - f(-dx)) / (2.0 * step);
    if (j == 0) jacobian.resize(column.size(), inputs);
    jacobian.col(j) = column;
  }
  return jacobian;
}

namespace {
// Acklam-free: bisection on erfc is exact to rounding and is called a handful of times.
double normal_quantile(double p) {
  double low = -40.0;
  double high = 40.0;
  for (int i = 0; i < 200; ++i) {
    const double mid = 0.5 * (low + high);
    (0.5 * std::erfc(-mid / std::sqrt(2.0)) < p ? low : high) = mid;
  }
  return 0.5 * (low + high);
}
}  // namespace

Chi2Bounds chi2_mean_bounds(double dof, double count, double coverage) {
  const double n = dof * count;
  const auto quantile = [n](double p) {  // Wilson and Hilferty (1931)
    const double c = 2.0 / (9.0 * n);
    return n * std::pow(1.0 - c + normal_quantile(p) * std::sqrt(c), 3);
  };
  return {quantile(0.5 * (1.0 - coverage)) / count, quantile(0.5 * (1.0 + coverage)) / count};
}

std::optional<std::filesystem::path> data_dir() {
  const char* dir = std::getenv("COAST_DATA");
  if (dir == nullptr || *dir == '\0') return std::nullopt;
  return std::filesystem::path(dir);
}

TemporaryDirectory::TemporaryDirectory() {
  std::random_device device;
  path_ = std::filesystem::temp_directory_path() / ("coast-test-" + std::to_string(device()) + std::to_string(device()));
  std::filesystem::create_directories(path_);
}

TemporaryDirectory::~TemporaryDirectory() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace coast::test
