#include "search/explained_run.hpp"

#include <algorithm>
#include <utility>

#include "coast/parallel.hpp"
#include "coast/record/error.hpp"
#include "evidence/random_fit.hpp"

namespace coast::diagnose {

namespace {

constexpr std::size_t kRemembered = 6;  // runs: those of three candidates, two of each

/// A start determined by the data: it was estimated by a run without the effect, and may include it.
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

/// A gyro's mean at standstill is bias and constant effect together.
void forget_standstill(const TurnOn& bias, study::Setup& setup) {
  if (bias.sensor != noise::Sensor::kGyro) return;
  const Eigen::Vector3d axis_b = setup.C_s_b.col(bias.axis);
  setup.start->gyro_bias -= axis_b * axis_b.dot(setup.start->gyro_bias);
  setup.start->gyro_bias_sd.reset();
}

/// What an antenna that is estimated adds to its stated place is found once, as the start is.
void keep_antenna(const MissionRun& other, study::Setup& setup) {
  if (!other.prepared().antenna_is_estimated()) return;
  const study::Setup& stated = other.prepared().setup();
  setup.antenna_found = {other.mission().time_offset_s + setup.time_offset_s - stated.time_offset_s,
                         other.mission().lever_arm_b + setup.lever_arm_b - stated.lever_arm_b};
}

/// So are restarts behind gaps, unless the antenna is elsewhere at the time of a fix.
void keep_restarts(const MissionRun& other, study::Setup& setup) {
  const study::AntennaPlace place = setup.antenna_found.value_or(study::AntennaPlace{setup.time_offset_s, setup.lever_arm_b});
  if (place == study::AntennaPlace{other.mission().time_offset_s, other.mission().lever_arm_b})
    setup.restarts = other.mission().restarts;
}

std::size_t key_of(const Explanation& explanation, const ExplainedRun& other) {
  return combined(other.key(), explanation.hash());
}

}  // namespace

ExplainedRun::ExplainedRun(Explanation explanation, MissionInput input, std::optional<SensorsAtStart> sensors, std::size_t key,
                           Grade grade, const study::Progress& progress)
    : explanation_(std::move(explanation)),
      input_(std::move(input)),
      sensors_(std::move(sensors)),
      key_(key),
      progress_(progress),
      run_(input_, grade, explanation_.suggested, progress) {
  log_likelihood_ = run_.log_likelihood() - gain_by_own_noise(0, explanation_.effects.size());
  for (const TurnOn& bias : explanation_.shared) log_likelihood_ += gain_about_stated(bias, run_);
}

// A signal that is mostly noise predicts better if it is made smaller: with e = c s, E[noise s] > 0.
double ExplainedRun::gain_by_own_noise(std::size_t first, std::size_t count) const {
  double gain = 0.0;
  for (std::size_t i = first; i < first + count; ++i) {
    const SelectedEffect& one = explanation_.effects[i];
    if (run_.hypotheses().grows_with_own_signal(one.hypothesis))
      gain += one.value * sizes().own_noise(static_cast<Eigen::Index>(i));
  }
  return gain;
}

bool ExplainedRun::found_sensors_elsewhere() const {
  constexpr double kFar = 2.0;  // sd of the prior of the sensors
  if (!sensors_) return false;
  const Eigen::Index size = run_.layout().sensor_end();
  const Eigen::VectorXd found = run_.solution().smoothed.front().x.head(size);
  const Eigen::VectorXd assumed = sensor_states_in(run_.layout(), sensors_->layout, sensors_->x);
  const Eigen::VectorXd sd = run_.prepared().start_state(*run_.solution().filter).P.diagonal().head(size).cwiseSqrt();
  return ((found - assumed).cwiseAbs().array() > kFar * sd.array()).any();
}

const Examination& ExplainedRun::scores() const {
  return scores_.value([this] { return examined({.draws = 0}); });
}

Examination ExplainedRun::examined(ExaminationOptions options) const {
  for (const SelectedEffect& one : explanation_.effects)
    if (one.from) options.started.push_back({one.hypothesis, *one.from});
  Examination examination =
      examine(run_.mission(), run_.layout(), run_.solution().knots, run_.hypotheses(), options, [this](double done) {
        if (progress_) progress_("examining effects", done);
      });
  for (const TurnOn& bias : explanation_.shared)
    examination.score += prior_mean(bias, run_) * examination.information.col(constant_bias(bias, run_));
  return examination;
}

const SizeEvidence& ExplainedRun::sizes() const {
  return sizes_.value([this] { return sizes_where({}); });
}

SizeEvidence ExplainedRun::sizes_where(const std::function<bool(geo::GpsTime)>& counts) const {
  if (explanation_.effects.empty()) return {};
  std::vector<SelectedEffect> selected = explanation_.effects;
  for (const TurnOn& bias : explanation_.shared) selected.push_back({.hypothesis = constant_bias(bias, run_)});
  const SizeEvidence all = evidence_of_sizes(run_.mission(), run_.layout(), run_.solution().knots,
                                             SelectedAlone(run_.hypotheses(), selected), counts);
  const auto own = static_cast<Eigen::Index>(explanation_.effects.size());
  SizeEvidence result{all.score.head(own), all.information.topLeftCorner(own, own), all.own_noise.head(own)};
  for (std::size_t i = 0; i < explanation_.shared.size(); ++i)
    result.score +=
        prior_mean(explanation_.shared[i], run_) * all.information.col(own + static_cast<Eigen::Index>(i)).head(own);
  return result;
}

Runs::Runs(MissionInput recorded, Grade grade, const study::Progress& progress)
    : recorded_(std::move(recorded)), grade_(grade), progress_(progress) {}

Runs::Runs(const Runs& other, std::vector<RunPtr> last)
    : recorded_(other.recorded_), grade_(other.grade_), progress_(other.progress_), last_(std::move(last)) {}

Runs Runs::beside() const {
  return {*this, last_};
}

RunPtr Runs::first(const Explanation& explanation) {
  MissionInput input{*explanation.imu, recorded_.gnss, recorded_.setup};
  ++made_;
  return std::make_shared<const ExplainedRun>(explanation, std::move(input), std::nullopt, explanation.hash(), grade_,
                                              progress_);
}

RunPtr Runs::make(const Explanation& explanation, const ExplainedRun& other) {
  MissionInput input = explained(explanation, other.mission());
  loosen_start(other.mission().prepared(), other.mission().solution().smoothed.front(), input);
  for (const TurnOn& bias : explanation.shared) forget_standstill(bias, input.setup);
  keep_antenna(other.mission(), input.setup);
  keep_restarts(other.mission(), input.setup);
  SensorsAtStart sensors = sensors_for(explanation, input, other);
  input.setup.start_sensor_errors = sensor_states_in(layout_of(input), sensors.layout, sensors.x);
  ++made_;
  return std::make_shared<const ExplainedRun>(explanation, std::move(input), std::move(sensors), key_of(explanation, other),
                                              grade_, progress_);
}

RunPtr Runs::about(const Explanation& explanation, const RunPtr& other) {
  if (RunPtr known = remembered(explanation, *other)) return known;
  RunPtr run = make(explanation, *other);
  remember(run);
  return run;
}

RunPtr Runs::try_about(const Explanation& explanation, const RunPtr& other) {
  try {
    return about(explanation, other);
  } catch (const NumericalError&) {
    return nullptr;
  }
}

std::vector<RunPtr> Runs::try_all(const std::vector<Request>& requests) {
  std::vector<RunPtr> runs;
  for (const Request& one : requests) runs.push_back(remembered(one.explanation, *one.about));
  const std::vector<RunPtr> known = runs;
  coast::parallel_for(std::size_t{0}, requests.size(), [&](std::size_t i) {
    if (runs[i]) return;
    try {
      runs[i] = make(requests[i].explanation, *requests[i].about);
    } catch (const NumericalError&) {
      runs[i] = nullptr;
    }
  });
  for (std::size_t i = 0; i < runs.size(); ++i)
    if (runs[i] && !known[i]) remember(runs[i]);
  return runs;
}

void Runs::remember(const RunPtr& run) {
  if (last_.size() == kRemembered) last_.erase(last_.begin());
  last_.push_back(run);
}

RunPtr Runs::remembered(const Explanation& explanation, const ExplainedRun& other) const {
  const std::size_t key = key_of(explanation, other);
  const auto is_it = [&](const RunPtr& run) { return run->key() == key && run->explanation() == explanation; };
  const auto known = std::ranges::find_if(last_, is_it);
  return known != last_.end() ? *known : nullptr;
}

// An effect of zero size needs no correction, and may have no column in the other run yet.
MissionInput Runs::explained(const Explanation& explanation, const MissionRun& along) const {
  std::vector<SelectedEffect> effects = explanation.effects;
  std::erase_if(effects, [](const SelectedEffect& one) { return one.value == 0.0; });
  const MissionInput recorded{*explanation.imu, recorded_.gnss, recorded_.setup};
  MissionInput input = without(effects, recorded, along.hypotheses(), along.path(), along.mission(), along.layout());
  explanation.add_noise(input);
  return input;
}

SensorsAtStart Runs::sensors_for(const Explanation& explanation, const MissionInput& input, const ExplainedRun& other) {
  if (!other.sensors()) return {other.mission().layout(), other.mission().solution().smoothed.front().x};
  if (!other.found_sensors_elsewhere()) return *other.sensors();
  MissionInput about_prior_mean = input;
  about_prior_mean.setup.start_sensor_errors.resize(0);
  try {
    ++made_;
    const MissionRun run(std::move(about_prior_mean), grade_, explanation.suggested, progress_);
    return {run.layout(), run.solution().smoothed.front().x};
  } catch (const NumericalError&) {  // with such a change the filter may fail: the sensor errors are kept
    return *other.sensors();
  }
}

MissionInput Runs::with_sizes(const std::vector<SelectedEffect>& effects, const ExplainedRun& run) const {
  Explanation other = run.explanation();
  other.effects = effects;
  MissionInput input = explained(other, run.mission());
  input.setup.start = run.input().setup.start;
  input.setup.start_sensor_errors = run.input().setup.start_sensor_errors;
  keep_antenna(run.mission(), input.setup);
  keep_restarts(run.mission(), input.setup);
  return input;
}

}  // namespace coast::diagnose
