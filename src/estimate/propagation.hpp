#pragma once
// State and error covariance from knot to knot; private to the room.

#include <optional>

#include "coast/estimate/forward_filter.hpp"
#include "coast/estimate/navigator.hpp"
#include "coast/estimate/transition.hpp"

namespace coast::estimate {

/// Instants closer than this are considered equal: IMU and GNSS tags have rounding errors of microseconds at best.
inline constexpr double kTimeTolerance = 2e-6;

/// A gap too long for rates and specific forces at its ends to determine the motion in it.
[[nodiscard]] bool is_long_gap(const record::ImuRecording& imu, double span);

/// Position in the recording of a pass through it.
struct SampleCursor {
  std::size_t next_sample = 0;
  ins::RawIncrement remainder;  ///< of the next sample; dt = 0: it was not started
};

/// A sample, or a part of one.
struct SampleStep {
  ins::RawIncrement raw;
  geo::GpsTime at;             ///< its end
  bool whole = true;           ///< ends at the end of a sample
  std::optional<double> span;  ///< s since the sample before, if it begins a sample
  bool coasting = false;       ///< replaces samples in a long gap
};

/// Goes through the samples up to `end`, or to their end. `take` is called with each step, propagates the navigator and
/// sets its time. In long gaps constant velocity and attitude are assumed.
template <class Take>
void walk(const record::ImuRecording& imu, SampleCursor& cursor, geo::GpsTime end, const Navigator& navigator,
          const Take& take) {
  while (cursor.next_sample < imu.samples.size() && end - navigator.nav().t > kTimeTolerance) {
    const geo::GpsTime now = navigator.nav().t;
    const record::ImuSample& sample = imu.samples[cursor.next_sample];
    SampleStep step{increment_from(imu, cursor.next_sample, cursor.remainder, now), sample.t, true, {}};
    step.coasting = is_long_gap(imu, cursor.next_sample > 0 ? sample.t - imu.samples[cursor.next_sample - 1].t : sample.dt);
    if (step.coasting) step.raw = navigator.coasting(step.raw.dt);
    if (cursor.remainder.dt == 0.0) step.span = sample.t - now;
    cursor.remainder.dt = 0.0;
    if (end - now < step.raw.dt - kTimeTolerance) {
      const ins::SplitIncrement parts = navigator.split(step.raw, (end - now) / step.raw.dt);
      step.raw = parts.first;
      step.at = end;
      step.whole = false;
      cursor.remainder = parts.second;
    } else {
      ++cursor.next_sample;
    }
    take(step);
  }
}

/// The nominal trajectory and the transition of its errors, with noise that varies over time and with the uncertainty of the
/// motion while samples are missing.
class Propagation {
 public:
  Propagation(const Mission& mission, const StateLayout& layout);

  void split_white_noise() { transition_.split_white_noise(); }
  void set(const Navigator::Start& start);
  void step(const SampleStep& step);
  /// Ends an interval:  P <- Phi P Phi' + Q
  void close(Eigen::MatrixXd& P);
  /// Corrects the nominal trajectory, and begins an interval.
  void correct(const record::NavState& nav, const Eigen::VectorXd& x);
  /// For the current interval, or for the last closed one until the next begins.
  [[nodiscard]] const NavRows& Phi_n() const { return transition_.Phi_n(); }
  [[nodiscard]] const NavCov& Q_gyro() const { return transition_.Q_gyro(); }
  [[nodiscard]] const AxisNoise& Q_axes() const { return transition_.Q_axes(); }
  [[nodiscard]] double elapsed() const { return transition_.elapsed(); }
  /// Whether the GNSS error was renewed at the end of the last closed interval.
  [[nodiscard]] bool renewed_gnss_error() const { return renewed_gnss_error_; }
  [[nodiscard]] const Navigator& navigator() const { return navigator_; }

 private:
  void fold();
  void follow_noise_level();
  void add_gap_noise(Eigen::MatrixXd& P);
  void restart(const Restart& at, Eigen::MatrixXd& P);

  const Mission& mission_;
  const StateLayout& layout_;
  Navigator navigator_;
  TransitionAccumulator transition_;
  std::size_t noise_level_ = 0;  ///< index of the current one in the recording
  double missing_share_ = 0.0;   ///< of the current sample
  double gap_ = 0.0;             ///< s of missing IMU in the interval
  double gap_before_ = 0.0;      ///< s of the same gap before the interval
  bool renewed_gnss_error_ = false;
};

/// The restart at that instant, if there is one.
[[nodiscard]] const Restart* restart_at(const Mission& mission, geo::GpsTime t);

/// Whether the fix of that instant has another set of ambiguities than the one before it: one of them is fixed, the other not.
[[nodiscard]] bool new_ambiguities_at(const Mission& mission, geo::GpsTime t);

/// Fraction of an interval between two samples that was not measured; jitter of the tags is ignored.
[[nodiscard]] double missing_share(const record::ImuRecording& imu, double span);

/// Update context at the current state of the navigator.
/// @param C_n_e  at the position
[[nodiscard]] UpdateContext update_context(const Mission& mission, const StateLayout& layout, const SampleCursor& cursor,
                                           const Navigator& navigator, const Eigen::Matrix3d& C_n_e);

/// Repeats the nominal trajectory from a knot to the next, at `end`: the states at IMU epochs between, and the one at `end`.
[[nodiscard]] record::NavState repeat_nominal(const Mission& mission, const Knot& knot, geo::GpsTime end, Navigator& navigator,
                                              std::vector<record::NavState>& epochs);

}  // namespace coast::estimate
