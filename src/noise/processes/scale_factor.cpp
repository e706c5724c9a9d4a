#include "entry.hpp"
#include "processes/processes.hpp"

namespace coast::noise {

Registration scale_factor() {
  return {"scale_factor",
          "error = s x truth, s with prior standard deviation `sigma`, constant or Gauss-Markov with `correlation_time_s`",
          "{process: scale_factor, sigma: 300, unit: ppm}", "{process: scale_factor, sigma: 300, unit: ppm}",
          [](const config::Node& entry, const EntryContext& context) -> std::vector<ProcessPtr> {
            return {make_gauss_markov({.name = "scale_factor",
                                       .input = Input::kOwnAxis,
                                       .sigma = value_with_unit(entry, "sigma", kDimensionless, context),
                                       .beta = beta_of(entry),
                                       .unit = "ppm"})};
          }};
}

}  // namespace coast::noise
