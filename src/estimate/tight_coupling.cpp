#include "tight_coupling.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "antenna.hpp"

namespace coast::estimate {

namespace {

using carrier::Unknown;

constexpr Unknown kFree{};
constexpr Eigen::Index kMoving = 6;  // position and velocity: the first states of a RelativeState

/// Rows of unit variance, three at a time. @return log-likelihood of the innovations
double apply_rows(const Eigen::MatrixXd& H, const Eigen::VectorXd& nu, FilterState& state, Knot& knot) {
  Eigen::VectorXd step = Eigen::VectorXd::Zero(state.P.rows());  // towards the truth, so far
  double log_likelihood = 0.0;
  for (Eigen::Index row = 0; row < nu.size(); row += kMaxComponents) {
    const Eigen::Index m = std::min<Eigen::Index>(kMaxComponents, nu.size() - row);
    Linearised part;
    part.kind = UpdateKind::kCarrierPhase;
    part.H = H.middleRows(row, m);
    part.nu = nu.segment(row, m) - part.H * step;
    part.R = ComponentCov::Identity(m, m);
    const Innovation predicted = innovation(state, part);
    log_likelihood += predicted.log_likelihood;
    AppliedUpdate applied = apply(part, predicted, state);
    step -= applied.K * applied.y;
    knot.updates.push_back(std::move(applied));
  }
  return log_likelihood;
}

}  // namespace

TightCoupling::TightCoupling(const CarrierObservations& observations, const StateLayout& layout, bool time_reversed)
    : layout_(layout),
      coupling_(observations.options, observations.interval_s),
      direction_(time_reversed ? -1.0 : 1.0),
      slots_(static_cast<std::size_t>(layout.size() - layout.carrier_slots()), kFree) {}

void TightCoupling::begin(FilterState& state) {
  const auto slots = static_cast<Eigen::Index>(slots_.size());
  state.x.tail(slots).setZero();
  state.P.bottomRows(slots).setZero();
  state.P.rightCols(slots).setZero();
}

Eigen::Index TightCoupling::slot_of(const Unknown& unknown) const {
  const auto found = std::ranges::find(slots_, unknown);
  if (found == slots_.end()) throw std::logic_error("no carrier slot is left");  // their number was checked before
  return layout_.carrier_slots() + (found - slots_.begin());
}

/// Converts rows over a RelativeState's unknowns to rows over the filter's states.
Eigen::MatrixXd TightCoupling::over_states(const Eigen::MatrixXd& H, const std::vector<Unknown>& unknowns,
                                           const UpdateContext& context, const FilterState& state) const {
  Eigen::MatrixXd over = H.leftCols<3>() * antenna_position(state, context).H +
                         H.middleCols<3>(3) * (direction_ * antenna_velocity(state, context).H);
  for (Eigen::Index j = kMoving; j < H.cols(); ++j) over.col(slot_of(unknowns[static_cast<std::size_t>(j)])) = H.col(j);
  return over;
}

carrier::RelativeState TightCoupling::prior(const UpdateContext& context, const FilterState& state) const {
  std::vector<Unknown> named(carrier::kVelocityUnknowns.begin(), carrier::kVelocityUnknowns.end());
  std::vector<Eigen::Index> at;
  for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
    if (slots_[slot] == kFree) continue;
    named.push_back(slots_[slot]);
    at.push_back(layout_.carrier_slots() + static_cast<Eigen::Index>(slot));
  }
  const AntennaPrediction position = antenna_position(state, context), velocity = antenna_velocity(state, context);
  Eigen::MatrixXd A(kMoving, layout_.size());
  A << position.H, direction_ * velocity.H;
  const auto used = static_cast<Eigen::Index>(at.size());
  Eigen::VectorXd x(kMoving + used);
  x << position.value_e, direction_ * velocity.value_e, state.x(at);
  Eigen::MatrixXd P(kMoving + used, kMoving + used);
  const Eigen::MatrixXd AP = A * state.P;
  P.topLeftCorner(kMoving, kMoving) = AP * A.transpose();
  P.topRightCorner(kMoving, used) = AP(Eigen::all, at);
  P.bottomLeftCorner(used, kMoving) = P.topRightCorner(kMoving, used).transpose();
  P.bottomRightCorner(used, used) = state.P(at, at);
  carrier::RelativeState prior(named, std::move(x), 0.5 * (P + P.transpose()));
  prior.C_b_e = state.nav.q_b_e.toRotationMatrix();
  return prior;
}

void TightCoupling::follow(const std::vector<carrier::StateChange>& changes, FilterState& state, Knot& knot) {
  if (knot.slot_factors.size() == 0) knot.slot_factors = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(slots_.size()));
  for (const carrier::StateChange& change : changes) {
    if (std::ranges::find(slots_, change.unknown) == slots_.end()) {
      const auto free = std::ranges::find(slots_, kFree);
      if (free != slots_.end()) *free = change.unknown;
    }
    const Eigen::Index i = slot_of(change.unknown);
    state.x(i) = change.factor * state.x(i) + change.value;
    state.P.row(i) *= change.factor;
    state.P.col(i) *= change.factor;
    state.P(i, i) += change.added;
    knot.slot_factors(i - layout_.carrier_slots()) *= change.factor;
    if (change.gone) slots_[static_cast<std::size_t>(i - layout_.carrier_slots())] = kFree;
  }
  knot.slots = slots_;
}

TightCoupling::Outcome TightCoupling::update(const carrier::DifferenceEpoch& epoch, const UpdateContext& context,
                                             FilterState& state, Knot& knot) {
  Outcome outcome;
  const carrier::CoupledEpoch coupled = coupling_.step(prior(context, state), epoch);
  if (coupled.shortfall == carrier::Shortfall::kContradiction) {
    outcome.contradicted = true;
    return outcome;
  }
  follow(coupled.changes, state, knot);
  if (!coupled.usable) return outcome;
  const AntennaPrediction before = antenna_position(state, context);
  const Eigen::Matrix3d P_before = before.H * state.P * before.H.transpose();
  const auto take = [&](const Eigen::MatrixXd& H, const Eigen::VectorXd& nu) {
    outcome.log_likelihood += apply_rows(over_states(H, coupled.unknowns, context, state), nu, state, knot);
  };
  take(coupled.H, coupled.nu);
  if (coupled.nu_integers.size() > 0) take(coupled.H_integers, coupled.nu_integers);
  const AntennaPrediction after = antenna_position(state, context);
  const Eigen::Matrix3d gained = P_before - after.H * state.P * after.H.transpose();
  InnovationRecord& r = outcome.innovation.emplace();
  r.t = state.nav.t;
  r.kind = UpdateKind::kCarrierPhase;
  r.dof = static_cast<int>(coupled.nu.size());
  r.nis = coupled.nis;
  r.nu = context.C_n_e.transpose() * (after.value_e - before.value_e);
  r.sd = (context.C_n_e.transpose() * gained * context.C_n_e).diagonal().cwiseMax(0.0).cwiseSqrt();
  r.quality = coupled.fixed ? record::FixQuality::kFixed : record::FixQuality::kFloat;
  return outcome;
}

}  // namespace coast::estimate
