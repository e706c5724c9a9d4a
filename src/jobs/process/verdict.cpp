#include "process/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "coast/geo/earth.hpp"
#include "coast/geo/units.hpp"
#include "coast/jobs/process.hpp"
#include "coast/study/plausibility.hpp"

namespace coast::jobs {

const char* name(Standing standing) {
  static constexpr std::array<const char*, 3> kNames{"good", "doubtful", "unusable"};
  return kNames[static_cast<std::size_t>(standing)];
}

Standing Check::standing() const {
  if (std::isfinite(value) && value <= good) return Standing::kGood;
  return usable && !(value <= *usable) ? Standing::kUnusable : Standing::kDoubtful;
}

Standing Judgement::standing() const {
  Standing worst = Standing::kGood;
  for (const Check& check : checks) worst = std::max(worst, check.standing());
  return worst;
}

namespace {
constexpr const char* kJumps = "gnss_jump_m";
constexpr const char* kRefusedAid = "aid_refused";

bool fails(const Judgement& judgement, std::string_view name) {
  return std::ranges::any_of(judgement.checks,
                             [name](const Check& check) { return check.name == name && check.standing() != Standing::kGood; });
}
}  // namespace

bool Judgement::names_its_cause() const {
  return standing() != Standing::kGood && std::ranges::all_of(checks, [](const Check& check) {
           return check.standing() == Standing::kGood || check.name == kJumps || check.name == kRefusedAid;
         });
}

std::string Judgement::line() const {
  std::string text = fmt::format("verdict: {}", name(standing()));
  if (standing() == Standing::kGood) return text + fmt::format(", {} checks passed", checks.size());
  const char* separator = ": ";
  for (const Check& check : checks) {
    if (check.standing() == Standing::kGood) continue;
    text += separator + check.text;
    separator = "; ";
  }
  if (likely_cause.empty()) return text;
  std::string_view cause = likely_cause;  // a sentence; what uses this line ends it itself
  if (cause.ends_with('.')) cause.remove_suffix(1);
  return fmt::format("{}. Most likely cause: {}", text, cause);
}

namespace {

constexpr double kLegSeconds = 2.0;  // over these the noise of fixes is a small part of the distance

std::vector<const record::GnssFix*> fixes_apart(const record::GnssRecording& gnss) {
  std::vector<const record::GnssFix*> fixes;
  for (const record::GnssFix& fix : gnss.fixes)
    if (fixes.empty() || fix.t - fixes.back()->t >= kLegSeconds - 1e-3) fixes.push_back(&fix);
  return fixes;
}

}  // namespace

MotionChecks::MotionChecks(const estimate::Mission& mission) {
  constexpr double kLongest = 10.0;  // s: farther apart, the path between two fixes is unknown
  constexpr double kShortestRest = 3.0;
  const std::vector<const record::GnssFix*> fixes = fixes_apart(mission.gnss);
  for (std::size_t i = 1; i < fixes.size(); ++i) {
    const record::GnssFix &a = *fixes[i - 1], &b = *fixes[i];
    if (b.t - a.t > kLongest) continue;
    const double variance = a.position_cov_n.trace() + b.position_cov_n.trace();
    legs_.push_back(
        {a.t - mission.time_offset_s, b.t - mission.time_offset_s, (b.r_ea_e - a.r_ea_e).norm(), std::sqrt(variance)});
  }
  for (const estimate::TimeSpan& span : mission.standstill) {
    if (span.to - span.from < kShortestRest) continue;
    Eigen::Vector3d dv = Eigen::Vector3d::Zero();
    double seconds = 0.0;
    for (const record::ImuSample& s : mission.imu.samples) {
      if (!span.contains(s.t)) continue;
      dv += s.dv;
      seconds += s.dt;
    }
    if (seconds > 0.0) rests_.push_back({span.from + 0.5 * (span.to - span.from), dv / seconds});
  }
}

void MotionChecks::add(const record::TrajectoryEpoch& epoch) {
  const record::NavState& nav = epoch.nav;
  while (leg_ < legs_.size() && legs_[leg_].to <= nav.t) ++leg_;
  if (last_ && leg_ < legs_.size() && legs_[leg_].from <= nav.t)
    legs_[leg_].travelled += nav.v_eb_e.norm() * std::min(nav.t - *last_, kLegSeconds);
  last_ = nav.t;
  if (rest_ == rests_.size() || nav.t < rests_[rest_].middle) return;
  const Eigen::Vector3d predicted = -(nav.q_b_e.conjugate() * geo::gravity_e(nav.r_eb_e));
  Rest& rest = rests_[rest_++];
  rest.tilt = std::atan2(predicted.cross(rest.f_b).norm(), predicted.dot(rest.f_b));
}

std::vector<Check> MotionChecks::checks() const {
  std::vector<Check> checks;
  double fixes = 0.0, noise = 0.0, seconds = 0.0, solution = 0.0;
  for (const Leg& leg : legs_) {
    if (leg.travelled == 0.0) continue;
    fixes += leg.length;
    noise += leg.sd;
    seconds += leg.to - leg.from;
    solution += leg.travelled;
  }
  constexpr double kShake = 0.1;  // m/s: an antenna on its mast moves, a vehicle bounces
  if (seconds > 0.0) {
    const double excess =
        std::max(0.0, std::abs(solution - fixes) - noise - kShake * seconds) / (fixes + noise + kShake * seconds);
    checks.push_back({"distance_against_gnss", excess, 0.1, 0.4,
                      fmt::format("the solution travels {:.0f} m where the fixes do {:.0f} m", solution, fixes)});
  }
  double tilt = 0.0;
  bool seen = false;
  for (const Rest& rest : rests_) {
    if (!rest.tilt) continue;
    seen = true;
    tilt = std::max(tilt, *rest.tilt / geo::kDegree);
  }
  if (seen)
    checks.push_back({"tilt_at_rest_deg", tilt, 3.0, 8.0,
                      fmt::format("at rest roll and pitch differ by {:.1f} deg from the specific force's", tilt)});
  return checks;
}

std::optional<Check> sensor_check(const estimate::StateLayout& layout, const Eigen::VectorXd& x) {
  const auto worst = study::largest_sensor_error(layout, x);
  if (!worst) return std::nullopt;
  return Check{"sensor_errors_over_prior", worst->sigmas, 6.0, 20.0,
               fmt::format("{} is {:.0f} sigma from its prior in the error model", worst->name, worst->sigmas)};
}

namespace {

double quantile(std::vector<double> values, double p) {
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(p * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

// Most of the mission: at its ends one of the two filters has just begun.
void add_separation(const ProcessResult& result, std::vector<Check>& checks) {
  constexpr double kMost = 0.7;
  if (result.separations.empty()) return;
  std::vector<double> tilt, position;
  for (const Separation& s : result.separations) {
    tilt.push_back(std::max(std::abs(s.attitude.x()), std::abs(s.attitude.y())) / geo::kDegree);
    position.push_back(s.position_n.norm() / std::max(s.sd_position.norm(), 1e-9));
  }
  const double degrees = quantile(tilt, kMost), sigmas = quantile(position, kMost);
  checks.push_back({"tilt_separation_deg", degrees, 2.0, 8.0,
                    fmt::format("forward and backward filter differ by {:.1f} deg in roll or pitch", degrees)});
  checks.push_back({"position_separation_over_sigma",
                    sigmas,
                    4.0,
                    {},
                    fmt::format("forward and backward positions differ by {:.1f} times their sigma", sigmas)});
}

void add_innovations(const ProcessResult& result, std::vector<Check>& checks) {
  const std::size_t offered = result.gnss_used + result.gnss_rejected;
  if (offered > 0) {
    const double refused = static_cast<double>(result.gnss_rejected) / static_cast<double>(offered);
    checks.push_back({"fixes_refused", refused, 0.08, 0.25,
                      fmt::format("{} of {} fixes contradict the filter and were refused", result.gnss_rejected, offered)});
  }
  if (result.nis.epochs == 0 || !(result.nis.expected > 0.0)) return;
  const double ratio = result.nis.mean / result.nis.expected;
  checks.push_back({"innovations_squared_over_expected", ratio, 2.0, 6.0,
                    fmt::format("the NIS is {:.2g} times its expectation under the stated sigmas", ratio)});
}

void add_refused_aids(const ProcessResult& result, std::vector<Check>& checks) {
  constexpr double kMost = 0.1;
  const auto share = [](const AidUse& aid) {
    return static_cast<double>(aid.refused) / static_cast<double>(std::max<std::size_t>(1, aid.used + aid.refused));
  };
  const auto worst = std::ranges::max_element(result.aids, {}, share);
  if (worst == result.aids.end()) return;
  checks.push_back({kRefusedAid,
                    share(*worst),
                    kMost,
                    {},
                    fmt::format("{} of {} samples of the {} contradict the filter and were refused", worst->refused,
                                worst->used + worst->refused, worst->name)});
}

void add_noise_fit(const ProcessResult& result, std::vector<Check>& checks) {
  if (!result.noise_fit) return;
  constexpr double kHighest = 999.0;
  const estimate::NoiseAdjustment& adjustment = result.noise_fit->adjustment;
  const double largest = std::max(adjustment.gyro_factors.maxCoeff(), adjustment.accel_factors.maxCoeff());
  checks.push_back(
      {"imu_noise_factor", largest, kHighest, {}, fmt::format("the fit of the IMU noise ends on its bound, {:.0f}", largest)});
}

const record::Event* find(const record::Events& events, std::string_view kind) {
  const auto found = std::ranges::find(events, kind, &record::Event::kind);
  return found == events.end() ? nullptr : &*found;
}

// A smaller jump is reported as an event: some seconds of float positions, from which the solution recovers.
Check jump_check(const ProcessResult& result) {
  constexpr double kLargest = 0.5;  // m
  const auto size = [](const estimate::GnssJump& jump) { return jump.by_n.norm(); };
  const auto largest = std::ranges::max_element(result.jumps, {}, size);
  if (largest == result.jumps.end()) return {kJumps, 0.0, kLargest};
  const auto told = std::ranges::find_if(
      result.events, [&](const record::Event& event) { return event.kind == "gnss_jump" && event.time == largest->t; });
  std::string text = told == result.events.end() ? "" : told->text;
  if (result.jumps.size() > 1) text += fmt::format(" (the largest of {} jumps)", result.jumps.size());
  return {kJumps, size(*largest), kLargest, {}, std::move(text)};
}

// If outages are studied, the drift was larger than predicted after these.
void add_jumps(const ProcessResult& result, std::vector<Check>& checks) {
  const auto count = [&](const char* kind) {
    return static_cast<double>(std::ranges::count(result.events, kind, &record::Event::kind));
  };
  checks.push_back(jump_check(result));
  if (!result.outages.empty()) return;
  const record::Event* drift = find(result.events, "gate_opened");
  checks.push_back({"drift_behind_outages", count("gate_opened"), 0.0, {}, drift == nullptr ? "" : drift->text});
}

void add_assumed_heading(const ProcessResult& result, std::vector<Check>& checks) {
  const record::Event* assumed = find(result.events, "heading_assumed");
  if (assumed != nullptr) checks.push_back({"heading_assumed", 1.0, 0.0, {}, "the heading rests on an assumption"});
}

// The recording is consistent, but one of the two is wrong: the measured arm, or another error with a similar effect.
void add_lever_arm(const ProcessResult& result, std::vector<Check>& checks) {
  if (find(result.events, "lever_arm_contradicted") == nullptr) return;
  checks.push_back({"lever_arm_contradicted", 1.0, 0.0, {}, "the recording contradicts the lever arm that is stated"});
}

// Mistakes in the order in which each hides the later ones.
std::string likely_cause(const ProcessResult& result, const Judgement& judgement) {
  if (judgement.names_its_cause() && fails(judgement, kJumps))
    return "from there on another base, height reference or antenna place, or wrongly fixed ambiguities on one side. Find out "
           "which side is right, and process the two apart";
  if (const record::Event* event = find(result.events, kRefusedAid); event != nullptr && judgement.names_its_cause())
    return event->text;
  for (const char* kind :
       {"specific_force_unit", "specific_force_size", "gravity_sign", "gravity_axis", "gyro_sign", "gyro_unit",
        "leap_second_shift", "time_shift", "lever_arm_contradicted", "travel_direction", "gnss_sigmas_do_not_fit"})
    if (const record::Event* event = find(result.events, kind)) return event->text;
  return "";
}

}  // namespace

std::string told(const std::vector<study::Cause>& causes) {
  if (causes.empty()) return "";
  const study::Cause& first = causes.front();
  std::string text =
      fmt::format("{}: {} (gain in log-likelihood over two minutes: {:.0f}", first.what, first.remedy, first.gain);
  if (causes.size() > 1) text += fmt::format("; next, {}: {:.0f}", causes[1].what, causes[1].gain);
  return text + ")";
}

// Fitted noise can hide a gyro whose sign is wrong. What gains as much beside every noise that was tried is no chance.
std::optional<Check> misreading_check(const std::vector<study::Cause>& causes) {
  constexpr double kDoubtful = 20.0, kCertain = 200.0;  // of the log-likelihood of two minutes
  if (causes.empty() || !causes.front().of_samples) return std::nullopt;
  return Check{"misread_samples", causes.front().gain, kDoubtful, kCertain,
               fmt::format("the samples are likelier by exp({:.0f}) if they are read otherwise", causes.front().gain)};
}

Judgement judge(const ProcessResult& result, std::vector<Check> motion) {
  Judgement judgement{std::move(motion)};
  add_innovations(result, judgement.checks);
  add_refused_aids(result, judgement.checks);
  add_separation(result, judgement.checks);
  add_noise_fit(result, judgement.checks);
  add_jumps(result, judgement.checks);
  add_assumed_heading(result, judgement.checks);
  add_lever_arm(result, judgement.checks);
  if (judgement.standing() != Standing::kGood) judgement.likely_cause = likely_cause(result, judgement);
  return judgement;
}

}  // namespace coast::jobs
