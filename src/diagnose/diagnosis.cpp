#include "coast/diagnose/diagnosis.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "mission_run.hpp"
#include "noise_check.hpp"

namespace coast::diagnose {

namespace {

constexpr double kContradicted = 4.0;  // sd of the innovations' variance or correlation, from where noise is fitted
constexpr double kSettled = 0.1;       // sd that a coefficient may still move
// Alternatives are told where the data alone, or with what is plausible, hold them for more than a thousandth as likely.
constexpr double kLogOdds = 7.0;

/// A start that the data decide: it was found by a run that knew nothing of the effect, which may be in it. The filter is
/// linearised about what that run found of the sensors too: with biases at their prior mean, tilts are wrong by mrad until the
/// first manoeuvres, and the square of a tilt looks like a vertical bias that ends there.
void loosen_start(const study::PreparedMission& mission, const estimate::SmoothedKnot& smoothed,
                  const estimate::StateLayout& layout, study::Setup& setup) {
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
  setup.start = start;
  setup.start_sensor_errors = smoothed.x.head(layout.sensor_end());
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
  }

  /// @return  whether something was done that may show more
  bool step() {
    const Examination examination =
        examine(run_->mission(), run_->layout(), run_->solution().knots, run_->hypotheses(), {.seed = options_.seed});
    const bool settled = follow(examination);
    suspicions_ = suspicions(examination, run_->hypotheses(), of_whole_mission());
    result_.threshold = suspicions_.chance.quantile(options_.false_alarm_probability);
    const Suspicion* best = result_.findings.size() < most() ? likeliest() : nullptr;
    const double mean_gain = best != nullptr ? 0.5 * best->likelihood_ratio : 0.0;
    if (!noise_ && !noise_tried_ && contradiction(run_->solution().forward.innovations) > kContradicted) {
      noise_tried_ = true;
      noise_ = fitted_noise(run_->prepared(), last_fit_, progress_);
      if (noise_) last_fit_ = noise_->fit;
      if (noise_ && noise_->gain() > mean_gain) {
        run();
        return true;
      }
      noise_.reset();
    }
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
    if (noise_) result_.noise = noise_->findings;
    for (std::size_t i = 0; i < result_.findings.size(); ++i) result_.findings[i].value = taken_[i].value;
    join_entries_with_exits();
    result_.after = run_->fit();
    result_.innovations_after = run_->solution().forward.innovations;
    result_.modelled = std::move(current_);
    return std::move(result_);
  }

 private:
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
    loosen_start(last.prepared(), last.solution().smoothed.front(), last.layout(), current_.setup);
    run_current();
  }
  void run_current() {
    if (noise_) {
      current_.setup.model = estimate::adjusted(current_.setup.model, noise_->fit.adjustment);
      current_.setup.filter = estimate::adjusted(current_.setup.filter, noise_->fit.adjustment);
    }
    run_ = std::make_unique<MissionRun>(current_, grade_, progress_);
    ++result_.runs;
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

  [[nodiscard]] const Suspicion* likeliest() const {
    const Suspicion* best = nullptr;
    for (const Suspicion& s : suspicions_.all)
      if (std::ranges::find(refused_, s.hypothesis) == refused_.end() && s.p_value < options_.false_alarm_probability &&
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
                    .alternatives = {}};
    for (const Suspicion& other : suspicions_.all)
      if (other.hypothesis != s.hypothesis &&
          (s.log_bayes - other.log_bayes < kLogOdds || s.likelihood_ratio - other.likelihood_ratio < 2.0 * kLogOdds))
        finding.alternatives.push_back({hypotheses[other.hypothesis], other.from, s.log_bayes - other.log_bayes});
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
