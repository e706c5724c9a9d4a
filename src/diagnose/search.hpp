#pragma once
// The search for effects, step by step; private to the room.

#include <cmath>
#include <memory>

#include "form_scan.hpp"
#include "mission_run.hpp"
#include "noise_check.hpp"
#include "noise_scan.hpp"
#include "turn_on.hpp"

namespace coast::diagnose {

/// A mean effect of the catalogue that chance does not explain.
struct Candidate {
  Suspicion suspicion;
  std::optional<double> by_runs;  ///< gain in log-likelihood, where runs were made
  double freed = 0.0;             ///< what those cost that are nothing beside it
  [[nodiscard]] Eigen::Index hypothesis() const { return suspicion.hypothesis; }
  /// With the gain of runs for that of the scores, and the price of what is implausible as it is.
  [[nodiscard]] double log_bayes() const { return by_runs ? *by_runs - suspicion.price() + freed : suspicion.log_bayes; }
};
struct Candidates {
  std::vector<Candidate> all;  ///< the likeliest first
  double gain = 0.0;           ///< largest in log-likelihood, as far as known
  double evidence = 0.0;       ///< likewise, less what their sizes and onsets and the choice among effects cost
};

/// Where an examination has what was taken. @param hypotheses  how many there are
[[nodiscard]] std::vector<Eigen::Index> rows_of(const std::vector<Taken>& taken, Eigen::Index hypotheses);

/// By how much the values that were taken move by what a run without them still shows, and their standard deviations.
struct Movement {
  Eigen::VectorXd by, sd;
};
/// @param e  in which those that begin at some time have started
[[nodiscard]] Movement movement(const Examination& e, const std::vector<Taken>& taken);

/// What a converter left in the samples of an axis.
struct Mark {
  const SampleEffect* effect = nullptr;
  int axis = 0;
  double parameter = 0.0;
};
[[nodiscard]] NoiseFinding described(const Mark& mark, double gained);

/// What is taken where both explain the same. A random effect stands for two mean effects as well as for one, and beats each by
/// itself; mean effects by the dozen stand for noise that lasts. Which it is shows in the end (Search::evidence).
enum class Order { kNoiseFirst, kMeansFirst };

/// The mission with what has been taken so far, and the search's next step. A copy is another search that goes on from there.
class Search {
 public:
  Search(const MissionInput& input, const DiagnosisOptions& options, Order order, const study::Progress& progress);

  /// What was taken has the values of the last run behind it. @return  whether something was done that may show more
  bool step();
  Diagnosis finish();

  [[nodiscard]] const MissionRun& run() const { return *run_; }
  [[nodiscard]] const MissionInput& input() const { return current_; }
  /// What is filtered, with biases that were told in the error model.
  [[nodiscard]] MissionInput modelled() const;
  [[nodiscard]] const std::vector<Taken>& taken() const { return taken_; }
  [[nodiscard]] bool has_found_anything() const {
    return !taken_.empty() || !noise_findings().empty() || !added_.empty() || !result_.noise.empty() || !turned_on_.empty();
  }
  [[nodiscard]] bool has_taken_noise() const { return noise_.has_value() || !added_.empty(); }
  [[nodiscard]] std::size_t runs() const { return result_.runs; }
  /// Logarithm of the likelihood, less what was plausible and not so of sizes, onsets and effects: by it whole explanations
  /// are compared.
  [[nodiscard]] double evidence() const;
  /// What another search found where this one found something else, as alternatives.
  /// @param log_odds  by which this explanation is the likelier one
  void tell_of(const Search& other, double log_odds);
  [[nodiscard]] double sd(std::size_t index) const { return result_.findings[index].sd; }
  /// A line or a relation that no catalogue has.
  [[nodiscard]] bool is_suggested(const Effect& effect) const {
    return std::ranges::find(suggested_, &effect, &EffectPtr::get) != suggested_.end();
  }
  /// The mission with other values of what was taken, noise and start as they are.
  [[nodiscard]] MissionInput with_values(const std::vector<Taken>& taken) const;
  /// Of a run with these; endless drift where the filter does not get through.
  [[nodiscard]] Fit fit_with(const std::vector<Taken>& taken) const;
  /// What the last run says. @param counts  nothing: all innovations
  [[nodiscard]] Examination examined(const std::function<bool(geo::GpsTime)>& counts = {}, Eigen::Index draws = 400) const;
  /// Takes an effect back, and runs again.
  void give_up(std::size_t index);
  /// Whether an effect that begins at some time has one that is the same from the start on.
  [[nodiscard]] bool may_have_lasted(std::size_t index) const;
  /// What was there from the start on is explained by an effect that begins later wherever the first fixes on the move
  /// contradict it for a reason of their own, and no single exchange leads from one to the other: that reason has to be found
  /// too. Takes it (all of it, where a share was taken) in its place, likelier or not, with room for one effect more, and never
  /// the other again. @return  whether the recording can show it, and the filter gets through with it
  bool put_lasting_in_place_of(std::size_t index);
  /// Biases at the start that the error model does not have, once all else is found.
  void look_at_start();
  [[nodiscard]] std::size_t turned_on() const { return turned_on_.size(); }
  /// Of a constant the first run makes a bias, about which all others are linearised: no score tells of an effect that is one
  /// during this mission. Takes the most plausible of these as all of the bias, likelier or not, with room for one effect more.
  /// @return  whether there is one, and the filter gets through with it
  bool put_constant_in_place_of_bias(std::size_t index);
  /// Every effect of the catalogue is put to the test once more beside all the others: is it needed, and is it this one?
  /// @return  whether another took its place, or none
  bool review();
  /// What was taken for a share of another effect, and is nothing now that this one is known better.
  void forget_what_vanished();
  void set_held_out(std::size_t index, double gain) { result_.findings[index].held_out_gain = gain; }

 private:
  using RunPtr = std::shared_ptr<const MissionRun>;

  bool look_further();
  [[nodiscard]] double of_catalogue() const;
  /// What draws say beside an examination that had none: those of an earlier run, where they still hold.
  void add_draws(Examination& examination);
  [[nodiscard]] std::size_t most() const { return static_cast<std::size_t>(options_.most_effects); }
  void run_again();
  /// What a run without one of what was taken shows.
  void take_out(std::size_t index);
  /// @param last  a run whose trajectory the effects are taken out along
  void run_from(const MissionRun& last);
  /// Lets what was taken move until it stays where it is.
  void settle();
  /// As run_from. @return  its log-likelihood; minus infinity, and no run, where the filter does not get through
  double likelihood_from(const MissionRun& last);
  /// Runs with the values that coefficients have moved to, half as far as long as that is less likely: a step of Gauss-Newton
  /// may be too long, or, where nothing is linear, wrong. @return  whether they moved at all
  bool run_moved(const std::vector<Taken>& before);
  void run_current();
  /// The filter is linearised about what a run found of the sensors: with biases at their prior mean, tilts are wrong by mrad
  /// until the first manoeuvres, and the square of a tilt looks like a vertical bias that ends there. Not of every run: a prior
  /// that follows each is one more thing that fits, by steps that end nowhere, and runs are compared by their likelihoods. The
  /// first run stands until what it took for errors of the sensors has another explanation.
  struct SensorsAtStart {
    estimate::StateLayout layout;
    Eigen::VectorXd x;
  };
  /// A run, to which a trial that was in vain returns: made again it would be another one, along another trajectory.
  struct Standing {
    RunPtr run;
    MissionInput input;
    std::optional<SensorsAtStart> sensors;
  };
  [[nodiscard]] Standing standing() const { return {run_, current_, sensors_at_start_}; }
  void return_to(Standing&& standing);
  /// Whether a run found errors of the sensors far from those about which it was linearised.
  [[nodiscard]] bool sensors_are_elsewhere(const MissionRun& last) const;
  /// By a run about their prior mean.
  void find_sensors_anew();
  /// From now on the bias is what the error model has of it: another effect has the rest of the constant.
  void share(const TurnOn& bias);
  [[nodiscard]] bool is_shared(const TurnOn& bias) const;
  /// About the means that the error model has of biases that are shared.
  [[nodiscard]] double log_likelihood_of(const MissionRun& run) const;
  void model_noise(MissionInput& input) const;

  // Random effects, converters, and noise that is stated (search_noise.cpp).
  /// What converters do is seen without a filter; whether it matters is not.
  void look_at_samples();
  /// Noise first where it explains more than the likeliest mean effect: a fit of what is stated, or a random effect beside it.
  /// @param form_gain  of a line or a relation
  bool take_noise(const Examination& examination, double form_gain);
  /// Of what is stated, from the last fit on; none where chance explains the difference.
  void fit_noise();
  /// What was taken since the last fit may be what noise stood for. Once nothing else is left to be done, or where that was
  /// much: it costs a hundred runs. Kept where the mission is likelier by it. @return  whether that may show more
  bool fit_noise_again();
  /// The likeliest random effect of an axis, and on the same axis the others, whose gains are set against each other.
  /// @param to_beat  gain of another way to model noise
  bool take_random_effect(const Examination& examination, double to_beat);
  /// A random effect that was taken already and is found again, since the noise beside it was fitted anew, is one: the old one
  /// is taken back.
  std::optional<AddedNoise> drop_same(const AddedNoise& noise);
  /// The size at which a random effect explains most.
  [[nodiscard]] FittedEffect fitted(const AddedNoise& noise) const;
  /// Likewise at the correlation time that does: uphill from one at which it is known, then between those that are looked at.
  /// The root's uncertainty has in it what the time may be wrong by.
  [[nodiscard]] FittedEffect fitted_in_time(FittedEffect fit) const;
  [[nodiscard]] bool was_refused(const AddedNoise& noise) const;
  /// @param fits  the first is taken
  void describe(const std::vector<FittedEffect>& fits, double p_value);

  // Mean effects: of the catalogue, and such that the recording suggests.
  /// The likeliest mean effects of the catalogue that chance does not explain.
  [[nodiscard]] Candidates candidates() const;
  /// Tells a candidate what runs without it gain, the better of its first estimate and the next: scores are linear about
  /// nothing there, and of a large effect tell tens of percent too little or too much.
  void run_without(Candidate& candidate);
  void run_candidates();
  /// As far as this step made runs without it.
  [[nodiscard]] std::optional<double> gained_by_runs(const Suspicion& s) const;
  /// Whether something else explains more than every candidate, or is the likelier explanation with all that choosing costs; by
  /// runs of these where their scores leave it open.
  [[nodiscard]] bool exceeds_candidates(double value, double Candidates::*figure);
  /// Logarithm of the number of mean effects of which one is chosen.
  [[nodiscard]] double log_choices() const { return std::log(static_cast<double>(run_->hypotheses().size())); }
  [[nodiscard]] double evidence_of(const Suspicion& s) const { return s.log_bayes - log_choices(); }
  /// Begins at the time offset that turns tell, where that is likelier. @return  whether it was taken
  bool take_time_offset();
  /// What was taken already stands among the candidates with what it is known to gain, which is more than its score tells where
  /// nothing is linear.
  void reconsider(const Taken& one, double gain);
  /// The last of what was taken is taken out and put to the test again. @return  whether it came back
  bool last_is_confirmed();
  /// The likeliest candidate, by runs where there are several.
  [[nodiscard]] Suspicion winner();
  /// A line or a relation that no catalogue has, where chance does not explain it.
  [[nodiscard]] std::optional<Proposal> likeliest_form(const Examination& examination) const;
  [[nodiscard]] bool was_refused(const Suspicion& s) const;
  [[nodiscard]] bool was_refused(const Proposal& form) const;
  /// Takes an effect and runs without it, and again with all values moved. Where the mission is not linear over the effect's
  /// size the first estimate is too large: it is halved until the likelihood rises. One that never does so is refused until
  /// another was taken.
  /// @return  whether it was taken
  bool makes_likelier(const Suspicion& s);
  /// Its coefficients are found together with those that are taken already. Refused where it does not explain more than the
  /// likeliest effect that has a name.
  void try_out(const Proposal& form);
  /// A relation's signals are of the trajectory, which it bends: one that run after run bends it further until the mission is
  /// less likely than it was without it does not hold. @return  whether there was one
  bool give_up_what_bends();
  /// Whether it still explains more than everything that has a name, which else takes its place.
  /// @param gain  in log-likelihood of what was taken out just now
  bool form_is_confirmed(const Taken& form, const Finding& finding, double gain);
  /// The likeliest frequency near that of a line, which the periodogram knows to a fraction of its width.
  [[nodiscard]] EffectPtr refined(const EffectPtr& line);
  void take(const Suspicion& s);
  [[nodiscard]] Alternative alternative(const Suspicion& s, double log_odds) const;
  /// Coefficients taken follow what the run without them still shows, all together.
  Movement move_all(const Examination& e);
  /// Likewise, with the sd of what was found. @return  by how many of these the farthest moved
  double follow(const Examination& e);

  // For people (search_result.cpp).
  /// Everything found, by name.
  [[nodiscard]] std::vector<Alternative> found() const;
  /// Of the noise that is stated, what the configuration does not want estimated anyway.
  [[nodiscard]] std::vector<NoiseFinding> noise_findings() const;
  /// A relation whose signals are those of an effect of the catalogue, which was not taken because its size is implausible, has
  /// a name after all.
  void name_relations();
  /// An effect that is taken back later by an equal jump the other way lasted until then: a wrong fix.
  void join_entries_with_exits();
  /// Noise of an axis that a converter's mark explains belongs to it.
  void fold_residues();
  /// Sine and cosine become amplitude and phase.
  void join_quadratures();
  void describe_what_was_not_found();

  DiagnosisOptions options_;
  Order order_;
  const study::Progress& progress_;
  MissionInput input_;
  Grade grade_;
  std::optional<estimate::NoiseFitChoice> asked_for_;  ///< noise that the run estimates
  MissionInput current_;
  std::optional<SensorsAtStart> sensors_at_start_;
  std::vector<TurnOn> shared_;
  double forgotten_ = 0.0;  ///< log-likelihood that the standstill was worth
  RunPtr run_;
  std::weak_ptr<const MissionRun> stuck_;  ///< from where no movement was likelier
  std::vector<Taken> taken_;
  std::vector<Eigen::Index> refused_;    ///< until another is taken
  std::vector<Eigen::Index> given_up_;   ///< for good
  std::vector<Eigen::Index> exchanged_;  ///< for good; what they are in another search is told by evidence
  std::optional<Examination> drawn_;
  Suspicions suspicions_;
  Candidates candidates_;  ///< that this step chooses among
  std::optional<FittedNoise> noise_;
  std::optional<estimate::NoiseFit> last_fit_;
  bool noise_tried_ = false;
  bool noise_is_behind_ = false;  ///< something was taken or given up since it was fitted
  double explained_ = 0.0;        ///< log-likelihood by what was taken since
  std::vector<EffectPtr> suggested_;
  std::vector<EffectPtr> refused_forms_;  ///< for good
  struct Relation {
    EffectPtr effect;
    double without = 0.0;  ///< log-likelihood, before it was taken
  };
  std::optional<Relation> relation_;  ///< the last one, as long as nothing was taken out since
  std::vector<AddedNoise> added_;
  std::vector<AddedNoise> refused_noise_;
  std::vector<FittedEffect> beaten_;  ///< random effects that explain less than a mean effect does
  std::vector<NoiseFinding> random_effects_;
  std::vector<TurnOn> turned_on_;
  std::vector<Mark> marks_;
  Diagnosis result_;
};

[[nodiscard]] Alternative alternative(const FittedEffect& fit, double log_odds);
/// Alternatives are told, with the larger of the two, where the data alone and with what is plausible hold them for more than a
/// thousandth as likely: one of them alone names the whole catalogue beside an effect that is hardly more likely than nothing.
[[nodiscard]] std::optional<double> log_odds_told(double by_data, double by_evidence);
/// What a random effect costs in evidence: that it is this one of all, of this size.
/// @param log_sd  of the root of its variance
[[nodiscard]] double price_of_random_effect(double log_sd);
[[nodiscard]] double evidence_of(const FittedEffect& fit);

inline constexpr double kNothing = 2.0;  // sd, below which a size is nothing beside the others
inline constexpr double kLogOdds = 7.0;  // of alternatives that are told: a thousandth as likely
// Of the false alarms that are allowed the catalogue has what these leave.
inline constexpr double kNoiseFalseAlarm = 0.01;  // random effects
inline constexpr double kFormFalseAlarm = 0.005;  // lines, and relations

}  // namespace coast::diagnose
