#include "effects.hpp"

namespace coast::diagnose {

Effect accel_temperature_bias() {
  return {
      .name = "accel_temperature_bias",
      .site = Site::kAccel,
      .parameter = "coefficient",
      .unit = "m/s^2/K",
      .equation = "d(f)_i = k_i (T - mean T)",
      .meaning = "The bias of an accelerometer follows the temperature.",
      .sentence = "The bias of accelerometer {axis} changes with the temperature by {size}.",
      .separating_manoeuvre = "Temperatures that rise and fall again; against a slow bias, minutes at constant temperature.",
      .source = "Groves (2013), section 4.4.1",
      .axes = three_axes(),
      .plausible = {1e-3 * kMilliG, 1e-2 * kMilliG, 0.2 * kMilliG, 1.0 * kMilliG},
      .needs_temperature = true,
      .sensors = [](const Signals& s, SensorErrors& error) { error.accel.diagonal().setConstant(s.temperature); },
  };
}

}  // namespace coast::diagnose
