#pragma once
// Helpers that every room's tests share. Each exists once, here.

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace coast::test {

/// Fails unless |a - b| <= tolerance * max(1e-300, norm of b), element by element in the norm of the whole block.
void expect_near_matrix(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double relative_tolerance, const std::string& what);

/// Central finite differences of f at 0: column j is (f(h e_j) - f(-h e_j)) / 2h.
[[nodiscard]] Eigen::MatrixXd finite_difference(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& f, int inputs,
                                                double step);

/// Two-sided chi-square bounds of the mean of `count` values of chi2(dof), at the given coverage (Wilson-Hilferty).
struct Chi2Bounds {
  double lower;
  double upper;
};
[[nodiscard]] Chi2Bounds chi2_mean_bounds(double dof, double count, double coverage = 0.999);

/// Where the recordings are, from COAST_DATA; nothing where it is not set (the test then skips and says so).
[[nodiscard]] std::optional<std::filesystem::path> data_dir();

/// A fresh directory under the system's temporary one, removed with its contents at the end of the scope.
class TemporaryDirectory {
 public:
  TemporaryDirectory();
  ~TemporaryDirectory();
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace coast::test
