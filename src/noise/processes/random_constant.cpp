#include "entry.hpp"
#include "processes/processes.hpp"

namespace coast::noise {

Registration random_constant() {
  return {"random_constant", "an unknown constant with prior standard deviation `sigma`, drawn once per simulated run",
          "{process: random_constant, sigma: 0.75, unit: deg/h}", "{process: random_constant, sigma: 1, unit: mg}",
          [](const config::Node& entry, const EntryContext& context) -> std::vector<ProcessPtr> {
            return {make_gauss_markov({.name = "random_constant",
                                       .sigma = value_with_unit(entry, "sigma", kSignal, context),
                                       .unit = si_unit(kSignal.of(context.sensor))})};
          }};
}

}  // namespace coast::noise
