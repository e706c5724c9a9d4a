#pragma once
// State and error covariance from knot to knot; private to the room.

#include <optional>

#include "coast/estimate/forward_filter.hpp"
#include "coast/estimate/navigator.hpp"
#include "coast/estimate/transition.hpp"

namespace coast::estimate {

/// Instants closer than this are one: IMU and GNSS tags carry rounding of microseconds at best.
inline constexpr double kTimeTolerance = 2e-6;

/// A gap over which rates and specific forces at its ends tell nothing of the motion in it.
[[nodiscard]] bool is_long_gap(const record::ImuRecording& imu, double span);

/// Where in the recording a walk through it stands.
struct SampleCursor {
  std::size_t next_sample = 0;
  ins::RawIncrement remainder;  ///< of the next sample; dt = 0: it is untouched
};

/// A sample, or the part of one, on the way.
struct SampleStep {
  ins::RawIncrement raw;
  geo::GpsTime at;             ///< its end
  bool whole = true;           ///< it ends a sample
  std::optional<double> span;  ///< s since the sample before, where it begins one
  bool coasting = false;       ///< in place of samples that are missing for long
};

/// Goes through the samples up to `end`, or to where they end. `take` is called with each step, propagates the navigator and
/// sets its time. Where samples are missing for long, a constant velocity and attitude take the place of what was recorded.
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

/// The nominal trajectory and the transition of its errors side by side, with noise that changes over time and with what is not
/// known of the motion while samples are missing.
class Propagation {
 public:
  Propagation(const Mission& mission, const StateLayout& layout);

  void set(const Navigator::Start& start);
  void step(const SampleStep& step);
  /// Ends an interval:  P <- Phi P Phi' + Q
  void close(Eigen::MatrixXd& P);
  /// Corrects the nominal trajectory, and begins an interval.
  void correct(const record::NavState& nav, const Eigen::VectorXd& x);
  /// Of the interval at hand, or of the one that was closed, until the next begins.
  [[nodiscard]] const NavRows& Phi_n() const { return transition_.Phi_n(); }
  [[nodiscard]] WhiteNoise white_noise() const { return transition_.white_noise(); }
  [[nodiscard]] double elapsed() const { return transition_.elapsed(); }
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
  std::size_t noise_level_ = 0;  ///< of the recording, the one at hand
  double missing_share_ = 0.0;   ///< of the sample at hand
  double gap_ = 0.0;             ///< s of missing IMU in the interval
  double gap_before_ = 0.0;      ///< s that the same gap has lasted before it
};

/// The restart at that instant, if there is one.
[[nodiscard]] const Restart* restart_at(const Mission& mission, geo::GpsTime t);

/// Of an interval between two samples, the share that was not measured; jitter of the tags is none.
[[nodiscard]] double missing_share(const record::ImuRecording& imu, double span);

/// What updates may look at where the navigator stands.
/// @param C_n_e  at the position
[[nodiscard]] UpdateContext update_context(const Mission& mission, const StateLayout& layout, const SampleCursor& cursor,
                                           const Navigator& navigator, const Eigen::Matrix3d& C_n_e);

/// Repeats the nominal trajectory from a knot to the next, at `end`: the states at IMU epochs on the way, and the one at `end`.
[[nodiscard]] record::NavState repeat_nominal(const Mission& mission, const Knot& knot, geo::GpsTime end, Navigator& navigator,
                                              std::vector<record::NavState>& epochs);

}  // namespace coast::estimate
