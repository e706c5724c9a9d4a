#pragma once
// Hypotheses with a beginning and an end of their own; private to the room.

#include <functional>
#include <vector>

#include "coast/diagnose/correction.hpp"

namespace coast::diagnose {

/// Hypotheses, followed by some of them again, each while it holds.
class WithSelected : public estimate::Effects {
 public:
  /// @param hypotheses  must outlive it
  WithSelected(const Hypotheses& hypotheses, std::vector<SelectedEffect> selected)
      : hypotheses_(hypotheses), selected_(std::move(selected)) {}

  [[nodiscard]] Eigen::Index size() const override { return row(selected_.size()); }
  /// Of a selected effect.
  [[nodiscard]] Eigen::Index row(std::size_t i) const { return hypotheses_.size() + static_cast<Eigen::Index>(i); }
  [[nodiscard]] bool any_holds(geo::GpsTime t) const;
  void add_sensor_errors(const estimate::SampleView& sample, Eigen::Matrix3Xd& gyro_b,
                         Eigen::Matrix3Xd& accel_b) const override;
  void add_own_slopes(const estimate::SampleView& sample, estimate::OwnSlopes& slopes) const override;
  void add_measurement_errors(const estimate::MeasurementView& measurement, Eigen::MatrixXd& D) const override;
  /// As Hypotheses::add_fix_errors().
  void add_fix_errors(const estimate::MeasurementView& measurement, Eigen::MatrixXd& D) const;

 private:
  void repeat(geo::GpsTime t, Eigen::Ref<Eigen::MatrixXd> columns) const;

  const Hypotheses& hypotheses_;
  std::vector<SelectedEffect> selected_;  ///< by their numbers in `hypotheses_`
};

/// Selected effects alone: a pass over a mission costs what their columns cost, not what the catalogue's do.
class SelectedAlone {
 public:
  /// @param all  must outlive it
  SelectedAlone(const Hypotheses& all, const std::vector<SelectedEffect>& selected);
  SelectedAlone(const SelectedAlone&) = delete;
  SelectedAlone& operator=(const SelectedAlone&) = delete;

  [[nodiscard]] const WithSelected& effects() const { return effects_; }
  /// Sizes as coefficients of all columns of `effects()`.
  [[nodiscard]] Eigen::VectorXd coefficients() const;
  [[nodiscard]] std::vector<Eigen::Index> rows() const;

 private:
  Hypotheses few_;
  std::vector<SelectedEffect> selected_;
  WithSelected effects_;
};

/// Scores and information of selected effects, in their order: log-likelihood ratio = score' c - c' information c / 2 for
/// changes c of their sizes.
struct SizeEvidence {
  Eigen::VectorXd score;
  Eigen::MatrixXd information;
  /// Gain of log-likelihood per unit of each that comes from less noise of a sensor whose signal is made smaller; not in
  /// `score`.
  Eigen::VectorXd own_noise;
};
/// @param knots   of a forward pass with the layout
/// @param counts  innovations at other instants are not used; empty: all are
[[nodiscard]] SizeEvidence evidence_of_sizes(const estimate::Mission& mission, const estimate::StateLayout& layout,
                                             const estimate::KnotStore& knots, const SelectedAlone& selected,
                                             const std::function<bool(geo::GpsTime)>& counts = {});

}  // namespace coast::diagnose
