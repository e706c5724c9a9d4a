#include "process/state_tracks.hpp"

#include <algorithm>
#include <cmath>

#include "coast/study/comparison.hpp"

namespace coast::jobs {

namespace {
constexpr double kSampledKnots = 20000.0;  // a page is some 2000 pixels wide
}  // namespace

KnotState knot_state(const estimate::FilterState& state) {
  return {state.nav, estimate::nav_covariance_n(state.P.topLeftCorner<estimate::kNav, estimate::kNav>(), state.nav.r_eb_e),
          state.x, state.P.diagonal().cwiseSqrt()};
}

estimate::KnotSampling knot_sampling(double mission_s) {
  return estimate::KnotSampling(mission_s / kSampledKnots);
}

void KnotStates::add(const estimate::FilterState& state) {
  if (sampling_.takes(previous_, state.nav.t)) knots_.push_back(knot_state(state));
  previous_ = state.nav.t;
}

std::vector<StateTrack> state_tracks(const estimate::StateLayout& layout, geo::GpsTime start,
                                     const std::vector<KnotState>& forward,
                                     const std::vector<estimate::SmoothedKnot>& smoothed) {
  std::vector<StateTrack> tracks;
  const auto add = [&](const estimate::StateLayout::Block& block) {
    for (int i = 0; i < block.size; ++i) {
      StateTrack track;
      track.name = block.size > 1 ? block.name + " " + std::to_string(i + 1) : block.name;
      const int at = block.offset + i;
      for (const KnotState& knot : forward) {
        track.seconds.push_back(knot.nav.t - start);
        track.forward.push_back(knot.x(at));
        track.forward_sd.push_back(knot.sd(at));
      }
      for (const estimate::SmoothedKnot& knot : smoothed) {
        if (knot.x.size() == 0) continue;
        track.smoothed.push_back(knot.x(at));
        track.smoothed_sd.push_back(knot.sd(at));
      }
      tracks.push_back(std::move(track));
    }
  };
  for (const auto& block : layout.sensors()) add(block);
  for (const auto& block : layout.auxiliaries()) add(block);
  return tracks;
}

std::optional<record::Event> unseen_base_offset(const std::vector<StateTrack>& states) {
  for (const StateTrack& track : states) {
    if (!track.name.starts_with("base_offset") || track.seconds.empty()) continue;
    const double sd = track.smoothed_sd.empty() ? track.forward_sd.back() : track.smoothed_sd.back();
    if (sd < estimate::kWeaklySeenRatio * track.forward_sd.front()) return {};
    return record::Event{record::Event::Severity::kInfo, "base_offset_not_seen",
                         "An offset of all GNSS positions is not observable: nothing else refers to the Earth. It moves "
                         "the whole trajectory and changes no innovation; the sigmas of positions count it as it was stated. "
                         "Only a second base, or a point or a `start` known from elsewhere, can show it.",
                         std::nullopt, 1};
  }
  return {};
}

void SeparationRecorder::add(const estimate::FilterState& backward) {
  constexpr double kSame = 1e-4;  // s
  while (left_ > 0 && forward_[left_ - 1].nav.t - backward.nav.t > kSame) --left_;
  if (left_ == 0 || backward.nav.t - forward_[left_ - 1].nav.t > kSame) return;
  const KnotState& f = forward_[left_ - 1];
  const KnotState b = knot_state(backward);
  const study::ErrorSample d = study::error_of({f.nav, f.cov}, b.nav);
  const study::ErrorSample sd_b = study::error_of({b.nav, b.cov}, b.nav);
  separations_.push_back({f.nav.t, d.position_n, d.attitude,
                          (d.sd_position.cwiseAbs2() + sd_b.sd_position.cwiseAbs2()).cwiseSqrt(),
                          (d.sd_attitude.cwiseAbs2() + sd_b.sd_attitude.cwiseAbs2()).cwiseSqrt()});
}

std::vector<Separation> SeparationRecorder::in_order() && {
  std::ranges::reverse(separations_);
  return std::move(separations_);
}

}  // namespace coast::jobs
