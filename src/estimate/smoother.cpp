#include "coast/estimate/smoother.hpp"

#include <tbb/parallel_pipeline.h>

#include <algorithm>
#include <cmath>

#include "coast/geo/rotation.hpp"
#include "coast/record/error.hpp"
#include "propagation.hpp"

namespace coast::estimate {

namespace {

class BackwardRecursion {
 public:
  explicit BackwardRecursion(const StateLayout& layout)
      : layout_(layout),
        blocks_(layout),
        r_(Eigen::VectorXd::Zero(layout.size())),
        N_(Eigen::MatrixXd::Zero(layout.size(), layout.size())) {}

  void through_transition(const Knot& knot) {
    const auto rest = layout_.size() - kNav;
    const auto ns = knot.Phi_n.cols();
    // Phi = [Phi_n; 0 D]: navigation rows dense, the others by their blocks.
    Eigen::MatrixXd r_rest = r_.tail(rest);
    blocks_.over(knot.interval).apply_transposed(r_rest);
    const Eigen::VectorXd through_nav = knot.Phi_n.transpose() * r_.head<kNav>();
    r_.setZero();
    r_.tail(rest) = r_rest;
    r_.head(ns) += through_nav;

    times_phi(knot);  // N Phi
    N_.transposeInPlace();
    times_phi(knot);  // Phi' N Phi, N symmetric
    N_ = 0.5 * (N_ + N_.transpose()).eval();
  }

  void through_update(const AppliedUpdate& u) {
    const Eigen::VectorXd gained = u.K.transpose() * r_;
    r_.noalias() += u.H.transpose() * (u.S_inv * u.y - gained);
    // (I - K H)' N (I - K H) + H' S^-1 H, one factor after the other: where a fix ends a long outage I - K H is small, and
    // multiplied out the product would be the difference of terms 1e8 times as large.
    const Eigen::MatrixXd NK = N_ * u.K;
    N_.noalias() -= NK * u.H;
    const Eigen::MatrixXd KtN = u.K.transpose() * N_;
    N_.noalias() -= u.H.transpose() * KtN;
    N_ = 0.5 * (N_ + N_.transpose()).eval();
    N_.noalias() += u.H.transpose() * (u.S_inv * u.H);
  }

  void through_slot_changes(const Eigen::VectorXd& factors) {
    const auto slots = factors.size();
    r_.tail(slots).array() *= factors.array();
    N_.bottomRows(slots).array().colwise() *= factors.array();
    N_.rightCols(slots).array().rowwise() *= factors.transpose().array();
  }

  [[nodiscard]] SmoothedKnot smoothed(const Knot& knot, bool with_states) const {
    SmoothedKnot s;
    s.nav = knot.post.nav;
    Eigen::VectorXd x = knot.post.x;
    const Eigen::MatrixXd& P = knot.P_post;
    remove_error(P * r_, s.nav, x);
    if (with_states) {
      const Eigen::MatrixXd PN = P * N_;
      s.x = x;
      s.sd = (P.diagonal() - PN.cwiseProduct(P).rowwise().sum()).cwiseMax(0.0).cwiseSqrt();
      s.cov = covariance_of(PN.topRows<kNav>(), knot);
    } else {
      s.cov = covariance_of(P.topRows<kNav>() * N_, knot);
    }
    return s;
  }

 private:
  [[nodiscard]] record::NavCovariance covariance_of(const NavRows& PN, const Knot& knot) const {
    const Eigen::MatrixXd& P = knot.P_post;
    const Eigen::Matrix<double, kNav, kNav> nav = P.topLeftCorner<kNav, kNav>() - PN * P.leftCols<kNav>();
    return nav_covariance_n(nav, knot.post.nav.r_eb_e);
  }
  void times_phi(const Knot& knot) {
    const auto rest = layout_.size() - kNav;
    Eigen::MatrixXd right = N_.rightCols(rest).transpose();
    blocks_.apply_transposed(right);
    const Eigen::MatrixXd nav = N_.leftCols<kNav>() * knot.Phi_n;
    N_.leftCols<kNav>().setZero();
    N_.rightCols(rest) = right.transpose();
    N_.leftCols(knot.Phi_n.cols()) += nav;
  }

  const StateLayout& layout_;
  BlockTransitions blocks_;
  Eigen::VectorXd r_;
  Eigen::MatrixXd N_;
};

}  // namespace

std::vector<SmoothedKnot> smooth(const KnotStore& knots, const StateLayout& layout, const std::function<void(double)>& progress,
                                 const KnotSampling& states) {
  std::vector<SmoothedKnot> smoothed(knots.size());
  BackwardRecursion backward(layout);
  for (std::size_t i = knots.size(); i-- > 0;) {
    const Knot knot = knots.at(i);
    if (i + 1 < knots.size()) backward.through_transition(knot);
    const std::optional<geo::GpsTime> previous = i > 0 ? std::optional(knots.time(i - 1)) : std::nullopt;
    smoothed[i] = backward.smoothed(knot, states.takes(previous, knots.time(i)));
    if (!smoothed[i].nav.r_eb_e.allFinite())
      throw NumericalError("smoothed state is not finite", geo::to_string(knot.post.nav.t), "the forward filter has diverged");
    for (auto update = knot.updates.rbegin(); update != knot.updates.rend(); ++update) backward.through_update(*update);
    backward.through_slot_changes(knot.slot_factors);
    if (progress && i % 256 == 0) progress(1.0 - static_cast<double>(i) / static_cast<double>(knots.size()));
  }
  return smoothed;
}

namespace {

using NavError = Eigen::Matrix<double, kNav, 1>;

// Smoothed error of the nominal trajectory at a fraction of the interval. Position and velocity: d(dr)/dt = dv holds to the
// Coriolis terms, so the cubic Hermite polynomial through (dr, dv) at both ends is the natural interpolant.
NavError interpolate(const NavError& d0, const NavError& d1, double fraction, double interval) {
  const double s = fraction;
  const double s2 = s * s;
  const double s3 = s2 * s;
  NavError d = (1.0 - s) * d0 + s * d1;
  d.segment<3>(kPos) = (1.0 - 3.0 * s2 + 2.0 * s3) * d0.segment<3>(kPos) + (3.0 * s2 - 2.0 * s3) * d1.segment<3>(kPos) +
                       interval * ((s - 2.0 * s2 + s3) * d0.segment<3>(kVel) + (s3 - s2) * d1.segment<3>(kVel));
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

// Intervals are independent, so they are computed in chunks on all threads and delivered in order. Chunks are cut by count, not
// by threads: the result has the same bytes for any number of them.
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
    const NavError d0 = error_between(knot.post.nav, smoothed[i].nav);
    const NavError d1 = error_between(at_end, smoothed[i + 1].nav);
    for (const record::NavState& nav : nominal) {
      const double s = std::clamp((nav.t - knot.post.nav.t) / knot.interval, 0.0, 1.0);
      chunk.epochs.push_back(
          {without_error(nav, interpolate(d0, d1, s, knot.interval)), interpolate(smoothed[i].cov, smoothed[i + 1].cov, s)});
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
  tbb::parallel_pipeline(kChunksInFlight, tbb::make_filter<void, Chunk>(filter_mode::serial_in_order, read) &
                                              tbb::make_filter<Chunk, Chunk>(filter_mode::parallel, work) &
                                              tbb::make_filter<Chunk, void>(filter_mode::serial_in_order, deliver));
}

}  // namespace coast::estimate
