#pragma once
// Steps after parsing common to all GNSS formats: checks of covariances and of time order.

#include <Eigen/Core>
#include <optional>

#include "coast/io/gnss.hpp"
#include "repairs.hpp"

namespace coast::io {

/// Standard deviations and covariances of three components; `cross` holds the signed roots sign(c) sqrt|c| of the covariances
/// (1,2), (2,3), (3,1), as RTKLIB writes them.
struct SignedRoots {
  Eigen::Vector3d sd;
  Eigen::Vector3d cross = Eigen::Vector3d::Zero();
};

/// Collects fixes row by row.
class GnssBuilder {
 public:
  explicit GnssBuilder(TableReader& table);

  /// Position covariance of a row in the axes of its columns: positive definite, or rejected.
  /// @throws InputError  a standard deviation that is zero, negative or not finite
  [[nodiscard]] Eigen::Matrix3d covariance(const SignedRoots& roots, std::string_view what, std::string_view key);

  /// Row with NaN: omitted and counted.
  void leave_out_nan();
  void add(const record::GnssFix& fix);
  [[nodiscard]] Repairs& repairs() { return repairs_; }
  /// @throws InputError  no fix at all, or too many repairs
  [[nodiscard]] record::GnssRecording finish(const record::Events& more);

 private:
  TableReader& table_;
  Repairs repairs_;
  TimeOrder order_;
  record::GnssRecording recording_;
};

/// Quality from RTKLIB's number; unknown for other numbers.
[[nodiscard]] record::FixQuality quality_from(double number);
/// Covariance in north, east, up to north, east, down.
[[nodiscard]] Eigen::Matrix3d neu_to_ned(const Eigen::Matrix3d& cov);

}  // namespace coast::io
