// RTKLIB `.pos` (GPST calendar, degrees, ellipsoidal), positions and velocities with signed-root covariances.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coast/geo/earth.hpp"
#include "coast/geo/units.hpp"
#include "text_trajectory.hpp"
#include "writers.hpp"

namespace coast::io {

namespace {

/// "2025/07/08 19:34:18.499123", rounded to a microsecond without giving second 60: at 100 km/h a millisecond is 3 cm.
void put_calendar(TextBuffer& text, geo::GpsTime t) {
  constexpr std::int64_t kMicrosecond = 1'000;
  const geo::GpsTime rounded =
      geo::GpsTime::from_nanoseconds((t.nanoseconds() + kMicrosecond / 2) / kMicrosecond * kMicrosecond);
  const geo::Calendar c = rounded.calendar();
  text.put_integer(c.year, 4, '0');
  for (const int part : {c.month, c.day}) {
    text.put('/');
    text.put_integer(part, 2, '0');
  }
  text.put(' ');
  text.put_integer(c.hour, 2, '0');
  text.put(':');
  text.put_integer(c.minute, 2, '0');
  text.put(c.second < 9.9999995 ? ":0" : ":");
  text.put_fixed(c.second, 6);
}

/// Additional digits, so that standard deviations below a tenth of a millimetre have four digits of their own. At most
/// seven: enough for a nanometre.
int more_digits(const Eigen::Matrix3d& covariance) {
  constexpr double kUsual = 1e-4;  // m or m/s
  constexpr int kMost = 7;
  int more = 0;
  for (const double variance : covariance.diagonal()) {
    const double sd = std::sqrt(variance);
    if (sd > 0.0 && sd < kUsual) more = std::max(more, -2 - static_cast<int>(std::floor(std::log10(sd))));
  }
  return std::min(more, kMost);
}

/// sdn sde sdu sdne sdeu sdun of a covariance in N, E, D: standard deviations and signed roots.
void put_signed_roots(TextBuffer& text, const Eigen::Matrix3d& ned, int more) {
  const auto signed_root = [](double c) { return std::copysign(std::sqrt(std::abs(c)), c); };
  for (const double value : {std::sqrt(ned(0, 0)), std::sqrt(ned(1, 1)), std::sqrt(ned(2, 2)), signed_root(ned(0, 1)),
                             signed_root(-ned(1, 2)), signed_root(-ned(0, 2))}) {
    text.put(' ');
    text.put_fixed(value, 5 + more, 9 + more);
  }
}

constexpr std::string_view kPosHeader =
    "%  GPST                     latitude(deg) longitude(deg)  height(m)   Q  ns   sdn(m)   sde(m)   sdu(m)  sdne(m)  sdeu(m)  "
    "sdun(m) age(s)  ratio";
constexpr std::string_view kPosVelocityHeader =
    "    vn(m/s)    ve(m/s)    vu(m/s)     sdvn     sdve     sdvu    sdvne    sdveu    sdvun";

/// RTKLIB's Q of a fix; unknown quality counts as single.
int quality_number(record::FixQuality quality) {
  return static_cast<int>(quality == record::FixQuality::kUnknown ? record::FixQuality::kSingle : quality);
}

constexpr int kDeadReckoning = 7;  // RTKLIB's Q of a solution without GNSS

/// One line of a `.pos` file; the velocity may be absent.
void put_pos_line(TextBuffer& text, const record::GnssFix& fix, int quality) {
  const geo::Geodetic p = geo::geodetic_from_ecef(fix.r_ea_e);
  put_calendar(text, fix.t);
  text.put(' ');
  const int more = more_digits(fix.position_cov_n);
  const int finer = std::min(more, 6);  // a double has no sixteenth decimal of a degree
  text.put_fixed(p.latitude / geo::kDegree, 9 + finer, 14 + finer);
  text.put(' ');
  text.put_fixed(p.longitude / geo::kDegree, 9 + finer, 14 + finer);
  text.put(' ');
  text.put_fixed(p.height, 4 + more, 10 + more);
  text.put(' ');
  text.put_integer(quality, 3);
  text.put(' ');
  text.put_integer(fix.satellites.value_or(0), 3);
  put_signed_roots(text, fix.position_cov_n, more);
  text.put(' ');
  text.put_fixed(fix.age_s.value_or(0.0), 2, 6);
  text.put(' ');
  text.put_fixed(fix.ratio.value_or(0.0), 1, 6);
  if (fix.velocity) {
    const Eigen::Vector3d& v = fix.velocity->v_ea_n;
    const int digits = more_digits(fix.velocity->cov_n);
    for (const double component : {v.x(), v.y(), -v.z()}) {
      text.put(' ');
      text.put_fixed(component, 5 + digits, 10 + digits);
    }
    put_signed_roots(text, fix.velocity->cov_n, digits);
  }
  text.end_line();
}

/// Q, ns, age and ratio are those of `gnss`; without GNSS, Q = 7 (dead reckoning) and ns = 0.
class PosWriter final : public TextTrajectory {
 public:
  explicit PosWriter(const std::filesystem::path& path) : TextTrajectory(path) {
    text().put(kPosHeader);
    text().put(kPosVelocityHeader);
    text().end_line();
  }

  void write(const record::TrajectoryEpoch& epoch) override {
    record::GnssFix fix;
    fix.t = epoch.nav.t;
    fix.r_ea_e = epoch.nav.r_eb_e;
    fix.position_cov_n = epoch.cov.position;
    const Eigen::Matrix3d C_n_e = geo::C_n_e(geo::geodetic_from_ecef(fix.r_ea_e));
    fix.velocity = {C_n_e.transpose() * epoch.nav.v_eb_e, epoch.cov.velocity};
    const record::GnssSupport gnss = epoch.gnss.value_or(record::GnssSupport{});
    fix.satellites = gnss.satellites;
    fix.age_s = gnss.age_s;
    fix.ratio = gnss.ratio;
    put_pos_line(text(), fix, epoch.gnss ? quality_number(gnss.quality) : kDeadReckoning);
  }
};

}  // namespace

TrajectoryFormat pos_trajectory() {
  TrajectoryFormat format{"pos", "RTKLIB positions and velocities with covariance"};
  format.velocity = format.covariance = true;
  format.make = [](const std::filesystem::path& file, const WriterOptions&) { return std::make_unique<PosWriter>(file); };
  return format;
}

void write_gnss_pos(const std::filesystem::path& path, const record::GnssRecording& gnss) {
  AtomicFile file(path);
  TextBuffer text(file);
  const bool velocities =
      std::all_of(gnss.fixes.begin(), gnss.fixes.end(), [](const auto& fix) { return fix.velocity.has_value(); });
  text.put(kPosHeader);
  if (velocities) text.put(kPosVelocityHeader);
  text.end_line();
  for (record::GnssFix fix : gnss.fixes) {
    if (!velocities) fix.velocity.reset();  // every row has the same columns
    put_pos_line(text, fix, quality_number(fix.quality));
  }
  text.flush();
  file.commit();
}

}  // namespace coast::io
