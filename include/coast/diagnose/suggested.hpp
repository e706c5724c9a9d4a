#pragma once
// Effects that are not in the catalogue because their form is found from a recording: oscillations, and unnamed relations.

#include <memory>
#include <string>
#include <vector>

#include "coast/diagnose/effect.hpp"

namespace coast::diagnose {

using EffectPtr = std::shared_ptr<const Effect>;

/// harmonic_disturbance of one axis. Two coefficients: of sin(2 pi f t + phase) and of the cosine, t since the recording's
/// start.
/// @param frequency Hz  @param phase rad
[[nodiscard]] EffectPtr harmonic_disturbance(Site site, int axis, double frequency, double phase);

/// `unknown`: the error of an axis is proportional to a product of signals. @param relation  a name of relations()
/// @throws std::invalid_argument  not one of relations()
[[nodiscard]] EffectPtr unknown_relation(Site site, int axis, const std::string& relation);

/// A signal, its magnitude, or the product of two: "omega_z", "|f_x|", "omega_z*speed".
struct Relation {
  std::string name;
  int first = 0;
  int second = -1;  ///< -1: none
  bool magnitude = false;
  /// @param signals  of basic_signals()
  [[nodiscard]] double of(const Eigen::VectorXd& signals) const;
};
[[nodiscard]] const std::vector<Relation>& relations();
/// Rates, forces, angular accelerations, speed, sine and cosine of the heading, temperature.
[[nodiscard]] Eigen::VectorXd basic_signals(const Signals& signals);

}  // namespace coast::diagnose
