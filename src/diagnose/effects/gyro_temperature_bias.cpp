#include "effects.hpp"

namespace coast::diagnose {

Effect gyro_temperature_bias() {
  return {
      .name = "gyro_temperature_bias",
      .site = Site::kGyro,
      .parameter = "coefficient",
      .unit = "rad/s/K",
      .equation = "d(omega)_i = k_i (T - mean T)",
      .meaning = "The bias of a gyro follows the temperature.",
      .sentence = "The bias of gyro {axis} changes with the temperature by {size}.",
      .separating_manoeuvre = "Temperatures that rise and fall again; against a slow bias, minutes at constant temperature.",
      .source = "Groves (2013), section 4.4.1",
      .axes = three_axes(),
      .plausible = {1e-3 * kDegreePerHour, 0.05 * kDegreePerHour, 5.0 * kDegreePerHour, 50.0 * kDegreePerHour},
      .needs_temperature = true,
      .sensors = [](const Signals& s, SensorErrors& error) { error.gyro.diagonal().setConstant(s.temperature); },
  };
}

}  // namespace coast::diagnose
