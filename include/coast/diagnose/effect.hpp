#pragma once
// A physical effect that may be missing in the estimator's model, and the catalogue of all effects.

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

/// Grade of an IMU: determines the plausible size of an effect.
enum class Grade { kNavigation, kTactical, kIndustrial, kConsumer };
/// From the white noise of the gyros: limits 0.03, 0.12 and 0.5 deg/sqrt(h), between the classes of Groves (2013), table 4.1.
[[nodiscard]] Grade grade_of(const noise::ImuErrorModel& model);
[[nodiscard]] std::string_view name(Grade grade);

/// Signals at one IMU sample.
struct Signals {
  Eigen::Vector3d omega;          ///< rate relative to inertial space, sensor axes, rad/s
  Eigen::Vector3d f;              ///< specific force, sensor axes, m/s^2
  Eigen::Vector3d omega_dot;      ///< angular acceleration over some samples, rad/s^2
  Eigen::Vector3d vibration;      ///< variance of the specific force over a second about its mean over two tenths, (m/s^2)^2
  Eigen::Vector3d coning;         ///< coning contribution to the rate: (dtheta' x dtheta) / (12 dt), rad/s
  double temperature = 0.0;       ///< relative to its mean over the recording, K
  double temperature_rate = 0.0;  ///< K/s
  double elapsed = 0.0;           ///< since the start of the mission, s
  double speed = 0.0;             ///< over ground, m/s
  Eigen::Matrix3d C_e_s;          ///< e to sensor axes
  Eigen::Matrix3d C_n_e;          ///< at the position
};

/// Signals at a GNSS position or velocity.
struct FixSignals {
  /// Velocity of the antenna, with the rotation about the IMU averaged over a tenth of a second, m/s. Vibration is not part of
  /// the motion over a time shift of tens of milliseconds, but its instantaneous velocity may be half of a slow vehicle's
  /// speed.
  Eigen::Vector3d v_ea_e;
  Eigen::Vector3d a_ea_e;   ///< acceleration of the IMU, averaged over a tenth of a second, m/s^2
  Eigen::Vector3d omega_b;  ///< rate relative to the Earth, rad/s
  double elapsed = 0.0;     ///< s
  Eigen::Matrix3d C_b_e;
  Eigen::Matrix3d C_n_e;
  [[nodiscard]] double heading() const;  ///< of the body, rad
};

/// Signals for the non-holonomic constraint of a vehicle.
struct WheelSignals {
  Eigen::Vector3d u_b;                       ///< velocity of the constraint point, body axes, m/s
  const estimate::NonHolonomic& constraint;  ///< as configured
};

/// Origin of an effect, as named in results.
enum class Site { kGyro, kAccel, kImu, kGnss, kAntenna, kClock, kGravity, kMount };
[[nodiscard]] std::string_view name(Site site);

using Columns = Eigen::Ref<Eigen::Matrix3Xd>;
/// Errors of gyros and accelerometers per unit of each axis, 3 x axes, sensor axes, rad/s and m/s^2.
struct SensorErrors {
  Columns gyro;
  Columns accel;
};

/// A parameter of an effect that is not a coefficient, e.g. the frequency of an oscillation.
struct FixedParameter {
  std::string_view name;
  double value = 0.0;
  std::string_view unit;
};

/// A value of the run file that states an effect.
struct RunKey {
  std::string_view section;
  std::string_view name;
  std::function<std::string(const study::Setup&)> text;  ///< the value as written in the file
};

/// One effect: an equation, linear in some coefficients (`axes`) that are tested one by one. measured = true + error.
struct Effect {
  enum class Begins { kWithTheMission, kAtSomeTime };

  std::string_view name{};
  Site site = Site::kImu;
  Begins begins = Begins::kWithTheMission;
  std::string_view lasting{};    ///< if it begins at some time: the corresponding effect over the whole mission
  std::string_view parameter{};  ///< name of the coefficient
  std::string_view unit{};
  std::string_view equation{};
  std::string_view meaning{};  ///< a sentence for the user
  /// A sentence of one that was found, in plain words: {size} with its unit and sigma, {axis} (the response, of a pair),
  /// {cause}, and {way}, for which `ways` has a word for positive sizes and one for negative ones, the same for all axes or by
  /// axis.
  std::string_view sentence{};
  std::vector<std::array<std::string_view, 2>> ways{};
  /// Of an effect that may begin many times in a mission, which all together are one finding: a sentence with {times}
  /// ("3 times") and the largest {size}.
  std::string_view sentence_of_many{};
  std::string_view separating_manoeuvre{};  ///< manoeuvre that would separate it from similar effects
  std::string_view source{};
  std::vector<std::string> axes{};  ///< "x", or "zy": response z, cause y; "" where there is only one
  /// Plausible size (scale of a Cauchy prior: half of all are smaller), by grade; the same for all grades if it does not depend
  /// on the IMU.
  std::array<double, 4> plausible{};
  bool needs_temperature = false;
  bool needs_reference = false;  ///< not observable from the recording alone
  std::function<void(const Signals&, SensorErrors&)> sensors = {};
  /// Errors of a GNSS position per unit of each axis, 3 x axes, e, m; and of a velocity, m/s.
  std::function<void(const FixSignals&, Columns)> position = {};
  std::function<void(const FixSignals&, Columns)> velocity = {};
  /// Errors of the velocity right and down in the non-holonomic constraint, per unit of each axis, 2 x axes, m/s.
  std::function<void(const WheelSignals&, Eigen::Ref<Eigen::Matrix2Xd>)> slip = {};
  /// Applies coefficients exactly in the configuration; if absent, the recordings are corrected.
  std::function<void(study::Setup&, const Eigen::VectorXd&)> configure = {};
  std::optional<RunKey> key = {};  ///< key of the run file that states the effect, if there is one
  std::vector<FixedParameter> fixed = {};
  std::string_view relation{};  ///< for an unnamed effect: its product of signals
  [[nodiscard]] bool repeats() const { return !sentence_of_many.empty(); }
};

/// Every effect. A new one is a file in src/diagnose/effects and a line in catalogue.cpp.
[[nodiscard]] const std::vector<Effect>& catalogue();

/// {"x", "y", "z"}, and all nine pairs (response first), or those of different axes.
[[nodiscard]] std::vector<std::string> three_axes();
[[nodiscard]] std::vector<std::string> nine_pairs();
[[nodiscard]] std::vector<std::string> six_pairs();

}  // namespace coast::diagnose
