#pragma once
// Mean effects of the catalogue that chance does not explain, compared by runs if their scores are not conclusive; private to
// the room.

#include <optional>
#include <vector>

#include "search/movement.hpp"
#include "search/state.hpp"

namespace coast::diagnose {

struct Candidate {
  Suspicion suspicion;
  std::optional<double> by_runs = {};  ///< gain in log-likelihood, if runs were made
  double freed = 0.0;                  ///< prior cost of selected effects that are insignificant with it
  [[nodiscard]] Eigen::Index hypothesis() const { return suspicion.hypothesis; }
  /// With the gain of runs instead of that of the scores, and the cost of an implausible size.
  [[nodiscard]] double log_bayes() const { return by_runs ? *by_runs - suspicion.price() + freed : suspicion.log_bayes; }
};

class Candidates {
 public:
  /// None.
  Candidates() = default;
  /// Those of observable effects, or if there are none, of implausible ones.
  /// @param state, context  must outlive this
  Candidates(const State& state, Context& context);

  [[nodiscard]] bool empty() const { return all_.empty(); }
  /// Whether another explanation with this gain explains more than every candidate, or is likelier including all choice costs;
  /// by runs of the candidates if their scores are not conclusive.
  [[nodiscard]] bool gain_is_exceeded_by(double gain);
  [[nodiscard]] bool evidence_is_exceeded_by(double evidence);
  /// Largest known gain in log-likelihood.
  [[nodiscard]] double gain() const { return gain_; }
  /// The likeliest, by runs if there are several.
  [[nodiscard]] Suspicion likeliest();
  /// Adds a selected effect with its known gain, which is more than its score's if the mission is not linear in it.
  void add_selected(Eigen::Index hypothesis, double gain);
  [[nodiscard]] std::optional<double> gained_by_runs(Eigen::Index hypothesis) const;

 private:
  /// Those that may be selected, with the odds of what happened before.
  [[nodiscard]] std::vector<Suspicion> possible(const std::vector<Suspicion>& suspicions) const;
  void find();
  void bound();
  void run_all();
  /// @param second  null: the filter fails
  void note_runs(Candidate& candidate, const ExplainedRun& first, const Movement& step, const ExplainedRun* second);

  const State* state_ = nullptr;
  Context* context_ = nullptr;
  std::vector<Candidate> all_;  ///< in order of decreasing likelihood
  double gain_ = 0.0;
  double evidence_ = 0.0;  ///< likewise, minus prior cost
};

[[nodiscard]] double evidence_of(const Suspicion& s, const State& state);

}  // namespace coast::diagnose
