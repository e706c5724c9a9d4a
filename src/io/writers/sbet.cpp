// SBET (136-byte records of doubles, rad, little endian) with SMRMSG, the standard deviations (80-byte records), beside it.
// Acceleration (without gravity) and angular rate, both with respect to the Earth and in body axes, are those of `motion`; the
// wander angle is zero: the attitude's yaw is the true heading.

#include <array>
#include <cmath>

#include "../binary.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "writers.hpp"

namespace coast::io {

namespace {

constexpr std::size_t kWriteBlock = std::size_t{1} << 16;

/// Records of doubles, collected into blocks.
class RecordFile {
 public:
  explicit RecordFile(const std::filesystem::path& path) : file_(path) {}
  void put(double value) { append_number(bytes_, value); }
  void end_record() {
    if (bytes_.size() >= kWriteBlock) flush();
  }
  void flush() {
    file_.write(bytes_);
    bytes_.clear();
  }
  void commit() {
    flush();
    file_.commit();
  }

 private:
  AtomicFile file_;
  std::string bytes_;
};

class SbetWriter final : public TrajectoryWriter {
 public:
  /// @param smrmsg  absent: no standard deviations
  SbetWriter(const std::filesystem::path& sbet, const std::optional<std::filesystem::path>& smrmsg) : sbet_(sbet) {
    if (smrmsg) smrmsg_.emplace(*smrmsg);
  }

  void write(const record::TrajectoryEpoch& epoch) override {
    const geo::Geodetic p = geo::geodetic_from_ecef(epoch.nav.r_eb_e);
    const Eigen::Matrix3d C_e_n = geo::C_n_e(p).transpose();
    const Eigen::Vector3d v_eb_n = C_e_n * epoch.nav.v_eb_e;
    const geo::Euler attitude = geo::euler_from_dcm(C_e_n * epoch.nav.q_b_e.toRotationMatrix());
    const double t = epoch.nav.t.sow();
    for (const double value : {t, p.latitude, p.longitude, p.height, v_eb_n.x(), v_eb_n.y(), v_eb_n.z(), attitude.roll,
                               attitude.pitch, attitude.yaw})
      sbet_.put(value);
    sbet_.put(0.0);  // wander angle
    for (const double a : epoch.motion.a_eb_b) sbet_.put(a);
    for (const double omega : epoch.motion.omega_eb_b) sbet_.put(omega);
    sbet_.end_record();
    if (smrmsg_) write_uncertainty(t, epoch.cov, geo::euler_jacobian(attitude));
  }
  void close() override {
    sbet_.commit();
    if (smrmsg_) smrmsg_->commit();
  }

 private:
  /// time; N, E, D position [m]; N, E, D velocity [m/s]; roll, pitch, heading [arcmin]: one sigma.
  void write_uncertainty(double t, const record::NavCovariance& cov, const Eigen::Matrix3d& J) {
    const auto sd = [](const Eigen::Matrix3d& c) { return Eigen::Vector3d(c.diagonal().cwiseMax(0.0).cwiseSqrt()); };
    smrmsg_->put(t);
    for (const double s : sd(cov.position)) smrmsg_->put(s);
    for (const double s : sd(cov.velocity)) smrmsg_->put(s);
    for (const double s : sd(J * cov.attitude * J.transpose())) smrmsg_->put(s / geo::kArcMinute);
    smrmsg_->end_record();
  }

  RecordFile sbet_;
  std::optional<RecordFile> smrmsg_;
};

}  // namespace

TrajectoryFormat sbet_trajectory() {
  TrajectoryFormat format{"sbet", "SBET with rates and accelerations, SMRMSG beside it"};
  format.companion = "smrmsg";
  format.velocity = format.attitude = true;
  format.make = [](const std::filesystem::path& file, const WriterOptions& options) {
    return std::make_unique<SbetWriter>(file, options.covariance ? std::optional(companion_of(file, "smrmsg")) : std::nullopt);
  };
  return format;
}

}  // namespace coast::io
