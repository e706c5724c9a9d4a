#include "process/event_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "coast/geo/earth.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/geo/units.hpp"
#include "coast/io/event_writers.hpp"

namespace coast::jobs {

namespace {

using Severity = record::Event::Severity;
using Why = study::MissedMark::Why;

std::string events_of(std::size_t number) {
  return fmt::format("{} event{}", number, number == 1 ? "" : "s");
}

void tell_missed(const std::vector<study::MissedMark>& missed, ProcessResult& result) {
  for (const auto& [why, kind, where] : {std::tuple{Why::kBefore, "event_before_trajectory", "before the trajectory"},
                                         {Why::kGap, "event_in_gap", "in a gap of the IMU"},
                                         {Why::kAfter, "event_after_trajectory", "behind the trajectory"}}) {
    const auto first = std::ranges::find(missed, why, &study::MissedMark::why);
    if (first == missed.end()) continue;
    const auto number = static_cast<std::size_t>(std::ranges::count(missed, why, &study::MissedMark::why));
    result.events.push_back(
        {Severity::kWarning, kind,
         fmt::format("{} {} left out, first {} at {}", events_of(number), where, first->mark.id, geo::to_string(first->mark.t)),
         first->mark.t, static_cast<long>(number)});
  }
}

void tell_unnamed(const std::vector<record::MarkedState>& states, ProcessResult& result) {
  const auto is_left_out = [](const record::MarkedState& state) { return !io::odm_geo_names(state.mark); };
  const auto number = std::ranges::count_if(states, is_left_out);
  if (number == 0) return;
  const auto first = std::ranges::find_if(states, is_left_out);
  result.events.push_back(
      {Severity::kWarning, "event_name",
       fmt::format("{} left out of geo.txt, which separates its columns by blanks: the name contains one, first \"{}\"",
                   events_of(static_cast<std::size_t>(number)), first->mark.id),
       first->mark.t, static_cast<long>(number)});
}

void tell_delay(double stated_s, const study::DelayEstimate& delay, ProcessResult& result) {
  constexpr double kSignificant = 3.0;  // sigma
  const bool seen = std::abs(delay.delay_s) > kSignificant * delay.sd_s;
  result.events.push_back(
      {seen ? Severity::kWarning : Severity::kInfo, "event_delay",
       fmt::format(
           "Positions stated beside {} agree with the trajectory {:.1f} ms later than stated (sd {:.1f} ms, {:.2f} m rms "
           "horizontally, offset {:+.2f} m north, {:+.2f} m east). {}",
           events_of(delay.marks), 1e3 * delay.delay_s, 1e3 * delay.sd_s, delay.residual_m, delay.offset_n.x(),
           delay.offset_n.y(),
           seen ? fmt::format("To use it, write `events: {{delay_s: {:.4f}}}`.", stated_s + delay.delay_s)
                : std::string("That is no significant delay.")),
       std::nullopt, 1});
}

}  // namespace

std::optional<study::MarkedStates> marked_states(const Work& work, double time_offset_s) {
  if (!work.config.events || !work.marks) return std::nullopt;
  constexpr double kIntervals = 2.5;  // a sample may be missing between two: interpolation costs less than the sensor's noise
  const EventOptions& options = *work.config.events;
  const double delay_s = options.delay_s - (options.imu_clock ? 0.0 : time_offset_s);
  return study::MarkedStates(work.marks->marks, delay_s, options.camera, kIntervals / work.mission.mission().imu.rate_hz);
}

void note_events(const Work& work, const study::MarkedStates& marked, ProcessResult& result) {
  result.marked = EventResults{marked.states(), marked.missed(), study::estimate_delay(marked.states())};
  tell_missed(result.marked->missed, result);
  tell_unnamed(result.marked->states, result);
  if (result.marked->delay) tell_delay(work.config.events->delay_s, *result.marked->delay, result);
}

WorstSigmas worst_sigmas(const std::vector<record::MarkedState>& states) {
  WorstSigmas worst;
  double largest = -1.0;
  for (const record::MarkedState& state : states) {
    const Eigen::Matrix3d C_e_n = geo::C_n_e(geo::geodetic_from_ecef(state.nav.r_eb_e)).transpose();
    const Eigen::Matrix3d J = geo::euler_jacobian(geo::euler_from_dcm(C_e_n * state.nav.q_b_e.toRotationMatrix()));
    const auto sd = [](const Eigen::Matrix3d& cov) { return cov.diagonal().cwiseMax(0.0).cwiseSqrt().eval(); };
    worst.position = worst.position.cwiseMax(sd(state.cov.position));
    worst.attitude = worst.attitude.cwiseMax(sd(J * state.cov.attitude * J.transpose()));
    const double trace = state.cov.position.trace();
    if (trace <= largest) continue;
    largest = trace;
    worst.id = state.mark.id;
  }
  return worst;
}

std::string events_text(const EventResults& marked, const record::Events& told) {
  std::string text = fmt::format("{} located, {} missed", events_of(marked.states.size()), marked.missed.size());
  if (!marked.states.empty()) {
    const WorstSigmas worst = worst_sigmas(marked.states);
    const Eigen::Vector3d degrees = worst.attitude / geo::kDegree;
    text += fmt::format("; largest sigmas {:.3f} {:.3f} {:.3f} m N E D ({}), {:.3f} {:.3f} {:.3f} deg roll pitch yaw",
                        worst.position.x(), worst.position.y(), worst.position.z(), worst.id, degrees.x(), degrees.y(),
                        degrees.z());
  }
  text += '\n';
  for (const record::Event& event : told)
    if (event.kind.starts_with("event_"))
      text += fmt::format("{}{}\n", event.severity == Severity::kWarning ? "warning: " : "", event.text);
  return text;
}

}  // namespace coast::jobs
