#include "coast/study/causes.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "coast/geo/units.hpp"
#include "coast/record/error.hpp"

namespace coast::study {

namespace {

constexpr double kSeconds = 120.0;
constexpr double kBeforeMotion = 20.0;
constexpr double kMoved = 10.0;                // m
constexpr double kTimeSd = 0.5, kArmSd = 1.0;  // s, m: left to the data

// Each hypothesis costs several passes: what turns and accelerates a vehicle is seen at these rates too.
constexpr double kImuInterval = 0.02;  // s: as many increments are added up as it holds
constexpr double kFixInterval = 0.45;  // s, at least

/// What a hypothesis changes, and how it is told.
struct Hypothesis {
  std::string what;
  std::string remedy;
  std::function<void(Excerpt&, Setup&)> apply;
};

struct Fit {
  double log_likelihood = -std::numeric_limits<double>::infinity();  // concentrated
  double factor = 1.0;                                               // on the sigmas, where it is largest
  std::optional<double> time_offset_s, time_offset_sd_s;
  std::optional<Eigen::Vector3d> lever_arm_m, lever_arm_sd_m;
};

void change_gyro(Excerpt& excerpt, const Eigen::Matrix3d& M) {
  for (record::ImuSample& s : excerpt.imu.samples) s.dtheta = M * s.dtheta;
}

void change_accel(Excerpt& excerpt, double factor) {
  for (record::ImuSample& s : excerpt.imu.samples) s.dv *= factor;
}

void add_signs_and_axes(std::vector<Hypothesis>& all) {
  static constexpr std::array<const char*, 3> kAxis{"x", "y", "z"};
  for (Eigen::Index i = 0; i < 3; ++i) {
    Eigen::Matrix3d turned = Eigen::Matrix3d::Identity();
    turned(i, i) = -1.0;
    const char* axis = kAxis[static_cast<std::size_t>(i)];
    all.push_back({fmt::format("the sign of the gyro about body {} is turned", axis),
                   "turn that column in the file, or correct `columns` and `axes`",
                   [turned](Excerpt& excerpt, Setup&) { change_gyro(excerpt, turned); }});
    const Eigen::Index j = (i + 1) % 3;
    Eigen::Matrix3d exchanged = Eigen::Matrix3d::Identity();
    exchanged.row(i).swap(exchanged.row(j));
    all.push_back({fmt::format("the gyros about body {} and {} are exchanged", axis, kAxis[static_cast<std::size_t>(j)]),
                   "exchange them in `columns: {gyro: [..]}`",
                   [exchanged](Excerpt& excerpt, Setup&) { change_gyro(excerpt, exchanged); }});
    Eigen::Matrix3d others = -turned;
    all.push_back({fmt::format("the gyro's axes are turned by 180 deg about body {} against the accelerometer's", axis),
                   "correct `columns` and `axes`, which both share",
                   [others](Excerpt& excerpt, Setup&) { change_gyro(excerpt, others); }});
  }
  all.push_back({"all signs of the gyro are turned", "`scale: {gyro: -1}`",
                 [](Excerpt& excerpt, Setup&) { change_gyro(excerpt, -Eigen::Matrix3d::Identity()); }});
}

void add_units(std::vector<Hypothesis>& all) {
  const auto gyro = [&all](const char* what, const char* remedy, double factor) {
    all.push_back({what, remedy, [factor](Excerpt& e, Setup&) { change_gyro(e, factor * Eigen::Matrix3d::Identity()); }});
  };
  gyro("the gyro is in deg/s", "`units: {gyro: deg/s}`", geo::kDegree);
  gyro("the gyro is in rad/s", "`units: {gyro: rad/s}`", 1.0 / geo::kDegree);
  all.push_back(
      {"the accelerometer is in g", "`units: {accel: g}`", [](Excerpt& e, Setup&) { change_accel(e, geo::kStandardGravity); }});
  all.push_back({"the accelerometer is in m/s^2", "`units: {accel: m/s^2}`",
                 [](Excerpt& e, Setup&) { change_accel(e, 1.0 / geo::kStandardGravity); }});
}

void add_antenna(std::vector<Hypothesis>& all) {
  all.push_back({"the lever arm is", "", [](Excerpt&, Setup& setup) { setup.filter.auxiliary.lever_arm_sd_m = kArmSd; }});
  all.push_back({"the time offset is", "", [](Excerpt&, Setup& setup) { setup.filter.auxiliary.time_offset_sd_s = kTimeSd; }});
  for (const double shift : {-18.0, 18.0})
    all.push_back({"the time offset is", "", [shift](Excerpt&, Setup& setup) {
                     setup.time_offset_s += shift;
                     setup.filter.auxiliary.time_offset_sd_s = kTimeSd;
                   }});
}

std::vector<Hypothesis> catalogue() {
  std::vector<Hypothesis> all;
  add_signs_and_axes(all);
  add_units(all);
  add_antenna(all);
  return all;
}

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

// Nothing adapted.
Setup as_described(const Setup& stated) {
  Setup setup = stated;
  setup.unstated = {};
  setup.noise_fit.reset();
  setup.start.reset();
  setup.carrier.reset();
  setup.refine_before.reset();
  setup.fit_before.reset();
  setup.filter.gate_probability = 0.0;
  return setup;
}

// Where the start is found by them too, each fit takes ten passes more: that is left to the hypotheses that are about them.
estimate::FilterOptions antenna_left_to_data(estimate::FilterOptions options, const Setup& stated) {
  estimate::AuxiliaryStates& auxiliary = options.auxiliary;
  if (stated.unstated.time_offset && auxiliary.time_offset_sd_s == 0.0) auxiliary.time_offset_sd_s = kTimeSd;
  if (stated.unstated.lever_arm && auxiliary.lever_arm_sd_m == 0.0) auxiliary.lever_arm_sd_m = kArmSd;
  return options;
}

/// Under a hypothesis (none: as described) and with the white noise of the IMU times `noise`.
Fit fit(const Excerpt& excerpt, const Setup& stated, const Hypothesis* hypothesis, double noise) {
  Excerpt changed = excerpt;
  Setup setup = as_described(stated);
  if (hypothesis != nullptr) hypothesis->apply(changed, setup);
  for (const noise::Sensor sensor : {noise::Sensor::kGyro, noise::Sensor::kAccel})
    setup.model = setup.model.with_white_noise_scaled(sensor, noise);
  Fit result;
  try {
    const PreparedMission mission(std::move(changed.imu), std::move(changed.gnss), setup, {});
    const estimate::ForwardFilter filter(mission.mission(), mission.model(), antenna_left_to_data(mission.options(), stated));
    const estimate::FilterResult run = filter.run(mission.start_state(filter), {});
    double nis = 0.0, dof = 0.0;
    for (const estimate::InnovationRecord& r : run.innovations) {
      nis += r.nis;
      dof += r.dof;
    }
    if (!(dof > 0.0) || !std::isfinite(run.log_likelihood)) return result;
    result.factor = std::sqrt(nis / dof);
    result.log_likelihood = run.log_likelihood + 0.5 * nis - 0.5 * dof * (1.0 + std::log(nis / dof));
    note_antenna(run.last, filter.layout(), mission.mission(), result);
  } catch (const NumericalError&) {  // not even a start: not likely
  } catch (const InputError&) {      // no common time under this shift
  }
  return result;
}

Cause told(const Hypothesis& hypothesis, const Fit& fit, double gain) {
  Cause cause{hypothesis.what, hypothesis.remedy, gain};
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

/// Fits of one hypothesis with several factors on the noise of the IMU, side by side.
struct Profile {
  const Hypothesis* hypothesis = nullptr;
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
  tbb::parallel_for(std::size_t{0}, missing.size(), [&](std::size_t k) {
    auto& [profile, i] = missing[k];
    profile->fits[i] = fit(excerpt, setup, profile->hypothesis, profile->noise[i]);
  });
}

Cause noise_cause(double factor, double gain) {
  if (factor > 1.0)
    return {fmt::format("the IMU's noise is about {:.0f} times what is stated", factor), "`imu: {noise: estimated}`", gain};
  return {fmt::format("the noise of the fixes is about {:.0f} times what is stated", 1.0 / factor),
          "`gnss: {noise: estimated}`", gain};
}

// A gap stays a gap: the next sample is added only where it follows at once.
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
  const std::vector<Hypothesis> hypotheses = catalogue();
  std::vector<Profile> profiles{{nullptr, {10.0, 0.03, 0.1, 0.3, 1.0, 3.0, 30.0, 100.0}, {}}};
  for (const Hypothesis& hypothesis : hypotheses) profiles.push_back({&hypothesis, {10.0}, {}});
  run(excerpt, stated, profiles);
  const auto less_likely = [](const Profile& a, const Profile& b) { return a.log_likelihood() > b.log_likelihood(); };
  std::sort(profiles.begin() + 1, profiles.end(), less_likely);
  for (auto p = profiles.begin() + 1; p < profiles.begin() + 1 + kLikely; ++p) p->noise = {10.0, 1.0, 3.0, 30.0, 100.0};
  run(excerpt, stated, profiles);
  std::sort(profiles.begin() + 1, profiles.end(), less_likely);

  const Profile& described = profiles.front();
  const bool aligned = std::isfinite(described.log_likelihood());
  double least = described.log_likelihood();  // what cannot even be aligned is as likely as the least likely of the rest
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
  if (aligned && std::isfinite(gain) && gain > kLeastGain)
    causes.push_back(noise_cause(described.noise[described.best()], gain));
  return causes;
}

}  // namespace coast::study
