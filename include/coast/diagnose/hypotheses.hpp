#pragma once
// The catalogue applied to one recording: every observable coefficient, and the effect per unit of each on the samples.

#include <memory>
#include <vector>

#include "coast/diagnose/effect.hpp"
#include "coast/diagnose/suggested.hpp"
#include "coast/estimate/effect_pass.hpp"

namespace coast::diagnose {

/// One coefficient of one effect.
struct Hypothesis {
  const Effect* effect = nullptr;
  Eigen::Index axis = 0;
  double plausible = 0.0;  ///< scale of its Cauchy prior
  [[nodiscard]] bool begins_at_some_time() const { return effect->begins == Effect::Begins::kAtSomeTime; }
  [[nodiscard]] const std::string& axis_name() const { return effect->axes[static_cast<std::size_t>(axis)]; }
};

/// Signals of a recording that need more than one sample, computed once.
class SignalTable {
 public:
  /// @param imu  body axes; must outlive the table
  SignalTable(const record::ImuRecording& imu, const Eigen::Matrix3d& C_s_b);
  [[nodiscard]] bool has_temperature() const { return !imu_.temperature.empty(); }
  /// @param omega_b, f_b  of the sample, body axes, corrected for known errors  @param nav  state near it
  [[nodiscard]] Signals at(std::size_t sample, const Eigen::Vector3d& omega_b, const Eigen::Vector3d& f_b,
                           const record::NavState& nav) const;
  /// Means over a tenth of a second about the beginning of a sample, body axes, as measured.
  struct Means {
    Eigen::Vector3d omega_b = Eigen::Vector3d::Zero();  ///< relative to inertial space, rad/s
    Eigen::Vector3d f_b = Eigen::Vector3d::Zero();      ///< m/s^2
  };
  [[nodiscard]] Means means_about(std::size_t sample) const;

 private:
  const record::ImuRecording& imu_;
  Eigen::Matrix3d C_b_s_;
  std::size_t half_;  ///< samples on either side of a mean
  std::vector<Eigen::Vector3f> vibration_;
  std::vector<float> temperature_rate_;
  double mean_temperature_ = 0.0;
};

/// All coefficients together, as input of effect_pass().
class Hypotheses : public estimate::Effects {
 public:
  /// Effects that need data not in the recording are left out. @param mission  must outlive the set
  /// @param path  the smoothed motion, ascending, used for effects on fixes; must outlive the set. The filter's own velocity
  ///              depends on the last innovations, which would look like an effect of velocity: a time offset
  /// @param filter  its vehicle constraints are used; must outlive the set
  /// @param suggested  appended to the catalogue; must outlive the set
  Hypotheses(const estimate::Mission& mission, const estimate::FilterOptions& filter, Grade grade,
             const std::vector<record::NavState>& path, const std::vector<EffectPtr>& suggested);
  /// Of others only those effects, with all their axes, that have at least one of some coefficients.
  Hypotheses(const Hypotheses& all, const std::vector<Eigen::Index>& kept);

  [[nodiscard]] Eigen::Index size() const override { return static_cast<Eigen::Index>(all_.size()); }
  [[nodiscard]] const std::vector<Hypothesis>& all() const { return all_; }
  [[nodiscard]] const Hypothesis& operator[](Eigen::Index i) const { return all_[static_cast<std::size_t>(i)]; }
  /// Index of the hypothesis of a bias step of a sensor axis. @param axis  0 to 2
  [[nodiscard]] Eigen::Index bias_step(Site site, Eigen::Index axis) const;
  /// Why an effect is left out; null if it is not.
  [[nodiscard]] const char* why_not_seen(const Effect& effect) const;
  /// Whether the error of an axis depends on what that axis measures: then its noise looks like the effect
  /// (estimate::effect_pass).
  [[nodiscard]] bool grows_with_own_signal(Eigen::Index i) const { return grows_[static_cast<std::size_t>(i)]; }
  /// Signals in sensor axes at a sample.
  [[nodiscard]] Signals signals(const estimate::SampleView& sample) const;
  void add_sensor_errors(const estimate::SampleView& sample, Eigen::Matrix3Xd& gyro_b,
                         Eigen::Matrix3Xd& accel_b) const override;
  void add_own_slopes(const estimate::SampleView& sample, estimate::OwnSlopes& slopes) const override;
  void add_measurement_errors(const estimate::MeasurementView& measurement, Eigen::MatrixXd& D) const override;
  /// Errors of the fix only, without the effect of gyro errors on the prediction. @param measurement  position or velocity of a
  /// fix
  void add_fix_errors(const estimate::MeasurementView& measurement, Eigen::MatrixXd& D) const;

 private:
  struct Part {
    const Effect* effect;
    Eigen::Index first;  ///< of its columns
    Eigen::Index count;
  };
  void add(const Effect& effect, double plausible);
  void find_own_slopes();
  [[nodiscard]] estimate::OwnSlopes own_slopes(const Signals& at) const;
  /// Errors in sensor axes.
  void add_errors(const Signals& at, Eigen::Matrix3Xd& gyro, Eigen::Matrix3Xd& accel) const;
  [[nodiscard]] record::NavState smoothed(const record::NavState& filtered) const;
  void add_slip(const estimate::MeasurementView& measurement, Eigen::MatrixXd& D) const;
  /// Errors of the measured rate, which enter the filter's prediction for a point away from the IMU, body axes.
  [[nodiscard]] Eigen::Matrix3Xd rate_errors(const estimate::MeasurementView& measurement, Eigen::Index columns) const;

  const estimate::Mission& mission_;
  const estimate::FilterOptions& filter_;
  const std::vector<record::NavState>& path_;
  std::shared_ptr<const SignalTable> signals_;
  std::vector<Hypothesis> all_;
  std::vector<Part> parts_;
  std::vector<bool> grows_;  ///< by hypothesis
};

}  // namespace coast::diagnose
