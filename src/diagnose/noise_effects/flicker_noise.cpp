#include "coast/diagnose/correction.hpp"
#include "coast/noise/gauss_markov.hpp"
#include "noise_effects.hpp"

namespace coast::diagnose {

namespace {

// One process per factor of e in correlation time: equal variances add up to a density of B^2/(2 pi f) if
// sigma^2 = B^2/pi (src/noise/processes/flicker.cpp).
constexpr double kRatio = 2.718281828459045;
constexpr double kShortest = 1.0;    // s
constexpr double kLongest = 3000.0;  // s

template <typename Take>
void for_each_time(const Take& take) {
  for (double time = kShortest; time < kLongest; time *= kRatio) take(time);
}

}  // namespace

NoiseEffect flicker_noise(Site site) {
  return {
      .name = "flicker_noise",
      .site = site,
      .parameter = "coefficient",
      .unit = signal_unit(site),
      .equation = "d_i with density B^2/(2 pi f), 1 s to 3000 s",
      .meaning = "Bias instability: the bias wanders as much over hours as over seconds.",
      .separating_manoeuvre = "Hours at rest: the Allan curve stays level where a Gauss-Markov process has a hump.",
      .source = "IEEE Std 952-2020, bias instability",
      .times = {0.0},
      .power =
          [](const Disturbances& d, const Eigen::MatrixXf& score, const std::vector<double>&, double) {
            Eigen::ArrayXf sum = Eigen::ArrayXf::Zero(score.rows());
            for_each_time([&](double time) { sum += gauss_markov_power(d, score, time); });
            return Eigen::ArrayXf(sum / static_cast<float>(geo::kPi));
          },
      .add =
          [site](MissionInput& input, int axis, double root, double, const std::vector<geo::GpsTime>&,
                 const std::vector<double>&) {
            std::vector<noise::ProcessPtr> processes;
            for_each_time([&](double time) {
              processes.push_back(noise::make_gauss_markov({.name = "gauss_markov",
                                                            .sigma = root / std::sqrt(geo::kPi),
                                                            .beta = 1.0 / time,
                                                            .unit = signal_unit(site)}));
            });
            append(processes, sensor_of(site), axis, input);
          },
  };
}

}  // namespace coast::diagnose
