#include "coast/study/causes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "cause_hypotheses.hpp"
#include "coast/parallel.hpp"
#include "coast/record/error.hpp"

namespace coast::study {

namespace {

constexpr double kSeconds = 120.0;
constexpr double kBeforeMotion = 20.0;
constexpr double kMoved = 10.0;  // m

// Each hypothesis costs several passes: turns and accelerations of a vehicle are observable at these rates too.
constexpr double kImuInterval = 0.02;  // s: increments are added up to this interval
constexpr double kFixInterval = 0.45;  // s, at least
constexpr int kStartRounds = 2;

struct Fit {
  double log_likelihood = -std::numeric_limits<double>::infinity();  // concentrated
  double factor = 1.0;                                               // on the sigmas, at the maximum
  std::optional<double> time_offset_s, time_offset_sd_s;
  std::optional<Eigen::Vector3d> lever_arm_m, lever_arm_sd_m;
  std::optional<ins::InitialState> start;  // as determined
  Eigen::VectorXd start_sensor_errors;
};

void note_antenna(const estimate::FilterState& last, const estimate::StateLayout& layout, const estimate::Mission& mission,
                  Fit& fit) {
  if (const auto at = layout.time_offset()) {
    fit.time_offset_s = mission.time_offset_s + last.x(*at);
    fit.time_offset_sd_s = fit.factor * std::sqrt(last.P(*at, *at));
  }
  if (const auto at = layout.lever_arm()) {
    fit.lever_arm_m = mission.lever_arm_b + last.x.segment<3>(*at);
    fit.lever_arm_sd_m = fit.factor * last.P.diagonal().segment<3>(*at).cwiseSqrt();
  }
}

// No adaptations.
Setup as_described(const Setup& stated) {
  Setup setup = stated;
  setup.unstated = {};
  setup.noise_fit.reset();
  setup.start.reset();
  setup.carrier.reset();
  setup.refine_before.reset();
  setup.fit_before.reset();
  setup.filter.gate_probability = 0.0;
  setup.start_rounds = kStartRounds;
  return setup;
}

// If the start depends on them too, each fit needs ten more passes: done only for the hypotheses about them.
estimate::FilterOptions antenna_left_to_data(estimate::FilterOptions options, const Setup& stated) {
  estimate::AuxiliaryStates& auxiliary = options.auxiliary;
  if (stated.unstated.time_offset && auxiliary.time_offset_sd_s == 0.0) auxiliary.time_offset_sd_s = kFreeTimeSd;
  if (stated.unstated.lever_arm && auxiliary.lever_arm_sd_m == 0.0) auxiliary.lever_arm_sd_m = kFreeArmSd;
  return options;
}

/// With a hypothesis (none: as described) and with the white noise of the IMU times `noise`; about the start of an earlier fit
/// of the same hypothesis, if there is one.
Fit fit(const Excerpt& excerpt, const Setup& stated, const CauseHypothesis* hypothesis, double noise, const Fit* earlier) {
  Excerpt changed = excerpt;
  Setup setup = as_described(stated);
  if (hypothesis != nullptr) hypothesis->apply(changed, setup);
  for (const noise::Sensor sensor : {noise::Sensor::kGyro, noise::Sensor::kAccel})
    setup.model = setup.model.with_white_noise_scaled(sensor, Eigen::Vector3d::Constant(noise));
  if (earlier != nullptr) {
    setup.start = earlier->start;
    setup.start_sensor_errors = earlier->start_sensor_errors;
  }
  Fit result;
  try {
    const PreparedMission mission(std::move(changed.imu), std::move(changed.gnss), setup, {});
    const estimate::ForwardFilter filter(mission.mission(), mission.model(), antenna_left_to_data(mission.options(), stated));
    const estimate::FilterState first = mission.start_state(filter);
    result.start = mission.start();
    result.start_sensor_errors = first.x.head(filter.layout().sensor_end());
    const estimate::FilterResult run = filter.run(first, {});
    double nis = 0.0, dof = 0.0;
    for (const estimate::InnovationRecord& r : run.innovations) {
      nis += r.nis;
      dof += r.dof;
    }
    if (!(dof > 0.0) || !std::isfinite(run.log_likelihood)) return result;
    result.factor = std::sqrt(nis / dof);
    result.log_likelihood = run.log_likelihood + 0.5 * nis - 0.5 * dof * (1.0 + std::log(nis / dof));
    note_antenna(run.last, filter.layout(), mission.mission(), result);
  } catch (const NumericalError&) {  // no start: not likely
  } catch (const InputError&) {      // no common time under this shift
  }
  return result;
}

Cause told(const CauseHypothesis& hypothesis, const Fit& fit, double gain) {
  Cause cause{hypothesis.what, hypothesis.remedy, gain, hypothesis.of_samples};
  if (fit.time_offset_s && hypothesis.what.starts_with("the time")) {
    cause.what += fmt::format(" {:+.3f} +- {:.3f} s", *fit.time_offset_s, *fit.time_offset_sd_s);
    cause.remedy = fmt::format("`gnss: {{time_offset_s: {:.3f}}}`", *fit.time_offset_s);
  }
  if (fit.lever_arm_m && hypothesis.what.starts_with("the lever")) {
    const Eigen::Vector3d &l = *fit.lever_arm_m, &sd = *fit.lever_arm_sd_m;
    cause.what +=
        fmt::format(" ({:.2f}, {:.2f}, {:.2f}) +- ({:.2f}, {:.2f}, {:.2f}) m", l.x(), l.y(), l.z(), sd.x(), sd.y(), sd.z());
    cause.remedy = fmt::format("`imu: {{lever_arm_m: [{:.2f}, {:.2f}, {:.2f}]}}`", l.x(), l.y(), l.z());
  }
  return cause;
}

/// Fits of one hypothesis with several factors on the noise of the IMU, in parallel.
struct Profile {
  const CauseHypothesis* hypothesis = nullptr;
  std::vector<double> noise;
  std::vector<Fit> fits;
  [[nodiscard]] std::size_t best() const {
    const auto most = std::ranges::max_element(fits, {}, &Fit::log_likelihood);
    return static_cast<std::size_t>(most - fits.begin());
  }
  [[nodiscard]] double log_likelihood() const { return fits[best()].log_likelihood; }
};

void run(const Excerpt& excerpt, const Setup& setup, std::vector<Profile>& profiles) {
  std::vector<std::pair<Profile*, std::size_t>> missing;
  for (Profile& profile : profiles) {
    const std::size_t done = profile.fits.size();
    profile.fits.resize(profile.noise.size());
    for (std::size_t i = done; i < profile.noise.size(); ++i) missing.emplace_back(&profile, i);
  }
  coast::parallel_for(std::size_t{0}, missing.size(), [&](std::size_t k) {
    auto& [profile, i] = missing[k];
    const bool aligned = i > 0 && profile->fits.front().start;
    profile->fits[i] = fit(excerpt, setup, profile->hypothesis, profile->noise[i], aligned ? &profile->fits.front() : nullptr);
  });
}

// A fit requested in the run file is not reported as advice.
std::optional<Cause> noise_cause(double factor, double gain, const estimate::NoiseFitChoice& fitted) {
  if (factor > 1.0 ? fitted.imu_white_noise : fitted.gnss_scale) return std::nullopt;
  if (factor > 1.0)
    return Cause{fmt::format("the IMU's noise is about {:.0f} times what is stated", factor), "`imu: {noise: estimated}`", gain,
                 false};
  return Cause{fmt::format("the noise of the fixes is about {:.0f} times what is stated", 1.0 / factor),
               "`gnss: {noise: estimated}`", gain, false};
}

// A gap remains a gap: the next sample is added only if it follows at once.
void add_thinned(const record::ImuSample& sample, double longest, std::vector<record::ImuSample>& thinned) {
  constexpr double kFollows = 1e-4;  // s
  if (thinned.empty() || thinned.back().dt + sample.dt > longest ||
      std::abs(sample.t - sample.dt - thinned.back().t) > kFollows) {
    thinned.push_back(sample);
    return;
  }
  record::ImuSample& last = thinned.back();
  last.t = sample.t;
  last.dt += sample.dt;
  last.dtheta += sample.dtheta;
  last.dv += sample.dv;
}

}  // namespace

Excerpt excerpt_of(const record::ImuRecording& imu, const record::GnssRecording& gnss) {
  const auto& fixes = gnss.fixes;
  const auto moving = std::ranges::find_if(
      fixes, [&](const record::GnssFix& fix) { return (fix.r_ea_e - fixes.front().r_ea_e).norm() > kMoved; });
  const geo::GpsTime from = (moving == fixes.end() ? fixes.front().t : moving->t) - kBeforeMotion;
  const geo::GpsTime to = from + kSeconds;
  const auto inside = [&](const auto& record) { return record.t >= from && record.t <= to; };
  Excerpt excerpt;
  excerpt.imu.source = imu.source;
  excerpt.gnss.source = gnss.source;
  constexpr double kRounding = 0.01;
  const double together = std::max(1.0, std::floor(kImuInterval * imu.rate_hz + kRounding));
  excerpt.imu.rate_hz = imu.rate_hz / together;
  for (const record::ImuSample& s : imu.samples)
    if (inside(s)) add_thinned(s, (together + 0.5) / imu.rate_hz, excerpt.imu.samples);
  for (const record::GnssFix& fix : fixes)
    if (inside(fix) && (excerpt.gnss.fixes.empty() || fix.t - excerpt.gnss.fixes.back().t >= kFixInterval))
      excerpt.gnss.fixes.push_back(fix);
  return excerpt;
}

std::vector<Cause> rank_causes(const Excerpt& excerpt, const Setup& stated) {
  constexpr double kLeastGain = 20.0;
  constexpr double kFits = 5.0;  // on the sigmas
  constexpr std::ptrdiff_t kLikely = 3;
  if (!stated.model.members().empty()) return {};  // an excerpt has no members
  const std::vector<CauseHypothesis> hypotheses = cause_hypotheses();
  std::vector<Profile> profiles{{nullptr, {10.0}, {}}};
  for (const CauseHypothesis& hypothesis : hypotheses) profiles.push_back({&hypothesis, {10.0}, {}});
  run(excerpt, stated, profiles);
  const auto less_likely = [](const Profile& a, const Profile& b) { return a.log_likelihood() > b.log_likelihood(); };
  std::sort(profiles.begin() + 1, profiles.end(), less_likely);
  profiles.front().noise = {10.0, 0.03, 0.1, 0.3, 1.0, 3.0, 30.0, 100.0};
  for (auto p = profiles.begin() + 1; p < profiles.begin() + 1 + kLikely; ++p) p->noise = {10.0, 1.0, 3.0, 30.0, 100.0};
  run(excerpt, stated, profiles);
  std::sort(profiles.begin() + 1, profiles.end(), less_likely);

  const Profile& described = profiles.front();
  const bool aligned = std::isfinite(described.log_likelihood());
  double least = described.log_likelihood();  // if alignment fails, the likelihood is that of the least likely of the others
  if (!aligned)
    for (const Profile& p : profiles)
      if (std::isfinite(p.log_likelihood())) least = p.log_likelihood();
  std::vector<Cause> causes;
  for (auto p = profiles.begin() + 1; p != profiles.end(); ++p) {
    const Fit& best = p->fits[p->best()];
    const double gain = best.log_likelihood - least;
    if (gain > kLeastGain && (aligned || best.factor < kFits)) causes.push_back(told(*p->hypothesis, best, gain));
  }
  const auto as_stated = static_cast<std::size_t>(std::ranges::find(described.noise, 1.0) - described.noise.begin());
  const double gain = least - described.fits[as_stated].log_likelihood;
  if (!aligned || !std::isfinite(gain) || gain < kLeastGain) return causes;
  constexpr estimate::NoiseFitChoice kNothing{.gnss_scale = false, .correlated_gnss = false, .imu_white_noise = false};
  if (auto cause = noise_cause(described.noise[described.best()], gain, stated.noise_fit.value_or(kNothing)))
    causes.push_back(std::move(*cause));
  return causes;
}

}  // namespace coast::study
