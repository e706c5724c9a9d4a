#include "coast/estimate/smoother.hpp"

#include <algorithm>
#include <cmath>

#include "backward_recursion.hpp"
#include "coast/geo/rotation.hpp"
#include "coast/parallel.hpp"
#include "coast/record/error.hpp"
#include "propagation.hpp"

namespace coast::estimate {

std::vector<SmoothedKnot> smooth(const KnotStore& knots, const StateLayout& layout, const std::function<void(double)>& progress,
                                 const KnotSampling& states, const Future* behind) {
  std::vector<SmoothedKnot> smoothed(knots.size());
  BackwardRecursion backward(layout);
  for (std::size_t i = knots.size(); i-- > 0;) {
    const Knot knot = knots.at(i);
    if (i + 1 < knots.size())
      backward.through_transition(knot);
    else if (behind != nullptr)
      backward.begin(knot, *behind);
    const std::optional<geo::GpsTime> previous = i > 0 ? std::optional(knots.time(i - 1)) : std::nullopt;
    smoothed[i] = backward.smoothed(knot, states.takes(previous, knots.time(i)));
    if (!smoothed[i].nav.r_eb_e.allFinite())
      throw NumericalError("smoothed state is not finite", geo::to_string(knot.post.nav.t), "the forward filter has diverged");
    backward.through_updates(knot);
    if (progress && i % 256 == 0) progress(1.0 - static_cast<double>(i) / static_cast<double>(knots.size()));
  }
  return smoothed;
}

SmoothedKnot smooth_first(const KnotStore& knots, const StateLayout& layout) {
  BackwardRecursion backward(layout, BackwardRecursion::Carries::kVector);
  Knot knot;
  for (std::size_t i = knots.size(); i-- > 0;) {
    knot = knots.at(i);
    if (i + 1 < knots.size()) backward.through_transition(knot);
    if (i > 0) backward.through_updates(knot);
  }
  SmoothedKnot first = backward.smoothed_state(knot);
  if (!first.nav.r_eb_e.allFinite())
    throw NumericalError("smoothed state is not finite", geo::to_string(knot.post.nav.t), "the forward filter has diverged");
  return first;
}

std::vector<Future> futures(const KnotStore& knots, const StateLayout& layout, std::span<const std::size_t> at) {
  std::vector<Future> result(at.size());
  BackwardRecursion backward(layout);
  std::size_t left = at.size();
  for (std::size_t i = knots.size(); i-- > 0 && left > 0;) {
    const Knot knot = knots.at(i);
    if (i + 1 < knots.size()) backward.through_transition(knot);
    for (; left > 0 && at[left - 1] == i; --left) result[left - 1] = backward.future(knot);
    backward.through_updates(knot);
  }
  return result;
}

namespace {

using NavError = Eigen::Matrix<double, kNav, 1>;

// Smoothed error of the nominal trajectory at a fraction of the interval. Position and velocity: d(dr)/dt = dv holds except
// for Coriolis terms, so the cubic Hermite polynomial through (dr, dv) at both ends is the natural interpolant.
NavError interpolate(const NavError& d0, const NavError& d1, double fraction, double interval) {
  const double s = fraction;
  const double s2 = s * s;
  const double s3 = s2 * s;
  NavError d = (1.0 - s) * d0 + s * d1;
  d.segment<3>(kPos) = (1.0 - 3.0 * s2 + 2.0 * s3) * d0.segment<3>(kPos) + (3.0 * s2 - 2.0 * s3) * d1.segment<3>(kPos) +
                       interval * ((s - 2.0 * s2 + s3) * d0.segment<3>(kVel) + (s3 - s2) * d1.segment<3>(kVel));
  return d;
}

// The same error an interval later.
NavError kept(NavError d, double interval) {
  d.segment<3>(kPos) += interval * d.segment<3>(kVel);
  return d;
}

record::NavCovariance interpolate(const record::NavCovariance& a, const record::NavCovariance& b, double s) {
  return {(1.0 - s) * a.position + s * b.position, (1.0 - s) * a.velocity + s * b.velocity,
          (1.0 - s) * a.attitude + s * b.attitude};
}

record::NavState without_error(const record::NavState& nominal, const NavError& d) {
  record::NavState nav = nominal;
  nav.r_eb_e -= d.segment<3>(kPos);
  nav.v_eb_e -= d.segment<3>(kVel);
  nav.q_b_e = (geo::quaternion_from_rotation_vector(-d.segment<3>(kPsi)) * nominal.q_b_e).normalized();
  return nav;
}

// Intervals are independent, so they are computed in chunks on all threads and delivered in order. Chunk sizes do not depend on
// the number of threads: neither do the bytes of the result.
struct Chunk {
  std::size_t first = 0;
  std::vector<Knot> knots;
  std::vector<record::TrajectoryEpoch> epochs;
};
constexpr std::size_t kKnotsPerChunk = 64;
constexpr std::size_t kChunksInFlight = 8;

void compute(Chunk& chunk, const Mission& mission, const StateLayout& layout, const KnotStore& store,
             const std::vector<SmoothedKnot>& smoothed) {
  Navigator navigator(layout, mission.increments, mission.earth_rate);
  std::vector<record::NavState> nominal;
  for (std::size_t k = 0; k < chunk.knots.size(); ++k) {
    const Knot& knot = chunk.knots[k];
    const std::size_t i = chunk.first + k;
    nominal.clear();
    const record::NavState at_end = repeat_nominal(mission, knot, store.time(i + 1), navigator, nominal);
    const bool jumps = smoothed[i + 1].jumps;
    const NavError d0 = error_between(knot.post.nav, smoothed[i].nav);
    const NavError d1 = jumps ? kept(d0, knot.interval) : error_between(at_end, smoothed[i + 1].nav);
    const record::NavCovariance& cov1 = jumps ? smoothed[i].cov : smoothed[i + 1].cov;
    for (const record::NavState& nav : nominal) {
      const double s = std::clamp((nav.t - knot.post.nav.t) / knot.interval, 0.0, 1.0);
      chunk.epochs.push_back(
          {without_error(nav, interpolate(d0, d1, s, knot.interval)), interpolate(smoothed[i].cov, cov1, s)});
    }
  }
}

}  // namespace

void emit_smoothed(const Mission& mission, const StateLayout& layout, const KnotStore& knots,
                   const std::vector<SmoothedKnot>& smoothed, const record::EpochSink& sink,
                   const std::function<void(double)>& progress) {
  if (smoothed.empty()) return;
  sink({smoothed.front().nav, smoothed.front().cov});
  const std::size_t intervals = knots.size() - 1;
  std::size_t next = 0;
  const auto read = [&](tbb::flow_control& control) {
    Chunk chunk;
    chunk.first = next;
    if (next >= intervals) control.stop();
    for (; next < std::min(chunk.first + kKnotsPerChunk, intervals); ++next) chunk.knots.push_back(knots.nominal_at(next));
    return chunk;
  };
  const auto work = [&](Chunk chunk) {
    compute(chunk, mission, layout, knots, smoothed);
    return chunk;
  };
  const auto deliver = [&](const Chunk& chunk) {
    for (const record::TrajectoryEpoch& epoch : chunk.epochs) sink(epoch);
    if (progress) progress(static_cast<double>(chunk.first + chunk.knots.size()) / static_cast<double>(intervals));
  };
  using tbb::filter_mode;
  coast::parallel_pipeline(kChunksInFlight, tbb::make_filter<void, Chunk>(filter_mode::serial_in_order, read) &
                                                tbb::make_filter<Chunk, Chunk>(filter_mode::parallel, work) &
                                                tbb::make_filter<Chunk, void>(filter_mode::serial_in_order, deliver));
}

}  // namespace coast::estimate
