#include "entry.hpp"
#include "processes/processes.hpp"

namespace coast::noise {

Registration misalignment() {
  return {"misalignment",
          "two small angles of this axis to the other two: error_i = m_ij x truth_j, each m with prior standard deviation "
          "`sigma`, constant or Gauss-Markov with `correlation_time_s`",
          "{process: misalignment, sigma: 0.5, unit: mrad}", "{process: misalignment, sigma: 0.05, unit: deg}",
          [](const config::Node& entry, const EntryContext& context) -> std::vector<ProcessPtr> {
            GaussMarkovParameters parameters{.name = "misalignment",
                                             .input = Input::kNextAxis,
                                             .sigma = value_with_unit(entry, "sigma", kSmallAngle, context),
                                             .beta = beta_of(entry),
                                             .unit = "rad"};
            const ProcessPtr next = make_gauss_markov(parameters);
            parameters.input = Input::kPrevAxis;
            return {next, make_gauss_markov(parameters)};
          }};
}

}  // namespace coast::noise
