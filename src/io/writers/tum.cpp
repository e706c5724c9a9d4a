// TUM: time, position and quaternion, one line each, as evo and others read trajectories of robots.

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "coast/geo/units.hpp"
#include "local_pose.hpp"
#include "text_trajectory.hpp"
#include "writers.hpp"

namespace coast::io {

namespace {

/// Seconds since 1970 in UTC without leap seconds, as computers stamp images. Exact: a double has no nanoseconds there.
std::string unix_seconds(geo::GpsTime t) {
  constexpr std::int64_t kEpoch = 315'964'800, kBillion = 1'000'000'000;  // 1980-01-06 in seconds since 1970
  const std::int64_t ns = t.nanoseconds() + (kEpoch - geo::leap_seconds(t)) * kBillion;
  return fmt::format("{}.{:09}", ns / kBillion, ns % kBillion);
}

class TumWriter final : public TextTrajectory {
 public:
  explicit TumWriter(const std::filesystem::path& path) : TextTrajectory(path) {}

  void write(const record::TrajectoryEpoch& epoch) override {
    if (!origin_) begin(epoch.nav);
    const Eigen::Vector3d r_n = origin_->to_ned(epoch.nav.r_eb_e);
    Eigen::Quaterniond q(exchanged_axes() * origin_->rotation().transpose() * epoch.nav.q_b_e.toRotationMatrix() *
                         forward_left_up());
    if (q.w() < 0.0) q.coeffs() = -q.coeffs();
    text().put(unix_seconds(epoch.nav.t));
    for (const double x : {r_n.y(), r_n.x(), -r_n.z()}) put(x, 6);
    for (const double x : {q.x(), q.y(), q.z(), q.w()}) put(x, 12);
    text().end_line();
  }

 private:
  void begin(const record::NavState& first) {
    const geo::Geodetic p = geo::geodetic_from_ecef(first.r_eb_e);
    origin_.emplace(p);
    text().put(
        fmt::format("# seconds since 1970 (UTC), x y z (m), qx qy qz qw: body forward-left-up to east-north-up\n"
                    "# origin, latitude and longitude in deg, ellipsoidal height in m: {:.11f} {:.11f} {:.5f}\n",
                    p.latitude / geo::kDegree, p.longitude / geo::kDegree, p.height));
  }
  void put(double value, int decimals) {
    text().put(' ');
    text().put_fixed(value, decimals);
  }

  std::optional<geo::LocalFrame> origin_;
};

}  // namespace

TrajectoryFormat tum_trajectory() {
  TrajectoryFormat format{"tum", "TUM poses: seconds since 1970, position in east-north-up, quaternion"};
  format.attitude = true;
  format.make = [](const std::filesystem::path& file, const WriterOptions&) { return std::make_unique<TumWriter>(file); };
  return format;
}

}  // namespace coast::io
