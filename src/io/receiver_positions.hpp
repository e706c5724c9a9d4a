#pragma once
// Positions as receivers state them in messages, to fixes in order of time. Private to the room.

#include <fmt/format.h>

#include <Eigen/Core>
#include <optional>
#include <string>

#include "coast/geo/earth.hpp"
#include "coast/io/gnss.hpp"
#include "counted.hpp"
#include "repairs.hpp"

namespace coast::io {

/// One position. Frames: Earth-fixed coordinates, covariances north, east, down.
struct ReceiverPosition {
  std::optional<geo::GpsTime> t;
  bool solved = true;  ///< in three dimensions
  std::optional<Eigen::Vector3d> r_ea_e;
  std::optional<Eigen::Matrix3d> position_cov_n;
  std::optional<Eigen::Vector3d> v_ea_n;
  std::optional<Eigen::Matrix3d> velocity_cov_n;
  record::FixQuality quality = record::FixQuality::kUnknown;
  std::optional<int> satellites;
};

/// None for coordinates that are not on the Earth, NaN among them.
[[nodiscard]] std::optional<Eigen::Vector3d> ecef_if_on_earth(const geo::Geodetic& p);
/// Receivers state one horizontal accuracy for both components: 14 mm are 10 mm in each. None: not stated, or impossible.
[[nodiscard]] std::optional<Eigen::Matrix3d> position_covariance(double horizontal_sd, double vertical_sd);
/// Likewise one accuracy of the speed for three components.
[[nodiscard]] std::optional<Eigen::Matrix3d> velocity_covariance(double speed_sd);
/// None for a matrix that is no covariance: not positive definite, not finite.
[[nodiscard]] std::optional<Eigen::Matrix3d> covariance_if_positive(const Eigen::Matrix3d& cov);

/// Numbers of autopilots (GPS_FIX_TYPE of MAVLink): 3 3-D, 4 differential, 5 float, 6 fixed; none for all others, which are no
/// solution in three dimensions, or extrapolated.
[[nodiscard]] std::optional<record::FixQuality> quality_of_fix_type(int fix_type);

/// Takes the positions of a file in its order, with the standard deviations and the time offset that the options state.
class ReceiverPositions {
 public:
  /// @param file  its name, which outlives this
  ReceiverPositions(const GnssFileOptions& options, const std::string& file)
      : options_(options), file_(file), order_(error_, repairs_) {}

  /// @return true if it became a fix
  bool take(const ReceiverPosition& position);

  /// What to say of a file without a fix.
  struct Missing {
    InputError::Parts positions;  ///< it has no positions at all
    std::string for_time;         ///< what to do if their times are not known
    std::string for_accuracy;     ///< .. if their accuracies are not
  };
  /// @param damage  events of the file itself, which come first
  /// @throws InputError  no fix, or times out of order
  [[nodiscard]] record::GnssRecording finish(record::Events damage, const Missing& missing);

 private:
  [[noreturn]] void refuse(const Missing& missing) const;
  void add_velocity(const ReceiverPosition& position, record::GnssFix& fix) const;

  const GnssFileOptions& options_;
  const std::string& file_;
  Repairs repairs_;
  WeekClock::MakeError error_ = [this](auto found, auto expected, auto what_to_do) {
    return InputError({file_, 0, fmt::format("position {}: {}", rows_, found), expected, what_to_do});
  };
  TimeOrder order_;
  record::GnssRecording recording_;
  long rows_ = 0;
  Counted not_solved_, no_time_, no_accuracy_;
};

}  // namespace coast::io
