#include "state_tracks.hpp"

#include <cmath>

#include "coast/study/comparison.hpp"

namespace coast::cli {

KnotState knot_state(const estimate::FilterState& state) {
  return {state.nav, estimate::nav_covariance_n(state.P.topLeftCorner<estimate::kNav, estimate::kNav>(), state.nav.r_eb_e),
          state.x, state.P.diagonal().cwiseSqrt()};
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
      for (std::size_t k = 0; k < forward.size(); ++k) {
        track.seconds.push_back(forward[k].nav.t - start);
        track.forward.push_back(forward[k].x(at));
        track.forward_sd.push_back(forward[k].sd(at));
        if (k >= smoothed.size()) continue;
        track.smoothed.push_back(smoothed[k].x(at));
        track.smoothed_sd.push_back(smoothed[k].sd(at));
      }
      tracks.push_back(std::move(track));
    }
  };
  for (const auto& block : layout.sensors()) add(block);
  for (const auto& block : layout.auxiliaries()) add(block);
  return tracks;
}

std::vector<Separation> separations(const std::vector<KnotState>& forward, const std::vector<KnotState>& backward) {
  constexpr double kSame = 1e-4;  // s
  std::vector<Separation> result;
  std::size_t j = 0;
  for (const KnotState& f : forward) {
    while (j < backward.size() && backward[j].nav.t - f.nav.t < -kSame) ++j;
    if (j == backward.size()) break;
    const KnotState& b = backward[j];
    if (b.nav.t - f.nav.t > kSame) continue;
    const study::ErrorSample d = study::error_of({f.nav, f.cov}, b.nav);
    const study::ErrorSample sd_b = study::error_of({b.nav, b.cov}, b.nav);
    result.push_back({f.nav.t, d.position_n, d.attitude, (d.sd_position.cwiseAbs2() + sd_b.sd_position.cwiseAbs2()).cwiseSqrt(),
                      (d.sd_attitude.cwiseAbs2() + sd_b.sd_attitude.cwiseAbs2()).cwiseSqrt()});
  }
  return result;
}

}  // namespace coast::cli
