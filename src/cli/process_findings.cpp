// The stages that judge the result, and what is told of it.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coast/io/writers.hpp"
#include "coast/report/render.hpp"
#include "process_run.hpp"
#include "summary.hpp"

namespace coast::cli {

void ProcessRun::check_lever_arm() {
  constexpr double kPriorSd = 0.5;  // m: wide against what a tape measure misses
  if (mission_.mission().gnss.fixes.size() > 10) result_.lever_arm = study::check_lever_arm(mission_, kPriorSd, {});
}

// Where innovations are too large, so are the sigmas of what they show too small.
void ProcessRun::doubt_lever_arm() {
  constexpr double kSigmas = 6.0;
  constexpr double kLeast = 0.15;      // m
  constexpr double kObservable = 0.2;  // m
  if (!result_.lever_arm || mission_.options().auxiliary.lever_arm_sd_m > 0.0 || !(result_.nis.expected > 0.0)) return;
  const double excess = std::sqrt(std::max(1.0, result_.nis.mean / result_.nis.expected));
  const Eigen::Vector3d& difference = result_.lever_arm->difference_m;
  const Eigen::Vector3d sd = excess * result_.lever_arm->sd_m;
  bool contradicted = false;
  for (Eigen::Index i = 0; i < 3; ++i)
    contradicted |= sd(i) < kObservable && std::abs(difference(i)) > std::max(kLeast, kSigmas * sd(i));
  if (!contradicted) return;
  const Eigen::Vector3d& stated = mission_.setup().lever_arm_b;
  const Eigen::Vector3d found = stated + difference;
  result_.events.push_back(
      {record::Event::Severity::kWarning, "lever_arm_contradicted",
       fmt::format(
           "The recording shows the antenna at ({:.2f}, {:.2f}, {:.2f}) m +- ({:.2f}, {:.2f}, {:.2f}), forward right down "
           "of the IMU; the file says ({:.2f}, {:.2f}, {:.2f}). Measure it again, or set `imu.lever_arm_m: [{:.2f}, {:.2f}, "
           "{:.2f}]`.",
           found.x(), found.y(), found.z(), sd.x(), sd.y(), sd.z(), stated.x(), stated.y(), stated.z(), found.x(), found.y(),
           found.z()),
       std::nullopt, 1});
}

void ProcessRun::judge() {
  doubt_lever_arm();
  std::vector<Check> checks = motion_.checks();
  const estimate::FilterState& last = solution_.forward.last;
  if (auto check = sensor_check(solution_.filter->layout(), last.x)) checks.push_back(std::move(*check));
  result_.verdict = cli::judge(result_, std::move(checks));
  if (result_.verdict.standing() != Standing::kGood && !result_.verdict.only_jumps()) rank_causes();
  result_.verdict.accepted = config_.accept;
}

void ProcessRun::rank_causes() {
  progress_("looking for the cause", 0.0);
  result_.verdict.causes = study::rank_causes(excerpt_, setup_);
  if (const std::string cause = told(result_.verdict.causes); !cause.empty()) result_.verdict.likely_cause = cause;
}

void ProcessRun::separate_forward_and_backward() {
  SeparationRecorder recorder(forward_knots_.knots());
  // Multi-pass shows the separation of two filters that have both converged.
  const estimate::FilterState& last = solution_.forward.last;
  mission_.run_backward(
      options_with_outages(), carried_ ? last : mission_.far_end(last),
      [&](const estimate::FilterState& state) { recorder.add(state); }, progress_);
  result_.separations = std::move(recorder).in_order();
}

namespace {

std::string drift_factors(const study::DriftFactors& drift) {
  if (drift.largest() == 1.0) return "";
  const auto three = [](const Eigen::Vector3d& v) { return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v.x(), v.y(), v.z()); };
  return fmt::format(", drift_factors: {{gyro: {}, accel: {}}}", three(drift.gyro), three(drift.accel));
}

}  // namespace

// What the run found stands in the resolved file as comments, ready to be stated in another run.
void ProcessRun::note_estimates() const {
  if (mission_.options().auxiliary.time_offset_sd_s > 0.0 || mission_.mission().time_offset_s != config_.setup.time_offset_s)
    config_.root.at("gnss").note_estimated("time_offset_s", fmt::format("{:.17g}", mission_.mission().time_offset_s));
  const Eigen::Vector3d& arm = mission_.mission().lever_arm_b;
  if (mission_.options().auxiliary.lever_arm_sd_m > 0.0)
    config_.root.at("imu").note_estimated("lever_arm_m", fmt::format("[{:.17g}, {:.17g}, {:.17g}]", arm.x(), arm.y(), arm.z()));
  if (!result_.noise_fit) return;
  const estimate::NoiseAdjustment& a = result_.noise_fit->adjustment;
  const estimate::NoiseFitChoice& choice = *mission_.setup().noise_fit;
  if (choice.imu_white_noise)
    config_.root.at("imu").note_estimated(
        "noise",
        fmt::format("{{gyro_factor: {:.17g}, accel_factor: {:.17g}{}{}}}", a.gyro_factor, a.accel_factor,
                    drift_factors(mission_.drift()), mission_.gain_errors_left_out() ? ", without_gain_errors: true" : ""));
  if (choice.gnss_scale)
    config_.root.at("gnss").note_estimated(
        "noise",
        fmt::format("{{scale_horizontal: {:.17g}, scale_vertical: {:.17g}, scale_velocity: {:.17g}, correlated_horizontal_m: "
                    "{:.17g}, correlated_vertical_m: {:.17g}, correlated_time_s: {:.17g}}}",
                    a.gnss_scale.horizontal, a.gnss_scale.vertical, a.gnss_scale.velocity, a.correlated_gnss.horizontal_m,
                    a.correlated_gnss.vertical_m, a.correlated_gnss.time_s));
}

std::string ProcessRun::write_results() {
  progress_("writing", 0.0);
  note_estimates();
  const std::string resolved = config_.root.resolved_yaml();
  io::write_text(out_ / "run.resolved.yaml", resolved);
  io::write_text(out_ / "innovations.csv", innovations_csv(result_.innovations));
  const report::Page page = make_page({config_, result_, mission_, curves_, resolved});
  io::write_text(out_ / "report.json", report::to_json(page));
  io::write_text(out_ / "report.html", report::render(page));
  io::write_text(out_ / "summary.json", summary_json(result_));
  return summary_text(result_);
}

}  // namespace coast::cli
