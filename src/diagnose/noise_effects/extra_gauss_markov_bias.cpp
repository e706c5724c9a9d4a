#include "coast/diagnose/correction.hpp"
#include "coast/noise/gauss_markov.hpp"
#include "noise_effects.hpp"

namespace coast::diagnose {

NoiseEffect extra_gauss_markov_bias(Site site) {
  return {
      .name = "extra_gauss_markov_bias",
      .site = site,
      .parameter = "sigma",
      .unit = signal_unit(site),
      .equation = "d_i(t) with E[d_i(t) d_i(t + s)] = sigma^2 exp(-|s|/T)",
      .meaning = "The bias wanders about its mean, more than the model lets it.",
      .separating_manoeuvre = "Hours at rest: `coast calibrate` tells it from flicker and from a random walk.",
      .source = "Stebler et al. (2011), table I",
      .times = {3.0, 10.0, 30.0, 100.0, 300.0, 1000.0},
      .power = [](const Disturbances& d, const Eigen::MatrixXf& score, const std::vector<double>&,
                  double time) { return gauss_markov_power(d, score, time); },
      .add =
          [site](MissionInput& input, int axis, double root, double time, const std::vector<geo::GpsTime>&,
                 const std::vector<double>&) {
            append({noise::make_gauss_markov(
                       {.name = "gauss_markov", .sigma = root, .beta = 1.0 / time, .unit = signal_unit(site)})},
                   sensor_of(site), axis, input);
          },
  };
}

}  // namespace coast::diagnose
