#include "search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace coast::diagnose {

namespace {

constexpr double kSettled = 0.1;    // sd that a coefficient may still move
constexpr double kNear = 1.0;       // likewise, from where on what is left may be something else
constexpr double kMuch = 100.0;     // log-likelihood, from where on noise that was fitted without it stood for it
constexpr double kUncertain = 0.1;  // of a likelihood ratio whose variance is that of some hundred draws

/// A start that the data decide: it was found by a run that knew nothing of the effect, which may be in it.
void loosen_start(const study::PreparedMission& mission, const estimate::SmoothedKnot& smoothed, MissionInput& input) {
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
}

/// What a gyro showed standing still is bias and constant effect alike.
void forget_standstill(const TurnOn& bias, study::Setup& setup) {
  if (bias.sensor != noise::Sensor::kGyro) return;
  const Eigen::Vector3d axis_b = setup.C_s_b.col(bias.axis);
  setup.start->gyro_bias -= axis_b * axis_b.dot(setup.start->gyro_bias);
  setup.start->gyro_bias_sd.reset();
}

}  // namespace

Search::Search(const MissionInput& input, const DiagnosisOptions& options, Order order, const study::Progress& progress)
    : options_(options), order_(order), progress_(progress), input_(input), grade_(grade_of(input.setup.model)) {
  input_.setup.filter.gate_probability = 0.0;  // what a gate refuses cannot be explained
  asked_for_ = input.setup.noise_fit;
  input_.setup.noise_fit.reset();
  run_again();
  run_again();  // from a start that is loose
  if (asked_for_) fit_noise();
  result_.grade = grade_;
  result_.before = run_->fit();
  result_.innovations_before = run_->solution().forward.innovations;
  look_at_samples();
}

bool Search::step() {
  const std::weak_ptr<const MissionRun> run = run_;
  const std::vector<Taken> of_run = taken_;
  const bool goes_on = look_further();
  if (run_ == run.lock()) {
    taken_ = of_run;  // what moved since belongs to no run
  } else if (sensors_are_elsewhere(*run_)) {
    run_again();  // or something else would have to explain the rest of what was taken for errors of the sensors
  }
  return goes_on;
}

bool Search::look_further() {
  if (give_up_what_bends()) return true;
  Examination examination = examined({}, 0);
  const std::vector<Taken> before = taken_;
  const double moved = follow(examination);
  if (moved > kNear && run_moved(before)) return true;
  if (asked_for_ && explained_ > kMuch && fit_noise_again()) return true;
  add_draws(examination);
  suspicions_ = suspicions(examination, run_->hypotheses(), rows_of(taken_, run_->hypotheses().size()));
  result_.threshold = suspicions_.chance.quantile(of_catalogue());
  if (take_time_offset()) return true;
  const bool is_full = result_.findings.size() >= most();
  candidates_ = is_full ? Candidates() : candidates();
  const std::optional<Proposal> form = is_full ? std::nullopt : likeliest_form(examination);
  const double form_gain = form ? (0.5 + kUncertain) * form->likelihood_ratio - form->log_places : 0.0;
  const bool means_first = order_ == Order::kMeansFirst && !candidates_.all.empty();
  if (!means_first && take_noise(examination, form_gain)) {
    run_again();
    return true;
  }
  if (form && exceeds_candidates(form_gain, &Candidates::gain)) {
    try_out(*form);
    return true;
  }
  if (candidates_.all.empty() && moved < kSettled) return fit_noise_again();
  if (candidates_.all.empty()) {
    run_again();
    return true;
  }
  if (makes_likelier(winner())) {
    noise_is_behind_ = true;
    explained_ += result_.findings.back().delta_log_likelihood;
  }
  return true;
}

double Search::evidence() const {
  const double parameters = noise_ ? static_cast<double>(noise_->fit.names.size()) : 0.0;
  double prices = parameters + log_choices() * static_cast<double>(taken_.size());
  for (const Finding& f : result_.findings) prices += f.price;
  for (const NoiseFinding& f : random_effects_) prices += price_of_random_effect(f.sd / f.value);
  // One that is shared and beyond the error model all the same has paid what an error model with a larger sigma would not ask.
  for (const TurnOn& one : beyond_stated(*run_)) prices += is_shared(one) ? -one.gain() : one.price();
  return log_likelihood_of(*run_) + forgotten_ - prices;
}

Examination Search::examined(const std::function<bool(geo::GpsTime)>& counts, Eigen::Index draws) const {
  std::vector<Examination::Started> started;
  for (const Taken& one : taken_)
    if (one.from) started.push_back({one.hypothesis, *one.from});
  Examination examination =
      examine(run_->mission(), run_->layout(), run_->solution().knots, run_->hypotheses(),
              {.draws = draws, .seed = options_.seed, .counts = counts, .started = std::move(started)}, [this](double done) {
                if (progress_) progress_("examining effects", done);
              });
  for (const TurnOn& bias : shared_) move_to_stated(bias, *run_, examination);
  return examination;
}

void Search::add_draws(Examination& examination) {
  if (drawn_ && examination.take_draws_of(*drawn_)) return;
  drawn_ = examined();
  examination = *drawn_;
}

double Search::of_catalogue() const {
  return std::max(0.5 * options_.false_alarm_probability,
                  options_.false_alarm_probability - kNoiseFalseAlarm - 2.0 * kFormFalseAlarm);
}

void Search::run_again() {
  if (run_ == nullptr) {
    current_ = input_;
    run_current();
    return;
  }
  const RunPtr last = std::move(run_);
  run_from(*last);
}

void Search::run_from(const MissionRun& last) {
  current_ = without(taken_, input_, last.hypotheses(), last.path(), last.mission(), last.layout());
  model_noise(current_);
  const estimate::SmoothedKnot& start = last.solution().smoothed.front();
  loosen_start(last.prepared(), start, current_);
  for (const TurnOn& bias : shared_) forget_standstill(bias, current_.setup);
  if (!sensors_at_start_) sensors_at_start_ = SensorsAtStart{last.layout(), start.x};
  if (sensors_are_elsewhere(last)) find_sensors_anew();
  current_.setup.start_sensor_errors = sensor_states_in(layout_of(current_), sensors_at_start_->layout, sensors_at_start_->x);
  run_current();
}

void Search::find_sensors_anew() {
  current_.setup.start_sensor_errors.resize(0);
  try {
    run_current();
    sensors_at_start_ = SensorsAtStart{run_->layout(), run_->solution().smoothed.front().x};
  } catch (const NumericalError&) {  // so far from them the filter may break down: they stay
  }
}

void Search::share(const TurnOn& bias) {
  const double before = run_->log_likelihood();
  shared_.push_back(bias);
  // Soon after the start a step is the same.
  exchanged_.push_back(run_->hypotheses().bias_step(sensor_site(bias.sensor), bias.axis));
  relation_.reset();
  run_again();
  forgotten_ += before - run_->log_likelihood();
}

bool Search::is_shared(const TurnOn& bias) const {
  return std::ranges::any_of(shared_, [&](const TurnOn& b) { return b.sensor == bias.sensor && b.axis == bias.axis; });
}

double Search::log_likelihood_of(const MissionRun& run) const {
  double sum = run.log_likelihood();
  for (const TurnOn& bias : shared_) sum += gain_about_stated(bias, run);
  return sum;
}

bool Search::sensors_are_elsewhere(const MissionRun& last) const {
  constexpr double kFar = 2.0;  // sd of what is known of the sensors beforehand
  const Eigen::VectorXd found = last.solution().smoothed.front().x.head(last.layout().sensor_end());
  const Eigen::VectorXd assumed = sensor_states_in(last.layout(), sensors_at_start_->layout, sensors_at_start_->x);
  const Eigen::VectorXd sd =
      last.prepared().start_state(*last.solution().filter).P.diagonal().head(last.layout().sensor_end()).cwiseSqrt();
  return ((found - assumed).cwiseAbs().array() > kFar * sd.array()).any();
}

double Search::likelihood_from(const MissionRun& last) {
  try {
    run_from(last);
    return log_likelihood_of(*run_);
  } catch (const NumericalError&) {
    run_.reset();
    return -std::numeric_limits<double>::infinity();
  }
}

bool Search::run_moved(const std::vector<Taken>& before) {
  constexpr int kHalvings = 3;
  constexpr double kLess = 3.0;  // that a run may be for the other point about which it is linearised
  Standing start = standing();
  for (int i = 0; i <= kHalvings && start.run != stuck_.lock(); ++i) {
    if (likelihood_from(*start.run) > log_likelihood_of(*start.run) - kLess) return true;
    for (std::size_t k = 0; k < taken_.size(); ++k) taken_[k].value = 0.5 * (taken_[k].value + before[k].value);
  }
  taken_ = before;
  return_to(std::move(start));
  stuck_ = run_;
  return false;
}

void Search::settle() {
  constexpr int kMost = 8;
  for (int i = 0; i < kMost; ++i) {
    const std::vector<Taken> before = taken_;
    if (follow(examined({}, 0)) < kNear) {
      taken_ = before;
      return;
    }
    if (!run_moved(before)) return;
  }
}

MissionInput Search::with_values(const std::vector<Taken>& taken) const {
  MissionInput input = without(taken, input_, run_->hypotheses(), run_->path(), run_->mission(), run_->layout());
  model_noise(input);
  input.setup.start = current_.setup.start;
  input.setup.start_sensor_errors = current_.setup.start_sensor_errors;
  return input;
}

Fit Search::fit_with(const std::vector<Taken>& taken) const {
  try {
    return MissionRun(with_values(taken), grade_, suggested_, progress_).fit();
  } catch (const NumericalError&) {
    return {.outage_rms_m = std::numeric_limits<double>::infinity()};
  }
}

void Search::give_up(std::size_t index) {
  const auto at = static_cast<std::ptrdiff_t>(index);
  given_up_.push_back(taken_[index].hypothesis);
  const auto form = std::ranges::find(suggested_, result_.findings[index].hypothesis.effect, &EffectPtr::get);
  if (form != suggested_.end()) refused_forms_.push_back(*form);
  taken_.erase(taken_.begin() + at);
  result_.findings.erase(result_.findings.begin() + at);
  relation_.reset();
  run_again();
  noise_is_behind_ = true;
}

void Search::take_out(std::size_t index) {
  relation_.reset();
  taken_.erase(taken_.begin() + static_cast<std::ptrdiff_t>(index));
  result_.findings.erase(result_.findings.begin() + static_cast<std::ptrdiff_t>(index));
  run_again();
  const LargestByChance chance = suspicions_.chance;
  suspicions_ = suspicions(examined({}, 0), run_->hypotheses(), rows_of(taken_, run_->hypotheses().size()));
  suspicions_.judge(chance);
}

void Search::forget_what_vanished() {
  for (std::size_t i = taken_.size(); i-- > 0;) {
    // Sine and cosine of an oscillation belong together.
    const bool is_part_of_a_line = result_.findings[i].hypothesis.effect->axes.size() == 2;
    if (std::abs(taken_[i].value) < kNothing * sd(i) && !is_part_of_a_line) give_up(i);
  }
}

void Search::model_noise(MissionInput& input) const {
  if (noise_) {
    input.setup.model = estimate::adjusted(input.setup.model, noise_->fit.adjustment);
    input.setup.filter = estimate::adjusted(input.setup.filter, noise_->fit.adjustment);
  }
  for (const AddedNoise& one : added_) one.add_to(input);
}

void Search::run_current() {
  run_ = std::make_shared<const MissionRun>(current_, grade_, suggested_, progress_);
  ++result_.runs;
}

void Search::return_to(Standing&& standing) {
  run_ = std::move(standing.run);
  current_ = std::move(standing.input);
  sensors_at_start_ = std::move(standing.sensors);
}

std::vector<Eigen::Index> rows_of(const std::vector<Taken>& taken, Eigen::Index hypotheses) {
  std::vector<Eigen::Index> rows;
  for (const Taken& one : taken) rows.push_back(one.from ? hypotheses++ : one.hypothesis);
  return rows;
}

Movement movement(const Examination& e, const std::vector<Taken>& taken) {
  if (taken.empty()) return {};
  const std::vector<Eigen::Index> rows = rows_of(taken, e.score.size() - static_cast<Eigen::Index>(e.started.size()));
  const Eigen::MatrixXd covariance = covariance_of(e.information(rows, rows));
  return {covariance * Eigen::VectorXd(e.score(rows)), covariance.diagonal().cwiseSqrt()};
}

Movement Search::move_all(const Examination& e) {
  Movement moved = movement(e, taken_);
  for (std::size_t i = 0; i < taken_.size(); ++i) taken_[i].value += moved.by(static_cast<Eigen::Index>(i));
  return moved;
}

double Search::follow(const Examination& e) {
  const Movement moved = move_all(e);
  double farthest = 0.0;
  for (std::size_t i = 0; i < taken_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (!(moved.sd(row) > 0.0)) continue;
    result_.findings[i].sd = moved.sd(row);
    farthest = std::max(farthest, std::abs(moved.by(row)) / moved.sd(row));
  }
  return farthest;
}

}  // namespace coast::diagnose
