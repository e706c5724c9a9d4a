// NMEA 0183 (version 4.00): GGA, RMC, HDT, and PASHR for roll and pitch, in UTC, with checksums.

#include <fmt/format.h>

#include <cmath>

#include "../state_columns.hpp"
#include "coast/geo/units.hpp"
#include "text_trajectory.hpp"
#include "writers.hpp"

namespace coast::io {

namespace {

constexpr double kKnot = 1852.0 / geo::kHour;  // m/s

/// "ddmm.mmmmmmm,N": 1e-7 minutes are 0.2 mm. Rounded as a whole: no minute is 60.
std::string nmea_angle(double radians, int degree_digits, char positive, char negative) {
  constexpr std::int64_t kSteps = 10'000'000, kMinutes = 60;  // per minute, per degree
  const auto steps =
      std::llround(std::abs(radians) / geo::kDegree * static_cast<double>(kMinutes) * static_cast<double>(kSteps));
  const auto whole = steps / (kMinutes * kSteps), minute = steps / kSteps % kMinutes, rest = steps % kSteps;
  return fmt::format("{:0{}}{:02}.{:07},{}", whole, degree_digits, minute, rest, radians < 0.0 ? negative : positive);
}

struct NmeaQuality {
  int gga;    ///< of GGA
  char mode;  ///< of RMC
  int pashr;  ///< of PASHR: 0 none, 1 not fixed, 2 fixed
};

NmeaQuality nmea_quality(const std::optional<record::GnssSupport>& gnss) {
  if (!gnss) return {6, 'E', 0};  // estimated
  switch (gnss->quality) {
    case record::FixQuality::kFixed:
      return {4, 'R', 2};
    case record::FixQuality::kFloat:
      return {5, 'F', 1};
    case record::FixQuality::kSbas:
    case record::FixQuality::kDgps:
      return {2, 'D', 1};
    case record::FixQuality::kPpp:
      return {3, 'P', 1};
    default:
      return {1, 'A', 1};
  }
}

class NmeaWriter final : public TextTrajectory {
 public:
  NmeaWriter(const std::filesystem::path& path, const WriterOptions& options)
      : TextTrajectory(path), geoid_height_(options.geoid_height_m), covariance_(options.covariance) {}

  void write(const record::TrajectoryEpoch& epoch) override {
    constexpr std::int64_t kMillisecond = 1'000'000;
    const geo::GpsTime t = epoch.nav.t;
    const geo::Calendar utc =
        geo::GpsTime::from_nanoseconds((t.nanoseconds() + kMillisecond / 2) / kMillisecond * kMillisecond).utc();
    const std::string clock = fmt::format("{:02}{:02}{:06.3f}", utc.hour, utc.minute, utc.second);
    const LocalState s = local_state(epoch.nav);
    const NmeaQuality quality = nmea_quality(epoch.gnss);
    const std::string place = nmea_angle(s.p.latitude, 2, 'N', 'S') + "," + nmea_angle(s.p.longitude, 3, 'E', 'W');
    put_gga(clock, place, quality.gga, epoch.gnss.value_or(record::GnssSupport{}), s.p.height);
    const double speed = s.v_eb_n.head<2>().norm();
    put(fmt::format("GNRMC,{},A,{},{:.3f},{:.2f},{:02}{:02}{:02},,,{}", clock, place, speed / kKnot,
                    circle(std::atan2(s.v_eb_n.y(), s.v_eb_n.x()), 2), utc.day, utc.month, utc.year % 100, quality.mode));
    put(fmt::format("GNHDT,{:.3f},T", circle(s.attitude.yaw, 3)));
    put_pashr(clock, s.attitude, epoch.cov.attitude, quality.pashr);
  }

 private:
  /// Degrees from 0 to below 360, also once rounded to `decimals`.
  static double circle(double radians, int decimals) {
    const double scale = std::pow(10.0, decimals);
    const double rounded = std::round(radians / geo::kDegree * scale) / scale;
    return rounded < 0.0 ? rounded + 360.0 : rounded >= 360.0 ? 0.0 : rounded + 0.0;
  }

  /// Altitude and geoid's height add to the ellipsoidal height; where the geoid is not known its height is given as 0.
  void put_gga(const std::string& clock, const std::string& place, int quality, const record::GnssSupport& gnss,
               double height) {
    const double geoid = geoid_height_.value_or(0.0);
    put(fmt::format("GNGGA,{},{},{},{:02},,{:.4f},M,{:.4f},M,{},", clock, place, quality, gnss.satellites.value_or(0),
                    height - geoid, geoid, gnss.age_s ? fmt::format("{:.1f}", *gnss.age_s) : ""));
  }

  void put_pashr(const std::string& clock, const geo::Euler& attitude, const Eigen::Matrix3d& cov, int quality) {
    std::string sd = ",,";
    if (covariance_) {
      const Eigen::Matrix3d J = geo::euler_jacobian(attitude);
      const Eigen::Vector3d deg = (J * cov * J.transpose()).diagonal().cwiseMax(0.0).cwiseSqrt() / geo::kDegree;
      sd = fmt::format("{:.3f},{:.3f},{:.3f}", deg.x(), deg.y(), deg.z());
    }
    put(fmt::format("PASHR,{},{:.3f},T,{:+.3f},{:+.3f},,{},{},0", clock, circle(attitude.yaw, 3), attitude.roll / geo::kDegree,
                    attitude.pitch / geo::kDegree, sd, quality));
  }

  void put(const std::string& sentence) {
    unsigned sum = 0;
    for (const char c : sentence) sum ^= static_cast<unsigned char>(c);
    text().put(fmt::format("${}*{:02X}\r", sentence, sum));
    text().end_line();
  }

  std::optional<double> geoid_height_;
  bool covariance_;
};

}  // namespace

TrajectoryFormat nmea_trajectory() {
  TrajectoryFormat format{"nmea", "NMEA 0183: GGA, RMC, HDT, PASHR"};
  format.velocity = format.attitude = true;
  format.make = [](const std::filesystem::path& file, const WriterOptions& options) {
    return std::make_unique<NmeaWriter>(file, options);
  };
  return format;
}

}  // namespace coast::io
