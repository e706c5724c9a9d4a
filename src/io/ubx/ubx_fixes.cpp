// Positions of UBX-NAV-PVT, with the digits of NAV-HPPOSLLH and the covariances of NAV-COV of the same epoch where the file has
// them (u-blox F9 HPG interface description).

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "../binary.hpp"
#include "../ephemerides.hpp"
#include "../repairs.hpp"
#include "coast/geo/earth.hpp"
#include "coast/geo/units.hpp"
#include "ubx_messages.hpp"
#include "ubx_readers.hpp"

namespace coast::io {

namespace {

/// What the messages of one navigation epoch say, as long as they have said it.
struct UbxEpoch {
  std::uint32_t tow_ms = 0;
  std::optional<geo::GpsTime> t;  ///< of NAV-PVT
  struct Solution {
    int kind = 0;  ///< fixType: 2 2-D, 3 3-D, 4 with the receiver's IMU
    bool accepted = false;
    record::FixQuality quality = record::FixQuality::kUnknown;
    int satellites = 0;
    Eigen::Vector3d velocity_n = Eigen::Vector3d::Zero();  ///< m/s
    double speed_sd = 0.0;                                 ///< m/s, three-dimensional
  };
  std::optional<Solution> solution;
  struct Place {
    geo::Geodetic p;
    double horizontal_sd = 0.0;  ///< m, of both components together
    double vertical_sd = 0.0;    ///< m
  };
  std::optional<Place> coarse, fine;  ///< NAV-PVT, NAV-HPPOSLLH
  std::optional<Eigen::Matrix3d> position_cov_n, velocity_cov_n;
};

record::FixQuality quality_of(std::uint8_t flags) {
  constexpr unsigned kFloat = 1, kFixed = 2;
  const unsigned carrier = flags >> 6;
  if (carrier == kFixed) return record::FixQuality::kFixed;
  if (carrier == kFloat) return record::FixQuality::kFloat;
  return (flags & 2U) != 0 ? record::FixQuality::kDgps : record::FixQuality::kSingle;
}

double millimetres(std::string_view payload, std::size_t at) {
  return 1e-3 * number_at<std::int32_t>(payload, at);
}

void take_pvt(std::string_view b, UbxEpoch& epoch) {
  const auto byte = [&](std::size_t at) { return number_at<std::uint8_t>(b, at); };
  UbxEpoch::Solution s;
  s.kind = byte(20);
  s.accepted = (byte(21) & 1U) != 0;
  s.quality = quality_of(byte(21));
  s.satellites = byte(23);
  s.velocity_n = {millimetres(b, 48), millimetres(b, 52), millimetres(b, 56)};
  s.speed_sd = 1e-3 * number_at<std::uint32_t>(b, 68);
  epoch.solution = s;
  epoch.t = pvt_time(b);
  if ((byte(78) & 1U) != 0) return;  // position not valid
  constexpr double kUnit = 1e-7 * geo::kDegree;
  epoch.coarse = {{kUnit * number_at<std::int32_t>(b, 28), kUnit * number_at<std::int32_t>(b, 24), millimetres(b, 32)},
                  1e-3 * number_at<std::uint32_t>(b, 40),
                  1e-3 * number_at<std::uint32_t>(b, 44)};
}

/// Coordinates in two numbers, the second 1e-9 deg and 0.1 mm.
void take_high_precision(std::string_view b, UbxEpoch& epoch) {
  if ((b[3] & 1) != 0) return;  // position not valid
  const auto angle = [&](std::size_t at, std::size_t fine_at) {
    return geo::kDegree * (1e-7 * number_at<std::int32_t>(b, at) + 1e-9 * number_at<std::int8_t>(b, fine_at));
  };
  const double height = millimetres(b, 16) + 1e-4 * number_at<std::int8_t>(b, 26);
  epoch.fine = {
      {angle(12, 25), angle(8, 24), height}, 1e-4 * number_at<std::uint32_t>(b, 28), 1e-4 * number_at<std::uint32_t>(b, 32)};
}

/// Upper triangle NN, NE, ND, EE, ED, DD.
Eigen::Matrix3d triangle_at(std::string_view b, std::size_t at) {
  const auto c = [&](std::size_t i) { return static_cast<double>(number_at<float>(b, at + 4 * i)); };
  Eigen::Matrix3d cov;
  cov << c(0), c(1), c(2), c(1), c(3), c(4), c(2), c(4), c(5);
  return cov;
}

std::optional<Eigen::Matrix3d> positive(const Eigen::Matrix3d& cov) {
  if (!cov.allFinite() || cov.llt().info() != Eigen::Success) return std::nullopt;
  return cov;
}

void take_covariances(std::string_view b, UbxEpoch& epoch) {
  if (b[5] != 0) epoch.position_cov_n = positive(triangle_at(b, 16));
  if (b[6] != 0) epoch.velocity_cov_n = positive(triangle_at(b, 40));
}

class UbxFixReader {
 public:
  UbxFixReader(const GnssFileOptions& options, Format::Near near)
      : options_(options), stream_(options.file, kUbxLog), known_(near), order_(error_, repairs_) {
    if (options.time.gps_week) known_ = geo::GpsTime::from_week(*options.time.gps_week, kHalfWeek);
  }

  record::GnssRecording read() {
    recording_.source = stream_.name();
    MessageFrame frame;
    while (stream_.next(frame)) take(frame);
    finish_epoch();
    recording_.events = ubx_file_events(stream_.census(), recording_.source);
    if (recording_.fixes.empty()) refuse();
    repairs_.finish(rows_, recording_.events);
    report();
    return std::move(recording_);
  }

 private:
  void take(const MessageFrame& frame);
  void begin_epoch(std::uint32_t tow_ms);
  void finish_epoch();
  [[nodiscard]] std::optional<geo::GpsTime> time_of_epoch() const;
  [[nodiscard]] Eigen::Matrix3d position_covariance(const UbxEpoch::Place& place) const;
  void add_velocity(record::GnssFix& fix) const;
  [[noreturn]] void refuse() const;
  void report();

  static constexpr double kHalfWeek = 302400.0;
  const GnssFileOptions& options_;
  FrameStream stream_;
  std::optional<geo::GpsTime> known_;  ///< last time that a message states with its week
  UbxEpoch epoch_;
  Repairs repairs_;
  WeekClock::MakeError error_ = [this](auto found, auto expected, auto what_to_do) {
    return InputError({stream_.name(), 0, fmt::format("position {}: {}", rows_, found), expected, what_to_do});
  };
  TimeOrder order_;
  record::GnssRecording recording_;
  long rows_ = 0, without_ = 0, no_time_ = 0, with_imu_ = 0, no_accuracy_ = 0;
};

void UbxFixReader::take(const MessageFrame& frame) {
  constexpr std::size_t kPvt = 84, kHighPrecision = 36, kCov = 64;
  if (frame.protocol != Protocol::kUbx) return;
  if (const auto t = stated_time(frame)) known_ = t;
  const std::string_view b = frame.payload;
  const auto is = [&](std::uint32_t id, std::size_t size) { return frame.id == id && b.size() >= size; };
  if (is(ubx::kNavPvt, kPvt)) {
    begin_epoch(number_at<std::uint32_t>(b, 0));
    take_pvt(b, epoch_);
  } else if (is(ubx::kNavHpPosLlh, kHighPrecision)) {
    begin_epoch(number_at<std::uint32_t>(b, 4));
    take_high_precision(b, epoch_);
  } else if (is(ubx::kNavCov, kCov)) {
    begin_epoch(number_at<std::uint32_t>(b, 0));
    take_covariances(b, epoch_);
  }
}

void UbxFixReader::begin_epoch(std::uint32_t tow_ms) {
  if (tow_ms == epoch_.tow_ms) return;
  finish_epoch();
  epoch_ = {};
  epoch_.tow_ms = tow_ms;
}

std::optional<geo::GpsTime> UbxFixReader::time_of_epoch() const {
  constexpr std::uint32_t kWeekMs = 604'800'000;
  if (epoch_.t) return epoch_.t;
  // NAV-PVT without a date, or only NAV-HPPOSLLH: seconds of a week that other messages tell.
  if (!known_ || epoch_.tow_ms >= kWeekMs) return std::nullopt;
  return nearest_second_of_week(*known_, 1e-3 * epoch_.tow_ms);
}

/// The horizontal accuracy is of both components together: a stated 14 mm is 10 mm in each.
Eigen::Matrix3d UbxFixReader::position_covariance(const UbxEpoch::Place& place) const {
  if (options_.sd) return options_.sd->cwiseAbs2().asDiagonal();
  if (epoch_.position_cov_n) return *epoch_.position_cov_n;
  const double horizontal = 0.5 * place.horizontal_sd * place.horizontal_sd;
  return Eigen::Vector3d(horizontal, horizontal, place.vertical_sd * place.vertical_sd).asDiagonal();
}

void UbxFixReader::add_velocity(record::GnssFix& fix) const {
  constexpr double kFastest = 1e4, kLargestSd = 1e3;  // m/s
  const UbxEpoch::Solution& s = *epoch_.solution;
  if (s.velocity_n.norm() > kFastest) return;
  if (options_.velocity_sd) {
    fix.velocity = {s.velocity_n, options_.velocity_sd->cwiseAbs2().asDiagonal()};
  } else if (epoch_.velocity_cov_n) {
    fix.velocity = {s.velocity_n, *epoch_.velocity_cov_n};
  } else if (s.speed_sd > 0.0 && s.speed_sd < kLargestSd) {
    fix.velocity = {s.velocity_n, s.speed_sd * s.speed_sd / 3.0 * Eigen::Matrix3d::Identity()};
  }
}

void UbxFixReader::finish_epoch() {
  constexpr int kThreeD = 3, kWithImu = 4;
  constexpr double kLargestSd = 1e6, kHighestFix = 1e6;  // m
  const std::optional<UbxEpoch::Place>& place = epoch_.fine ? epoch_.fine : epoch_.coarse;
  if (!place && !epoch_.solution) return;
  ++rows_;
  const auto& s = epoch_.solution;
  if (!place || (s && (!s->accepted || (s->kind != kThreeD && s->kind != kWithImu)))) {
    ++without_;
    return;
  }
  const auto t = time_of_epoch();
  if (!t) {
    ++no_time_;
    return;
  }
  const bool accuracy = place->horizontal_sd > 0.0 && place->horizontal_sd < kLargestSd && place->vertical_sd > 0.0 &&
                        place->vertical_sd < kLargestSd;
  const bool on_earth = std::abs(place->p.latitude) <= 0.5 * geo::kPi && std::abs(place->p.longitude) <= 2.0 * geo::kPi &&
                        std::abs(place->p.height) < kHighestFix;
  if (!on_earth || (!accuracy && !options_.sd && !epoch_.position_cov_n)) {
    ++no_accuracy_;
    return;
  }
  record::GnssFix fix;
  fix.t = *t + options_.time.offset_s;
  fix.r_ea_e = geo::ecef_from_geodetic(place->p);
  fix.position_cov_n = position_covariance(*place);
  if (s) {
    fix.quality = s->quality;
    fix.satellites = s->satellites;
    add_velocity(fix);
    if (s->kind == kWithImu) ++with_imu_;
  }
  auto& fixes = recording_.fixes;
  if (order_.accept(fix.t, !fixes.empty() && fixes.back().r_ea_e == fix.r_ea_e)) fixes.push_back(fix);
}

void UbxFixReader::refuse() const {
  if (rows_ == 0)
    throw InputError({stream_.name(), 0, "a UBX file without UBX-NAV-PVT and UBX-NAV-HPPOSLLH", "positions",
                      "If it holds UBX-RXM-RAWX, `gnss: {ppk: {rover: .., base: .., nav: [..]}}` computes them."});
  throw InputError({stream_.name(), 0,
                    fmt::format("{} epochs, but no GNSS fix: {} without a three-dimensional solution, {} without a week, {} "
                                "without accuracies",
                                rows_, without_, no_time_, no_accuracy_),
                    "at least one fix", no_time_ > 0 ? "State `gps_week:` beside the file." : ""});
}

void UbxFixReader::report() {
  const auto add = [&](long number, const char* kind, const char* text, record::Event::Severity severity) {
    if (number > 0)
      recording_.events.push_back(
          {severity, kind, fmt::format("{}: {} {}", recording_.source, number, text), std::nullopt, number});
  };
  using enum record::Event::Severity;
  add(without_, "no_solution", "epochs without a three-dimensional solution left out", kInfo);
  add(no_time_, "fix_no_time", "positions before the receiver knew the week left out", kInfo);
  add(no_accuracy_, "fix_no_accuracy", "positions without accuracy, or not on the Earth, left out", kWarning);
  add(with_imu_, "fix_with_imu",
      "positions are of GNSS and the receiver's own IMU together: their errors are correlated over time, and in gaps of GNSS "
      "they are no measurements",
      kWarning);
}

}  // namespace

record::GnssRecording read_ubx_gnss(const GnssFileOptions& options, Format::Near near) {
  return UbxFixReader(options, near).read();
}

}  // namespace coast::io
