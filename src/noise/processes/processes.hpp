#pragma once
// The registrations listed in src/noise/registry.cpp; each is defined in the process's own file.

#include "coast/noise/estimable.hpp"
#include "coast/noise/gauss_markov.hpp"
#include "coast/noise/process.hpp"

namespace coast::noise {

Registration white_noise();
Registration random_constant();
Registration random_walk();
Registration gauss_markov();
Registration scale_factor();
Registration misalignment();
Registration drift();
Registration rate_ramp();
Registration flicker();
Registration quantisation();
Registration ar();
Registration share();

/// White noise of the given density, [signal]/sqrt(Hz).
[[nodiscard]] ProcessPtr make_white_noise(double density, Sensor sensor);
/// Their estimables; each is one static object.
[[nodiscard]] const Estimable& estimable_white_noise();
[[nodiscard]] const Estimable& estimable_random_walk();
[[nodiscard]] const Estimable& estimable_gauss_markov();
/// @throws std::invalid_argument  an order beyond 4
[[nodiscard]] const Estimable& estimable_ar(int order);
/// beta from an entry's `correlation_time_s`, 0 if the key is absent.
[[nodiscard]] double beta_of(const config::Node& entry);

}  // namespace coast::noise
