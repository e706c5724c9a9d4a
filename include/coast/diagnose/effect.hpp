#pragma once
// A physical effect that an estimator may have left out, and the table of all that are known.

#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coast/estimate/update.hpp"
#include "coast/study/mission.hpp"

namespace coast::diagnose {

/// How good an IMU is: decides what size of an effect is plausible.
enum class Grade { kNavigation, kTactical, kIndustrial, kConsumer };
/// By the white noise of the gyros: limits 0.03, 0.12 and 0.5 deg/sqrt(h), between the classes of Groves (2013), table 4.1.
[[nodiscard]] Grade grade_of(const noise::ImuErrorModel& model);
[[nodiscard]] std::string_view name(Grade grade);

/// What there is to see at one IMU sample.
struct Signals {
  Eigen::Vector3d omega;          ///< rate against inertial space, sensor axes, rad/s
  Eigen::Vector3d f;              ///< specific force, sensor axes, m/s^2
  Eigen::Vector3d omega_dot;      ///< angular acceleration over some samples, rad/s^2
  Eigen::Vector3d vibration;      ///< variance of the specific force over a second about its mean over two tenths, (m/s^2)^2
  Eigen::Vector3d coning;         ///< what coning adds to the rate: (dtheta' x dtheta) / (12 dt), rad/s
  double temperature = 0.0;       ///< against its mean over the recording, K
  double temperature_rate = 0.0;  ///< K/s
  double elapsed = 0.0;           ///< since the start of the mission, s
  double speed = 0.0;             ///< over ground, m/s
  Eigen::Matrix3d C_e_s;          ///< e to sensor axes
  Eigen::Matrix3d C_n_e;          ///< at the position
};

/// What there is to see at a GNSS position or velocity.
struct FixSignals {
  /// Velocity of the antenna, its turning about the IMU over a tenth of a second, m/s. What a vehicle shakes is not what a
  /// shift of the time by tens of milliseconds moves: at the instant itself it may be half of a slow vehicle's speed.
  Eigen::Vector3d v_ea_e;
  Eigen::Vector3d a_ea_e;   ///< its acceleration, that of the IMU's point over a tenth of a second, m/s^2
  Eigen::Vector3d omega_b;  ///< rate against the Earth, rad/s
  double elapsed = 0.0;     ///< s
  Eigen::Matrix3d C_b_e;
  Eigen::Matrix3d C_n_e;
  [[nodiscard]] double heading() const;  ///< of the body, rad
};

/// What there is to see where a vehicle neither slides nor lifts.
struct WheelSignals {
  Eigen::Vector3d u_b;                       ///< velocity of the constraint's point, body axes, m/s
  const estimate::NonHolonomic& constraint;  ///< as it is configured
};

/// Where an effect has its origin, as results name it.
enum class Site { kGyro, kAccel, kImu, kGnss, kAntenna, kClock, kGravity, kMount };
[[nodiscard]] std::string_view name(Site site);

using Columns = Eigen::Ref<Eigen::Matrix3Xd>;
/// Of gyros and accelerometers per unit of each axis, 3 x axes, sensor axes, rad/s and m/s^2.
struct SensorErrors {
  Columns gyro;
  Columns accel;
};

/// What belongs to an effect and is no coefficient: the frequency of an oscillation.
struct FixedParameter {
  std::string_view name;
  double value = 0.0;
  std::string_view unit;
};

/// A value of the run file that states an effect.
struct RunKey {
  std::string_view section;
  std::string_view name;
  std::function<std::string(const study::Setup&)> text;  ///< the value as the file has it
};

/// One effect: an equation, linear in some coefficients (`axes`) that are judged one by one. measured = true + error.
struct Effect {
  enum class Begins { kWithTheMission, kAtSomeTime };

  std::string_view name{};
  Site site = Site::kImu;
  Begins begins = Begins::kWithTheMission;
  std::string_view lasting{};    ///< of one that begins at some time: the effect that is the same from the start on
  std::string_view parameter{};  ///< what the coefficient is called
  std::string_view unit{};
  std::string_view equation{};
  std::string_view meaning{};               ///< a sentence for people
  std::string_view separating_manoeuvre{};  ///< what would tell it from what it looks like
  std::string_view source{};
  std::vector<std::string> axes{};  ///< "x", or "zy": response z, cause y; "" where there is only one
  /// Scale of what is plausible (of a Cauchy prior: half of all are smaller), by grade; what the effect does not depend on the
  /// IMU for is the same for all.
  std::array<double, 4> plausible{};
  bool needs_temperature = false;
  bool needs_reference = false;  ///< nothing in the recording can show it
  std::function<void(const Signals&, SensorErrors&)> sensors = {};
  /// Errors of a GNSS position per unit of each axis, 3 x axes, e, m; and of a velocity, m/s.
  std::function<void(const FixSignals&, Columns)> position = {};
  std::function<void(const FixSignals&, Columns)> velocity = {};
  /// Errors of the velocity to the right and down of a vehicle that neither slides nor lifts, per unit of each axis, 2 x axes,
  /// m/s.
  std::function<void(const WheelSignals&, Eigen::Ref<Eigen::Matrix2Xd>)> slip = {};
  /// How the configuration takes coefficients exactly; where absent, they are taken out of the recordings.
  std::function<void(study::Setup&, const Eigen::VectorXd&)> configure = {};
  std::optional<RunKey> key = {};  ///< of the run file, where one states the effect
  std::vector<FixedParameter> fixed = {};
  std::string_view relation{};  ///< of an effect that has no name: the product of signals that it is
};

/// Every effect. A new one is a file in src/diagnose/effects and a line in catalogue.cpp.
[[nodiscard]] const std::vector<Effect>& catalogue();

/// {"x", "y", "z"}, and all nine pairs (response first), or those of different axes.
[[nodiscard]] std::vector<std::string> three_axes();
[[nodiscard]] std::vector<std::string> nine_pairs();
[[nodiscard]] std::vector<std::string> six_pairs();

}  // namespace coast::diagnose
