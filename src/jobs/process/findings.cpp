// Findings on the configuration from the solved mission.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coast/noise/chi_square.hpp"
#include "process/stages.hpp"
#include "process/summary.hpp"

namespace coast::jobs {

void count_innovations(const Work& work, ProcessResult& result) {
  // An error along the axis of largest sigma is rejected above sqrt(threshold) times this sigma.
  const double probability = work.mission.options().gate_probability;
  const double gate = probability > 0.0 ? std::sqrt(noise::chi2_upper_quantile(3, probability)) : 0.0;
  std::vector<double> blind;
  for (const estimate::InnovationRecord& r : result.innovations) {
    if (!estimate::is_position(r.kind)) continue;
    ++(r.used ? result.gnss_used : result.gnss_rejected);
    if (gate > 0.0 && r.largest_sd > 0.0) blind.push_back(r.largest_sd * gate);
  }
  if (!blind.empty()) {
    std::nth_element(blind.begin(), blind.begin() + static_cast<std::ptrdiff_t>(blind.size() / 2), blind.end());
    result.smallest_refusable_m = blind[blind.size() / 2];
  }
  result.nis = nis_of(result.innovations);
}

void count_aids(const Work& work, ProcessResult& result) {
  for (const estimate::AidStream& stream : work.mission.mission().aids) result.aids.push_back({stream.name, 0, 0, {}});
  for (const estimate::InnovationRecord& r : result.innovations) {
    if (r.kind != estimate::UpdateKind::kAid) continue;
    AidUse& aid = result.aids[r.aid];
    ++(r.used ? aid.used : aid.refused);
    if (!r.used) continue;
    ++aid.nis.epochs;
    aid.nis.mean += r.nis;
    aid.nis.expected += r.dof;
  }
  for (AidUse& aid : result.aids) {
    if (aid.nis.epochs == 0) continue;
    aid.nis.mean /= static_cast<double>(aid.nis.epochs);
    aid.nis.expected /= static_cast<double>(aid.nis.epochs);
  }
}

void offer_gnss_noise(const Work& work, ProcessResult& result) {
  constexpr double kFits = 1.25;        // rms of the innovations over their sigma, or its inverse
  constexpr std::size_t kFewest = 100;  // epochs; fewer have little significance
  constexpr double kWindow = 300.0;     // s
  const double ratio = std::sqrt(result.nis.mean / result.nis.expected);
  if (work.config.tight) return;  // no fixes, no sigmas of fixes
  if (result.noise_fit || result.nis.epochs < kFewest || (ratio < kFits && ratio > 1.0 / kFits)) return;
  constexpr estimate::NoiseFitChoice kGnssAlone{.gnss_scale = true, .correlated_gnss = true, .imu_white_noise = false};
  const estimate::NoiseFit fit =
      work.mission.fit(kGnssAlone, estimate::starting_point(work.mission.options(), kGnssAlone), kWindow, work.progress);
  const estimate::GnssScale& scale = fit.adjustment.gnss_scale;
  const estimate::CorrelatedGnss& correlated = fit.adjustment.correlated_gnss;
  result.events.push_back(
      {record::Event::Severity::kWarning, "gnss_sigmas_do_not_fit",
       fmt::format(
           "Innovations are {:.2g} times their sigma. The first {:.0f} s are likeliest with the GNSS sigmas times {:.2g} "
           "horizontally and {:.2g} vertically, and errors of {:.2g} and {:.2g} m that last {:.3g} s beside them. Set "
           "`gnss.noise: estimated` to have this fitted and used, `imu.noise: estimated` where the IMU shakes.",
           ratio, std::min(kWindow, result.end - result.start), scale.horizontal, scale.vertical, correlated.horizontal_m,
           correlated.vertical_m, correlated.time_s),
       std::nullopt, 1});
}

void study_sweep(const Work& work, const Delivery& delivery, const EarlierPasses& passes, ProcessResult& result) {
  if (!work.config.sweep || !work.config.smooth) return;
  const study::Truth truth = work.reference ? study::Truth{*work.reference, work.config.reference_lever_arm_b}
                                            : study::Truth{delivery.gap_free.trajectory()};
  // Data withheld by an outage of the sweep must not be used through the start that later passes take from earlier ones.
  study::Solution single;
  if (passes.carried) single = study::solve(work.mission, work.mission.options(), true, {}, work.progress);
  const estimate::KnotStore& knots = passes.carried ? single.knots : delivery.solution.knots;
  const std::vector<study::Outage> outages = study::outages_of(*work.config.sweep, result.start, result.end);
  std::size_t done = 0;
  result.sweep = study::run_outages(work.mission, knots, truth, outages, [&](std::size_t, const study::OutageResult&) {
    work.progress("studying outages", static_cast<double>(++done) / static_cast<double>(outages.size()));
  });
}

std::vector<Separation> separate_forward_and_backward(const Work& work, const Delivery& delivery, bool carried) {
  SeparationRecorder recorder(delivery.forward_knots);
  // Multi-pass gives the separation of two filters that have both converged.
  const estimate::FilterState& last = delivery.solution.forward.last;
  work.mission.run_backward(
      work.options(), carried ? last : work.mission.far_end(last),
      [&](const estimate::FilterState& state) { recorder.add(state); }, work.progress);
  return std::move(recorder).in_order();
}

// If innovations are too large, the sigmas of their estimates are too small by the same factor.
void doubt_lever_arm(const Work& work, ProcessResult& result) {
  constexpr double kSigmas = 6.0;
  constexpr double kLeast = 0.15;      // m
  constexpr double kObservable = 0.2;  // m
  if (!result.lever_arm || work.mission.options().auxiliary.lever_arm_sd_m > 0.0 || !(result.nis.expected > 0.0)) return;
  const double excess = std::sqrt(std::max(1.0, result.nis.mean / result.nis.expected));
  const Eigen::Vector3d& difference = result.lever_arm->difference_m;
  const Eigen::Vector3d sd = excess * result.lever_arm->sd_m;
  bool contradicted = false;
  for (Eigen::Index i = 0; i < 3; ++i)
    contradicted |= sd(i) < kObservable && std::abs(difference(i)) > std::max(kLeast, kSigmas * sd(i));
  if (!contradicted) return;
  const Eigen::Vector3d& stated = work.mission.setup().lever_arm_b;
  const Eigen::Vector3d found = stated + difference;
  result.events.push_back(
      {record::Event::Severity::kWarning, "lever_arm_contradicted",
       fmt::format(
           "The recording shows the antenna at ({:.2f}, {:.2f}, {:.2f}) m +- ({:.2f}, {:.2f}, {:.2f}), forward right down "
           "of the IMU; the file says ({:.2f}, {:.2f}, {:.2f}). Measure it again, or set `imu.lever_arm_m: [{:.2f}, {:.2f}, "
           "{:.2f}]`.",
           found.x(), found.y(), found.z(), sd.x(), sd.y(), sd.z(), stated.x(), stated.y(), stated.z(), found.x(), found.y(),
           found.z()),
       std::nullopt, 1});
}

namespace {

std::string three(const Eigen::Vector3d& v) {
  return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v.x(), v.y(), v.z());
}

std::string drift_factors(const study::DriftFactors& drift) {
  if (drift.largest() == 1.0) return "";
  return fmt::format(", drift_factors: {{gyro: {}, accel: {}}}", three(drift.gyro), three(drift.accel));
}

}  // namespace

void note_last_state(const Work& work, const Delivery& delivery, ProcessResult& result) {
  const estimate::StateLayout& layout = delivery.solution.filter->layout();
  const estimate::FilterState& last = delivery.solution.forward.last;
  for (const noise::Sensor sensor : {noise::Sensor::kGyro, noise::Sensor::kAccel})
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::RowVectorXd h = Eigen::RowVectorXd::Zero(last.x.size());
      for (const estimate::StateLayout::SensorBlock& block : layout.sensors())
        if (block.sensor == sensor && block.axis == axis && !block.signal_axis)
          h.segment(block.offset, block.size) = block.output;
      const bool gyro = sensor == noise::Sensor::kGyro;
      (gyro ? result.biases.gyro : result.biases.accel)(axis) = h.dot(last.x);
      (gyro ? result.biases.gyro_sd : result.biases.accel_sd)(axis) = std::sqrt(std::max(0.0, h.dot(last.P * h.transpose())));
    }
  result.lever_arm_used_b = work.mission.mission().lever_arm_b;
  if (!layout.lever_arm()) return;
  result.lever_arm_used_b += last.x.segment<3>(*layout.lever_arm());
  result.lever_arm_sd_m = last.P.diagonal().segment<3>(*layout.lever_arm()).cwiseSqrt();
}

void note_estimates(const Work& work, const ProcessResult& result) {
  if (work.mission.options().auxiliary.time_offset_sd_s > 0.0 ||
      work.mission.mission().time_offset_s != work.config.setup.time_offset_s)
    work.config.root.section("gnss").note_estimated("time_offset_s",
                                                    fmt::format("{:.17g}", work.mission.mission().time_offset_s));
  const Eigen::Vector3d& arm = work.mission.mission().lever_arm_b;
  if (work.mission.options().auxiliary.lever_arm_sd_m > 0.0)
    work.config.root.section("imu").note_estimated("lever_arm_m", three(arm));
  if (!result.noise_fit) return;
  const estimate::NoiseAdjustment& a = result.noise_fit->adjustment;
  const estimate::NoiseFitChoice& choice = *work.mission.setup().noise_fit;
  if (choice.imu_white_noise)
    work.config.root.section("imu").note_estimated(
        "noise", fmt::format("{{gyro_factor: {}, accel_factor: {}{}{}}}", three(a.gyro_factors), three(a.accel_factors),
                             drift_factors(work.mission.drift()),
                             work.mission.gain_errors_left_out() ? ", without_gain_errors: true" : ""));
  if (choice.gnss_scale)
    work.config.root.section("gnss").note_estimated(
        "noise",
        fmt::format("{{scale_horizontal: {:.17g}, scale_vertical: {:.17g}, scale_velocity: {:.17g}, correlated_horizontal_m: "
                    "{:.17g}, correlated_vertical_m: {:.17g}, correlated_time_s: {:.17g}}}",
                    a.gnss_scale.horizontal, a.gnss_scale.vertical, a.gnss_scale.velocity, a.correlated_gnss.horizontal_m,
                    a.correlated_gnss.vertical_m, a.correlated_gnss.time_s));
}

}  // namespace coast::jobs
