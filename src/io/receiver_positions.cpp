#include "receiver_positions.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "coast/geo/units.hpp"

namespace coast::io {

namespace {

constexpr double kLargestPositionSd = 1e6;  // m
constexpr double kLargestSpeedSd = 1e3;     // m/s

bool possible_sd(double sd, double largest) {
  return sd > 0.0 && sd < largest;
}

}  // namespace

std::optional<Eigen::Vector3d> ecef_if_on_earth(const geo::Geodetic& p) {
  constexpr double kHighestFix = 1e6;  // m
  // Comparisons that NaN does not pass.
  const bool on_earth =
      std::abs(p.latitude) <= 0.5 * geo::kPi && std::abs(p.longitude) <= 2.0 * geo::kPi && std::abs(p.height) < kHighestFix;
  return on_earth ? std::optional(geo::ecef_from_geodetic(p)) : std::nullopt;
}

std::optional<Eigen::Matrix3d> position_covariance(double horizontal_sd, double vertical_sd) {
  if (!possible_sd(horizontal_sd, kLargestPositionSd) || !possible_sd(vertical_sd, kLargestPositionSd)) return std::nullopt;
  const double horizontal = 0.5 * horizontal_sd * horizontal_sd;
  return Eigen::Matrix3d(Eigen::Vector3d(horizontal, horizontal, vertical_sd * vertical_sd).asDiagonal());
}

std::optional<Eigen::Matrix3d> velocity_covariance(double speed_sd) {
  if (!possible_sd(speed_sd, kLargestSpeedSd)) return std::nullopt;
  return Eigen::Matrix3d(speed_sd * speed_sd / 3.0 * Eigen::Matrix3d::Identity());
}

std::optional<Eigen::Matrix3d> covariance_if_positive(const Eigen::Matrix3d& cov) {
  if (!cov.allFinite() || cov.llt().info() != Eigen::Success) return std::nullopt;
  return cov;
}

std::optional<record::FixQuality> quality_of_fix_type(int fix_type) {
  switch (fix_type) {
    case 3:
      return record::FixQuality::kSingle;
    case 4:
      return record::FixQuality::kDgps;
    case 5:
      return record::FixQuality::kFloat;
    case 6:
      return record::FixQuality::kFixed;
    default:
      return std::nullopt;
  }
}

bool ReceiverPositions::take(const ReceiverPosition& position) {
  ++rows_;
  if (!position.solved) return not_solved_.add(), false;
  if (!position.t) return no_time_.add(), false;
  if (!position.r_ea_e || (!position.position_cov_n && !options_.sd)) return no_accuracy_.add(position.t), false;
  record::GnssFix fix;
  fix.t = *position.t + options_.time.offset_s;
  fix.r_ea_e = *position.r_ea_e;
  if (options_.sd)
    fix.position_cov_n = options_.sd->cwiseAbs2().asDiagonal();
  else
    fix.position_cov_n = *position.position_cov_n;
  fix.quality = position.quality;
  fix.satellites = position.satellites;
  add_velocity(position, fix);
  auto& fixes = recording_.fixes;
  if (!order_.accept(fix.t, !fixes.empty() && fixes.back().r_ea_e == fix.r_ea_e)) return false;
  fixes.push_back(fix);
  return true;
}

void ReceiverPositions::add_velocity(const ReceiverPosition& position, record::GnssFix& fix) const {
  constexpr double kFastest = 1e4;  // m/s
  if (!position.v_ea_n || !(position.v_ea_n->norm() < kFastest)) return;
  if (options_.velocity_sd)
    fix.velocity = {*position.v_ea_n, options_.velocity_sd->cwiseAbs2().asDiagonal()};
  else if (position.velocity_cov_n)
    fix.velocity = {*position.v_ea_n, *position.velocity_cov_n};
}

record::GnssRecording ReceiverPositions::finish(record::Events damage, const Missing& missing) {
  if (recording_.fixes.empty()) refuse(missing);
  recording_.source = file_;
  recording_.events = std::move(damage);
  repairs_.finish(rows_, recording_.events);
  using enum record::Event::Severity;
  const auto add = [this](const Counted& counted, const char* kind, const char* what, record::Event::Severity severity) {
    add_counted(recording_.events, file_, counted, {kind, "position", "positions", what, severity});
  };
  add(not_solved_, "no_solution", "without a three-dimensional solution left out", kInfo);
  add(no_time_, "fix_no_time", "before the receiver knew the time left out", kInfo);
  add(no_accuracy_, "fix_no_accuracy", "without accuracy, or not on the Earth, left out", kWarning);
  return std::move(recording_);
}

void ReceiverPositions::refuse(const Missing& missing) const {
  if (rows_ == 0) throw InputError(missing.positions);
  throw InputError({file_, 0,
                    fmt::format("{} positions, but no GNSS fix: {} without a three-dimensional solution, {} without time, {} "
                                "without accuracy",
                                rows_, not_solved_.number, no_time_.number, no_accuracy_.number),
                    "at least one fix",
                    no_time_.number > 0       ? missing.for_time
                    : no_accuracy_.number > 0 ? missing.for_accuracy
                                              : ""});
}

}  // namespace coast::io
