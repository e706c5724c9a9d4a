#pragma once
// State of a search: the accepted run, its reported findings, and what was rejected so far. A value; private to the room.

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "evidence/form_scan.hpp"
#include "evidence/noise_check.hpp"
#include "evidence/random_fit.hpp"
#include "search/movement.hpp"

namespace coast::diagnose {

/// Which of the two comes first if both explain the same. A random effect replaces two mean effects as well as one,
/// and exceeds each of them; dozens of mean effects replace lasting noise. Evidence decides between the outcomes.
enum class Order { kNoiseFirst, kMeansFirst };

struct State;

/// Constant throughout a diagnosis, except for the cached runs.
struct Context {
  DiagnosisOptions options;
  std::optional<estimate::NoiseFitChoice> asked_for;  ///< noise that the run estimates
  Runs& runs;
  /// Told the state in which noise is selected although a mean effect could be; may be empty.
  std::function<void(const State&)> orders_part = {};
  /// Probability of a false alarm by the catalogue: the total minus random effects, lines and relations.
  [[nodiscard]] double false_alarm_of_catalogue() const;
};

/// Effect of a converter in the samples of an axis.
struct Mark {
  const SampleEffect* effect = nullptr;
  int axis = 0;
  double parameter = 0.0;
};

/// Reported findings of an explanation, part by part in its order.
struct Account {
  std::vector<Finding> findings;         ///< selected effects
  std::vector<NoiseFinding> random;      ///< random effects
  std::optional<FittedNoise> noise;      ///< the stated noise
  std::vector<NoiseFinding> converters;  ///< marks whose correction raises the likelihood
  std::vector<Mark> marks;               ///< all of them
};

/// Items that are not proposed again.
struct Exclusions {
  std::vector<Eigen::Index> rejected;   ///< until another effect is selected
  std::vector<Eigen::Index> given_up;   ///< permanently
  std::vector<Eigen::Index> exchanged;  ///< permanently; in another search evidence decides on them
  std::vector<EffectPtr> forms;         ///< permanently
  std::vector<AddedNoise> random;       ///< axes on which no random effect is searched for
  [[nodiscard]] bool excludes(Eigen::Index hypothesis) const;
  [[nodiscard]] bool excludes(const Effect& form) const;
  [[nodiscard]] bool excludes(const AddedNoise& noise) const;
};

/// The last fit of the stated noise, and changes since.
struct NoiseHistory {
  std::optional<estimate::NoiseFit> last;  ///< start of the next fit
  bool tried = false;                      ///< with the current selection
  bool is_behind = false;                  ///< effects were selected or given up since
  double explained = 0.0;                  ///< log-likelihood by effects selected since
};

/// Results of the last examination of a run.
struct Seen {
  Suspicions suspicions;
  std::shared_ptr<const Examination> drawn;  ///< with draws, valid for the next run if covariances are unchanged
  std::vector<FittedEffect> beaten;          ///< random effects that explain less than a mean effect does
  std::optional<std::size_t> stuck;          ///< run from which no change of sizes was likelier
};

/// Biases at the start.
struct AtStart {
  std::vector<TurnOn> beyond;  ///< beyond the error model, reported at the end
  double standstill = 0.0;     ///< log-likelihood of a standstill that is no longer used
};

struct Limits {
  Order order = Order::kNoiseFirst;
  std::size_t most_effects = 0;
  std::optional<double> time_offset_s;  ///< from turns, until it was tried
};

/// A relation's signals are from the trajectory, which is bent by it.
struct SelectedRelation {
  EffectPtr effect;
  double without = 0.0;  ///< log-likelihood before it was selected
};

struct State {
  RunPtr run;               ///< the accepted one
  Explanation explanation;  ///< of the run, or with the sizes estimated in it: base of the next proposals
  Account account;
  Exclusions excluded;
  NoiseHistory noise;
  Seen seen;
  AtStart start;
  std::optional<SelectedRelation> relation;  ///< the last one, unless an effect was removed since
  Limits limits;
};

/// Logarithm of the number of mean effects of which one is chosen.
[[nodiscard]] double log_choices(const State& state);
/// Likelihood ratio above which an effect of the catalogue is accepted.
[[nodiscard]] double threshold(const State& state, const Context& context);
/// Log-likelihood minus the prior cost of effect sizes, onset times and the choice of effects. Explanations are compared by it.
[[nodiscard]] double evidence_of(const State& state);
/// A selected effect is a line's sine or cosine.
[[nodiscard]] bool is_of_a_line(const Finding& finding);
/// Number of coefficients from the first on that are selected together: sine and cosine of a line.
[[nodiscard]] std::size_t selected_together(const Account& account, std::size_t first);
/// Calls `take(first, count)` for each selection.
template <typename Take>
void for_each_selection(const Account& account, const Take& take) {
  for (std::size_t first = 0, count = 0; first < account.findings.size(); first += count)
    take(first, count = selected_together(account, first));
}

/// Sets the standard deviations of sizes from a run.
void note_deviations(State& state, const Movement& step);
/// The state after another run. Findings and exclusions are kept.
[[nodiscard]] State with_run(State state, RunPtr run);
/// The explanation without a selection. @param first  of its coefficients
[[nodiscard]] Explanation explanation_without(const State& state, std::size_t first);
/// Without the selection. Results of the run are in `seen`.
/// @param run  of that explanation
[[nodiscard]] State taken_out(const State& state, std::size_t first, RunPtr run);
/// Removes the selection permanently.
[[nodiscard]] State given_up(const State& state, std::size_t first, Context& context);
/// @param next    with the run without it, not yet its findings
/// @param effect  its first coefficient, as selected
void note_given_up(State& next, std::size_t first, const SelectedEffect& effect);
/// Fits the stated noise again, and uses it in a run if the difference is significant.
[[nodiscard]] State with_fitted_noise(State state, Context& context);
/// Removes effects that became insignificant as others were refined.
[[nodiscard]] State without_insignificant(State state, Context& context);

inline constexpr double kInsignificant = 2.0;  // sd, below which a size is insignificant
inline constexpr double kLogOdds = 7.0;        // of reported alternatives: a thousandth as likely
// The catalogue has the allowed false alarms minus these.
inline constexpr double kNoiseFalseAlarm = 0.01;  // random effects
inline constexpr double kFormFalseAlarm = 0.005;  // lines, and relations

}  // namespace coast::diagnose
