#include "verdict/detectable.hpp"

namespace coast::diagnose {

void tell_what_was_not_found(const State& state, double threshold, Diagnosis& diagnosis) {
  const Hypotheses& hypotheses = state.run->hypotheses();
  std::vector<bool> told(static_cast<std::size_t>(hypotheses.size()), false);
  for (const SelectedEffect& one : state.explanation.effects) told[static_cast<std::size_t>(one.hypothesis)] = true;
  // Suggested forms that were given up are not reported.
  for (Eigen::Index i = 0; i < hypotheses.size(); ++i)
    if (state.explanation.is_suggested(*hypotheses[i].effect)) told[static_cast<std::size_t>(i)] = true;
  const Suspicions beside_found =
      suspicions(state.run->scores(), hypotheses, rows_of(state.explanation.effects, hypotheses.size()));
  for (const Suspicion& s : beside_found.all) {
    if (told[static_cast<std::size_t>(s.hypothesis)]) continue;
    told[static_cast<std::size_t>(s.hypothesis)] = true;
    diagnosis.detectable_not_found.push_back({hypotheses[s.hypothesis], minimal_detectable(s.usual_sd, threshold)});
  }
  for (Eigen::Index i = 0; i < hypotheses.size(); ++i)
    if (!told[static_cast<std::size_t>(i)])
      diagnosis.not_observable.push_back({hypotheses[i], "of what is plausible this mission shows nothing"});
  for (const Effect& effect : catalogue())
    if (const char* reason = hypotheses.why_not_seen(effect)) diagnosis.not_observable.push_back({{&effect, 0, 0.0}, reason});
}

}  // namespace coast::diagnose
