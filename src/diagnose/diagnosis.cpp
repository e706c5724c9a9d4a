#include "coast/diagnose/diagnosis.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "form_scan.hpp"
#include "mission_run.hpp"
#include "noise_check.hpp"
#include "noise_scan.hpp"

namespace coast::diagnose {

namespace {

constexpr double kContradicted = 4.0;  // sd of the innovations' variance or correlation, from where noise is fitted
constexpr double kSettled = 0.1;       // sd that a coefficient may still move
// Alternatives are told where the data alone, or with what is plausible, hold them for more than a thousandth as likely.
constexpr double kLogOdds = 7.0;
// Of the false alarms that are allowed the catalogue has what these leave.
constexpr double kNoiseFalseAlarm = 0.01;  // random effects
constexpr double kFormFalseAlarm = 0.005;  // lines, and relations
constexpr double kStable = 0.5;            // of a relation, from where it is believed
constexpr double kUncertain = 0.1;         // of a likelihood ratio whose variance is that of some hundred draws
constexpr double kLeastOfSamples = 3.0;    // logarithm of the likelihood ratio, from where a converter's mark matters
constexpr std::size_t kMostRandom = 4;

/// A start that the data decide: it was found by a run that knew nothing of the effect, which may be in it. The filter is
/// linearised about what that run found of the sensors too: with biases at their prior mean, tilts are wrong by mrad until the
/// first manoeuvres, and the square of a tilt looks like a vertical bias that ends there.
void loosen_start(const study::PreparedMission& mission, const estimate::SmoothedKnot& smoothed,
                  const estimate::StateLayout& layout, MissionInput& input) {
  constexpr double kPosition = 1.0;  // m
  constexpr double kVelocity = 0.3;  // m/s
  constexpr double kAttitude = 3.0;  // times the alignment's
  ins::InitialState start = mission.start();
  start.nav = smoothed.nav;
  start.sd_position_n = start.sd_position_n.cwiseMax(kPosition);
  start.sd_velocity_n = start.sd_velocity_n.cwiseMax(kVelocity);
  if (!mission.setup().start) {
    start.sd_attitude_n *= kAttitude;
    if (start.gyro_bias_sd) *start.gyro_bias_sd *= kAttitude;
  }
  input.setup.start = start;
  input.setup.start_sensor_errors = sensor_states_in(layout_of(input), layout, smoothed.x);
}

/// The mission with what has been taken so far, and the search's next step.
class Search {
 public:
  Search(const MissionInput& input, const DiagnosisOptions& options, const study::Progress& progress)
      : options_(options), progress_(progress), input_(input), grade_(grade_of(input.setup.model)) {
    input_.setup.filter.gate_probability = 0.0;  // what a gate refuses cannot be explained
    input_.setup.noise_fit.reset();
    run();
    run();  // from a start that is loose
    result_.grade = grade_;
    result_.before = run_->fit();
    result_.innovations_before = run_->solution().forward.innovations;
    look_at_samples();
  }

  /// @return  whether something was done that may show more
  bool step() {
    const Examination examination = examined();
    const bool settled = follow(examination);
    suspicions_ = suspicions(examination, run_->hypotheses(), of_whole_mission());
    result_.threshold = suspicions_.chance.quantile(of_catalogue());
    const Suspicion* best = result_.findings.size() < most() ? likeliest() : nullptr;
    const double mean_gain = best != nullptr ? 0.5 * best->likelihood_ratio : 0.0;
    const std::optional<Proposal> form = result_.findings.size() < most() ? likeliest_form(examination) : std::nullopt;
    const double form_gain = form ? 0.5 * form->likelihood_ratio - form->log_places : 0.0;
    if (take_noise(examination, std::max(mean_gain, form ? form_gain + kUncertain * form->likelihood_ratio : 0.0))) {
      run();
      return true;
    }
    if (form && form_gain > mean_gain && try_out(*form)) return true;
    if (best == nullptr && settled) return false;
    if (best == nullptr) {
      run();
      return true;
    }
    try_out(Suspicion(*best));
    return true;
  }

  Diagnosis finish() {
    describe_what_was_not_found();
    if (noise_) std::ranges::copy(noise_->findings, std::back_inserter(result_.noise));
    std::ranges::move(random_effects_, std::back_inserter(result_.noise));
    for (std::size_t i = 0; i < result_.findings.size(); ++i) result_.findings[i].value = taken_[i].value;
    join_entries_with_exits();
    join_quadratures();
    result_.suggested.insert(result_.suggested.end(), suggested_.begin(), suggested_.end());
    result_.after = run_->fit();
    result_.innovations_after = run_->solution().forward.innovations;
    result_.modelled = std::move(current_);
    return std::move(result_);
  }

 private:
  [[nodiscard]] Examination examined() const {
    return examine(run_->mission(), run_->layout(), run_->solution().knots, run_->hypotheses(), {.seed = options_.seed});
  }
  [[nodiscard]] double of_catalogue() const {
    return std::max(0.5 * options_.false_alarm_probability,
                    options_.false_alarm_probability - kNoiseFalseAlarm - 2.0 * kFormFalseAlarm);
  }
  [[nodiscard]] std::size_t most() const { return static_cast<std::size_t>(options_.most_effects); }

  void run() {
    if (run_ == nullptr) {
      current_ = input_;
      run_current();
      return;
    }
    const std::unique_ptr<MissionRun> last = std::move(run_);
    run_from(*last);
  }
  /// @param last  a run whose trajectory the effects are taken out along
  void run_from(const MissionRun& last) {
    current_ = without(taken_, input_, last.hypotheses(), last.path(), last.mission(), last.layout());
    model_noise();
    loosen_start(last.prepared(), last.solution().smoothed.front(), last.layout(), current_);
    run_current();
  }
  void model_noise() {
    if (noise_) {
      current_.setup.model = estimate::adjusted(current_.setup.model, noise_->fit.adjustment);
      current_.setup.filter = estimate::adjusted(current_.setup.filter, noise_->fit.adjustment);
    }
    for (const AddedNoise& one : added_) one.add_to(current_);
  }
  void run_current() {
    run_ = std::make_unique<MissionRun>(current_, grade_, suggested_, progress_);
    ++result_.runs;
  }

  /// What converters do is seen without a filter; whether it matters is not.
  void look_at_samples() {
    for (const SampleEffect& effect : sample_catalogue())
      for (int axis = 0; axis < 3; ++axis) {
        const std::optional<double> found = effect.find(axis_series(input_, effect.site, axis));
        if (!found) continue;
        const double before = run_->log_likelihood();
        MissionInput stated = input_;
        effect.model(input_, effect.site, axis, *found);
        run();
        const double gained = run_->log_likelihood() - before;
        if (gained < kLeastOfSamples) {
          input_ = std::move(stated);
          run();
          continue;
        }
        result_.noise.push_back({.name = std::string(effect.name),
                                 .sensor = std::string(name(effect.site)),
                                 .axis = axis_letter(axis),
                                 .parameter = std::string(effect.parameter),
                                 .unit = std::string(effect.unit),
                                 .value = *found,
                                 .sd = 0.0,
                                 .delta_log_likelihood = gained,
                                 .p_value = std::exp(-gained),
                                 .place = NoiseFinding::Place::kEffects,
                                 .meaning = std::string(effect.meaning),
                                 .equation = std::string(effect.equation),
                                 .separating_manoeuvre = std::string(effect.separating_manoeuvre)});
      }
  }
  static std::string axis_letter(int axis) { return {static_cast<char>('x' + axis)}; }

  /// Noise first where it explains more than the likeliest mean effect: a fit of what is stated, or a random effect beside it.
  bool take_noise(const Examination& examination, double mean_gain) {
    std::optional<FittedNoise> stated;
    if (!noise_ && !noise_tried_ && contradiction(run_->solution().forward.innovations) > kContradicted) {
      noise_tried_ = true;
      stated = fitted_noise(run_->prepared(), last_fit_, progress_);
      if (stated) last_fit_ = stated->fit;
    }
    const double stated_gain = stated ? stated->gain() : 0.0;
    if (added_.size() < kMostRandom && take_random_effect(examination, std::max(mean_gain, stated_gain))) return true;
    if (!stated || stated_gain <= mean_gain) return false;
    noise_ = std::move(stated);
    return true;
  }

  /// The likeliest random effect of an axis, and on the same axis the others, whose gains are set against each other.
  bool take_random_effect(const Examination& examination, double to_beat) {
    beaten_.clear();
    const NoiseSuspicions suspected = noise_suspicions(examination, *run_);
    const NoiseSuspicion* first = nullptr;
    for (const NoiseSuspicion& s : suspected.all)
      if (s.p_value < kNoiseFalseAlarm && !was_refused(s.noise) &&
          (first == nullptr || s.likelihood_ratio > first->likelihood_ratio))
        first = &s;
    if (first == nullptr) return false;
    std::vector<FittedEffect> fits;
    for (const NoiseEffect& effect : noise_catalogue())
      if (const NoiseSuspicion* s = strongest(suspected, effect, first->noise))
        fits.push_back(fitted_effect(s->noise, current_, run_->layout(), run_->log_likelihood()));
    std::ranges::sort(fits, std::ranges::greater{}, &FittedEffect::gain);
    const FittedEffect& best = fits.front();
    const double p_value = suspected.chance.p_value(2.0 * std::max(0.0, best.gain));
    if (p_value > kNoiseFalseAlarm || best.gain <= to_beat) {
      if (p_value > kNoiseFalseAlarm) refused_noise_.push_back(first->noise);
      beaten_ = std::move(fits);
      return false;
    }
    describe(fits, p_value);
    added_.push_back(best.noise);
    return true;
  }
  [[nodiscard]] bool was_refused(const AddedNoise& noise) const {
    return std::ranges::any_of(refused_noise_, [&](const AddedNoise& other) {
      return other.axis == noise.axis && other.effect->site == noise.effect->site;
    });
  }
  static const NoiseSuspicion* strongest(const NoiseSuspicions& suspected, const NoiseEffect& effect, const AddedNoise& beside) {
    const NoiseSuspicion* best = nullptr;
    for (const NoiseSuspicion& s : suspected.all)
      if (s.noise.effect == &effect && effect.site == beside.effect->site && s.noise.axis == beside.axis &&
          (best == nullptr || s.likelihood_ratio > best->likelihood_ratio))
        best = &s;
    return best;
  }
  [[nodiscard]] static Alternative alternative(const FittedEffect& fit, double gain) {
    return {std::string(fit.noise.effect->name), std::string(name(fit.noise.effect->site)), axis_letter(fit.noise.axis),
            gain - fit.gain};
  }
  [[nodiscard]] Alternative alternative(const Suspicion& s, double log_odds) const {
    const Hypothesis& h = run_->hypotheses()[s.hypothesis];
    return {std::string(h.effect->name), std::string(name(h.effect->site)), h.axis_name(), log_odds};
  }

  /// @param fits  the first is taken
  void describe(const std::vector<FittedEffect>& fits, double p_value) {
    const FittedEffect& f = fits.front();
    NoiseFinding finding{.name = std::string(f.noise.effect->name),
                         .sensor = std::string(name(f.noise.effect->site)),
                         .axis = axis_letter(f.noise.axis),
                         .parameter = std::string(f.noise.effect->parameter),
                         .unit = std::string(f.noise.effect->unit),
                         .value = f.noise.root,
                         .sd = f.noise.root * f.log_sd,
                         .delta_log_likelihood = f.gain,
                         .p_value = p_value,
                         .place = f.noise.effect->level ? NoiseFinding::Place::kEffects : NoiseFinding::Place::kErrorModel,
                         .time_s = f.noise.time,
                         .meaning = std::string(f.noise.effect->meaning),
                         .equation = std::string(f.noise.effect->equation),
                         .separating_manoeuvre = std::string(f.noise.effect->separating_manoeuvre)};
    for (std::size_t i = 1; i < fits.size(); ++i)
      if (f.gain - fits[i].gain < kLogOdds) finding.alternatives.push_back(alternative(fits[i], f.gain));
    for (const Suspicion& s : suspicions_.all)
      if (f.gain - 0.5 * s.likelihood_ratio < kLogOdds)
        finding.alternatives.push_back(alternative(s, f.gain - 0.5 * s.likelihood_ratio));
    std::ranges::sort(finding.alternatives, {}, &Alternative::log_odds);
    random_effects_.push_back(std::move(finding));
  }

  [[nodiscard]] std::vector<Eigen::Index> of_whole_mission() const {
    std::vector<Eigen::Index> indices;
    for (const Taken& one : taken_)
      if (!one.from) indices.push_back(one.hypothesis);
    return indices;
  }

  /// Coefficients taken follow what the run without them still shows. @return whether they rest
  bool follow(const Examination& e) {
    const std::vector<Eigen::Index> whole = of_whole_mission();
    bool settled = true;
    const auto move = [&](std::size_t i, double by, double sd) {
      taken_[i].value += by;
      result_.findings[i].sd = sd;
      settled = settled && std::abs(by) < kSettled * sd;
    };
    Eigen::VectorXd by, sd;
    if (!whole.empty()) {
      const Eigen::MatrixXd information = e.information(whole, whole);
      const Eigen::VectorXd scale = information.diagonal().cwiseSqrt().cwiseInverse();
      const Eigen::MatrixXd covariance =
          scale.asDiagonal() *
          (scale.asDiagonal() * information * scale.asDiagonal()).ldlt().solve(Eigen::MatrixXd(scale.asDiagonal()));
      by = covariance * Eigen::VectorXd(e.score(whole));
      sd = covariance.diagonal().cwiseSqrt();
    }
    Eigen::Index next = 0;
    for (std::size_t i = 0; i < taken_.size(); ++i) {
      if (!taken_[i].from) {
        move(i, by(next), sd(next));
        ++next;
      } else if (const auto at = at_onset(e, taken_[i])) {
        move(i, at->first, at->second);
      }
    }
    return settled;
  }

  /// Estimate and its sd of what remains of an effect that began at some time.
  static std::optional<std::pair<double, double>> at_onset(const Examination& e, const Taken& taken) {
    const auto track = std::ranges::find(e.tracks, taken.hypothesis, &Examination::Track::hypothesis);
    if (track == e.tracks.end() || track->t.empty()) return std::nullopt;
    const auto at = std::ranges::lower_bound(track->t, *taken.from);
    if (at == track->t.end()) return std::nullopt;
    const auto k = static_cast<std::size_t>(at - track->t.begin());
    return std::pair(track->score[k] / track->information[k], 1.0 / std::sqrt(track->information[k]));
  }

  /// Takes an effect and runs without it. Where the mission is not linear over the effect's size the first estimate is too
  /// large: it is halved until the likelihood rises. One that never does so is refused for good.
  void try_out(const Suspicion& s) {
    constexpr int kHalvings = 4;
    const double before = run_->log_likelihood();
    const std::optional<FittedNoise> noise = std::exchange(noise_, std::nullopt);  // it may have stood for this effect
    const double stated = noise ? before - noise->gain() : before;
    take(s);
    std::unique_ptr<MissionRun> start = std::move(run_);
    for (int i = 0; i <= kHalvings; ++i, taken_.back().value *= 0.5) {
      run_from(*start);
      const double gained = run_->log_likelihood() - stated;
      if (gained < 0.5 * result_.threshold) continue;
      result_.findings.back().delta_log_likelihood = gained;
      noise_tried_ = false;
      return;
    }
    taken_.pop_back();
    result_.findings.pop_back();
    refused_.push_back(s.hypothesis);
    noise_ = noise;
    run_from(*start);
  }

  /// A line or a relation that no catalogue has, where chance does not explain it.
  [[nodiscard]] std::optional<Proposal> likeliest_form(const Examination& examination) const {
    std::optional<Proposal> best;
    for (const std::optional<Proposal>& form : {strongest_line(examination), likeliest_relation(examination, *run_)}) {
      if (!form || form->p_value > kFormFalseAlarm || form->stability < kStable || was_refused(*form)) continue;
      if (!best || form->likelihood_ratio - 2.0 * form->log_places > best->likelihood_ratio - 2.0 * best->log_places) best = form;
    }
    return best;
  }
  [[nodiscard]] bool was_refused(const Proposal& form) const {
    return std::ranges::any_of(refused_forms_, [&](const EffectPtr& e) {
      return e->name == form.effect->name && e->site == form.effect->site && e->axes == form.effect->axes &&
             e->relation == form.effect->relation;
    });
  }

  /// Its coefficients are found together with those that are taken already.
  bool try_out(const Proposal& form) {
    const double before = run_->log_likelihood();
    const std::vector<Taken> taken = taken_;
    const std::vector<Finding> findings = result_.findings;
    suggested_.push_back(form.effect);
    const std::unique_ptr<MissionRun> start = std::move(run_);
    run_from(*start);
    const auto first = static_cast<Eigen::Index>(run_->hypotheses().size()) - static_cast<Eigen::Index>(form.effect->axes.size());
    for (Eigen::Index i = first; i < run_->hypotheses().size(); ++i)
      take({.hypothesis = i, .from = {}, .likelihood_ratio = form.likelihood_ratio, .p_value = form.p_value});
    static_cast<void>(follow(examined()));
    run();
    const double gained = run_->log_likelihood() - before;
    if (gained > form.log_places - std::log(kFormFalseAlarm)) {
      Finding& found = result_.findings[taken.size()];
      found.delta_log_likelihood = gained;
      if (!form.effect->relation.empty()) found.stability = form.stability;
      return true;
    }
    refused_forms_.push_back(form.effect);
    suggested_.pop_back();
    taken_ = taken;
    result_.findings = findings;
    run_from(*start);
    return false;
  }

  [[nodiscard]] const Suspicion* likeliest() const {
    const Suspicion* best = nullptr;
    for (const Suspicion& s : suspicions_.all)
      if (std::ranges::find(refused_, s.hypothesis) == refused_.end() && s.p_value < of_catalogue() &&
          (best == nullptr || s.log_bayes > best->log_bayes))
        best = &s;
    return best;
  }

  void take(const Suspicion& s) {
    taken_.push_back({s.hypothesis, s.from, {}, s.estimate});
    const Hypotheses& hypotheses = run_->hypotheses();
    Finding finding{.hypothesis = hypotheses[s.hypothesis],
                    .from = s.from,
                    .to = {},
                    .from_sd_s = s.from_sd_s,
                    .value = s.estimate,
                    .sd = s.sd,
                    .p_value = s.p_value,
                    .alternatives = {},
                    .stability = {}};
    for (const Suspicion& other : suspicions_.all)
      if (other.hypothesis != s.hypothesis &&
          (s.log_bayes - other.log_bayes < kLogOdds || s.likelihood_ratio - other.likelihood_ratio < 2.0 * kLogOdds))
        finding.alternatives.push_back(alternative(other, std::max(s.log_bayes - other.log_bayes,
                                                                   0.5 * (s.likelihood_ratio - other.likelihood_ratio))));
    for (const FittedEffect& fit : beaten_)
      if (0.5 * s.likelihood_ratio - fit.gain < kLogOdds) finding.alternatives.push_back(alternative(fit, 0.5 * s.likelihood_ratio));
    std::ranges::sort(finding.alternatives, {}, &Alternative::log_odds);
    result_.findings.push_back(std::move(finding));
  }

  /// An effect that is taken back later by an equal jump the other way lasted until then: a wrong fix.
  void join_entries_with_exits() {
    constexpr double kEqual = 4.0;  // sd of the sum
    std::vector<Finding>& all = result_.findings;
    for (std::size_t i = 0; i < all.size(); ++i)
      for (std::size_t j = 0; j < all.size(); ++j) {
        Finding& entry = all[i];
        const Finding& exit = all[j];
        if (entry.to || exit.to || entry.hypothesis.effect != exit.hypothesis.effect ||
            entry.hypothesis.axis != exit.hypothesis.axis || !entry.from || !exit.from || !(*entry.from < *exit.from) ||
            std::abs(entry.value + exit.value) > kEqual * std::hypot(entry.sd, exit.sd))
          continue;
        entry.to = exit.from;
        entry.delta_log_likelihood += exit.delta_log_likelihood;
        all.erase(all.begin() + static_cast<std::ptrdiff_t>(j));
        i = 0;
        j = 0;
      }
  }

  /// Sine and cosine become amplitude and phase.
  void join_quadratures() {
    std::vector<Finding>& all = result_.findings;
    for (std::size_t i = 0; i + 1 < all.size(); ++i) {
      const Effect& effect = *all[i].hypothesis.effect;
      if (effect.name != "harmonic_disturbance" || all[i + 1].hypothesis.effect != &effect) continue;
      Finding& sine = all[i];
      const Finding& cosine = all[i + 1];
      const double phase = effect.fixed[1].value + std::atan2(cosine.value, sine.value);
      const int axis = effect.axes.front().front() - 'x';
      result_.suggested.push_back(harmonic_disturbance(effect.site, axis, effect.fixed[0].value, phase));
      sine.hypothesis.effect = result_.suggested.back().get();
      sine.value = std::hypot(sine.value, cosine.value);
      sine.sd = std::max(sine.sd, cosine.sd);
      all.erase(all.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    }
  }

  void describe_what_was_not_found() {
    const Hypotheses& hypotheses = run_->hypotheses();
    std::vector<bool> told(static_cast<std::size_t>(hypotheses.size()), false);
    for (const Taken& one : taken_) told[static_cast<std::size_t>(one.hypothesis)] = true;
    for (const Suspicion& s : suspicions_.all) {
      if (told[static_cast<std::size_t>(s.hypothesis)]) continue;
      told[static_cast<std::size_t>(s.hypothesis)] = true;
      result_.detectable_not_found.push_back({hypotheses[s.hypothesis], minimal_detectable(s.sd, result_.threshold)});
    }
    for (Eigen::Index i = 0; i < hypotheses.size(); ++i)
      if (!told[static_cast<std::size_t>(i)])
        result_.not_observable.push_back({hypotheses[i], "of what is plausible this mission shows nothing"});
    for (const Effect& effect : catalogue()) {
      const char* reason = nullptr;
      if (effect.needs_reference) reason = "no innovation changes: only a reference could show it";
      if (effect.needs_temperature && run_->mission().imu.temperature.empty()) reason = "no temperature was recorded";
      if (reason != nullptr) result_.not_observable.push_back({{&effect, 0, 0.0}, reason});
    }
  }

  DiagnosisOptions options_;
  const study::Progress& progress_;
  MissionInput input_;
  Grade grade_;
  MissionInput current_;
  std::unique_ptr<MissionRun> run_;
  std::vector<Taken> taken_;
  std::vector<Eigen::Index> refused_;
  Suspicions suspicions_;
  std::optional<FittedNoise> noise_;
  std::optional<estimate::NoiseFit> last_fit_;
  bool noise_tried_ = false;
  std::vector<EffectPtr> suggested_;
  std::vector<EffectPtr> refused_forms_;
  std::vector<AddedNoise> added_;
  std::vector<AddedNoise> refused_noise_;
  std::vector<FittedEffect> beaten_;  ///< random effects that explain less than the mean effect that is likeliest
  std::vector<NoiseFinding> random_effects_;
  Diagnosis result_;
};

}  // namespace

Diagnosis diagnose(const MissionInput& input, const DiagnosisOptions& options, const study::Progress& progress) {
  constexpr int kMostSteps = 20;
  Search search(input, options, progress);
  for (int i = 0; i < kMostSteps && search.step();) ++i;
  return search.finish();
}

}  // namespace coast::diagnose
