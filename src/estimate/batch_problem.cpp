#include "batch_problem.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <numeric>

#include "coast/geo/earth.hpp"
#include "coast/record/error.hpp"
#include "measurement.hpp"
#include "propagation.hpp"

namespace coast::estimate {

namespace {

constexpr double kLeastPrior = 1e-8;  ///< of a state known at the start, as driving noise over this time, s

bool is_gnss(UpdateKind kind) {
  return kind == UpdateKind::kGnssPosition || kind == UpdateKind::kGnssVelocity;
}

std::int64_t installed_memory() {
  return static_cast<std::int64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::int64_t>(sysconf(_SC_PAGESIZE));
}

ChainMatrix matrix_within(const std::optional<std::int64_t>& most_bytes, const KnotStore& knots,
                          const BatchUnknowns& unknowns) {
  constexpr double kShare = 0.8;  // of the installed memory: recordings and curves need some, too
  const auto links = static_cast<Eigen::Index>(knots.size());
  const auto size = static_cast<Eigen::Index>(unknowns.at_knots().size());
  const auto border = static_cast<Eigen::Index>(unknowns.unknown_once().size());
  const auto needed = static_cast<double>(2 * ChainMatrix::bytes(links, size, border));  // the factor is as large
  const double most = most_bytes ? static_cast<double>(*most_bytes) : kShare * static_cast<double>(installed_memory());
  constexpr double kGiB = 1073741824.0;
  if (needed > most || 0.5 * needed > 12.0 * std::numeric_limits<int>::max())
    throw NumericalError(
        "the batch is too large", geo::to_string(knots.time(0)),
        fmt::format("{} knots of {} unknowns, and {} of the mission, are normal equations and a factor of {:.1f} GiB, at most "
                    "{:.1f} GiB are allowed: take `smoother: rts`, which needs the memory of its knots alone, or fewer knots "
                    "(filter.knot_interval_s, or fixes at a lower rate)",
                    links, size, border, needed / kGiB, std::min(most, 24.0 * std::numeric_limits<int>::max()) / kGiB));
  return {links, size, border};
}

}  // namespace

BatchProblem::BatchProblem(const Mission& mission, const StateLayout& layout, const FilterOptions& options,
                           const FilterState& start, const KnotStore& knots, const std::vector<KnotMeasurement>& measurements,
                           const BatchOptions& batch)
    : mission_(mission),
      layout_(layout),
      options_(options),
      start_(start),
      knots_(knots),
      measurements_(measurements),
      loss_(batch.gnss),
      unknowns_(layout, start),
      blocks_(layout),
      normal_(matrix_within(batch.most_bytes, knots, unknowns_)),
      right_(normal_.unknowns()),
      weights_(measurements.size(), 0.0) {
  at_knot_.P = Eigen::MatrixXd::Zero(layout.size(), layout.size());
}

BatchStates BatchProblem::filtered() {
  BatchStates states;
  for (std::size_t i = 0; i < knots_.size(); ++i) {
    const Knot knot = knots_.nominal_at(i);
    states.nav.push_back(knot.post.nav);
    states.x.push_back(knot.post.x);
  }
  const std::size_t last = knots_.size() - 1;
  Eigen::VectorXd at_start = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(unknowns_.unknown_once().size()));
  const auto moved = [&](std::size_t knot) { return of_mission(knot)(unknowns_.once(), Eigen::all).eval(); };
  if (at_start.size() > 0)
    at_start = moved(last).colPivHouseholderQr().solve(states.x[last](unknowns_.once()) - unknowns_.prior_mean(elapsed(last)));
  for (std::size_t i = 0; i < knots_.size(); ++i)
    states.x[i](unknowns_.once()) = unknowns_.prior_mean(elapsed(i)) + moved(i) * at_start;
  return states;
}

double BatchProblem::linearise(const BatchStates& states) {
  normal_.set_zero();
  right_.setZero();
  cost_ = 0.0;
  next_measurement_ = 0;
  add_prior(states);
  Propagation propagation(mission_, layout_);
  const Knot first = knots_.nominal_at(0);
  SampleCursor cursor{first.next_sample, first.remainder};
  propagation.set({states.nav[0], states.x[0], first.post.previous});
  Eigen::MatrixXd Q(layout_.size(), layout_.size());
  for (std::size_t i = 0;; ++i) {
    if (i > 0) propagation.correct(states.nav[i], states.x[i]);
    add_measurements(i, states, cursor, propagation.navigator());
    if (i + 1 == knots_.size()) return cost_;
    walk(mission_.imu, cursor, knots_.time(i + 1), propagation.navigator(),
         [&](const SampleStep& step) { propagation.step(step); });
    Q.setZero();
    propagation.close(Q);
    add_transition(i, states, propagation, Q);
  }
}

void BatchProblem::add_equations(std::size_t knot, const Eigen::MatrixXd& J, const Eigen::VectorXd& target) {
  const auto link = static_cast<Eigen::Index>(knot);
  const Eigen::MatrixXd own = J(Eigen::all, unknowns_.at_knots());
  const Eigen::MatrixXd shared = J * of_mission(knot);
  normal_.add_link(link, own.transpose() * own);
  normal_.add_border(link, shared.transpose() * own);
  normal_.add_corner(shared.transpose() * shared);
  right_.segment(first_of(knot), own.cols()) += own.transpose() * target;
  right_.tail(shared.cols()) += shared.transpose() * target;
  cost_ += target.squaredNorm();
}

// d = (estimate - prior mean) + (error of the prior mean)
void BatchProblem::add_prior(const BatchStates& states) {
  Eigen::VectorXd e(layout_.size());
  e << error_between(states.nav[0], start_.nav), (states.x[0] - start_.x).tail(layout_.size() - kNav);
  Eigen::MatrixXd P = start_.P;
  blocks_.over(1.0);
  layout_.for_each_block([&](const StateLayout::Block& block) {
    for (int a = 0; a < block.size; ++a)
      if (P(block.offset + a, block.offset + a) == 0.0)
        P(block.offset + a, block.offset + a) = kLeastPrior * blocks_.driving_noise(block)(a, a);
  });
  std::vector<int> unknown = unknowns_.at_knots();
  unknown.insert(unknown.end(), unknowns_.unknown_once().begin(), unknowns_.unknown_once().end());
  const Eigen::LLT<Eigen::MatrixXd> llt(P(unknown, unknown));
  if (llt.info() != Eigen::Success)
    throw NumericalError("covariance of the start is not positive definite", geo::to_string(start_.nav.t),
                         "a state of the error model starts from a value that is known exactly: give it a small sigma");
  const auto size = static_cast<Eigen::Index>(unknown.size());
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(size, layout_.size());
  const Eigen::MatrixXd whitened = llt.matrixL().solve(Eigen::MatrixXd::Identity(size, size));
  J(Eigen::all, unknown) = whitened;
  add_equations(0, J, whitened * e(unknown));
}

bool BatchProblem::is_in(const KnotMeasurement& m) const {
  return m.used || (loss_.kind != RobustLoss::Kind::kSquared && is_gnss(m.what.kind));
}

// nu = -H d + noise
void BatchProblem::add_measurements(std::size_t knot, const BatchStates& states, const SampleCursor& cursor,
                                    const Navigator& navigator) {
  if (next_measurement_ >= measurements_.size() || measurements_[next_measurement_].knot != knot) return;
  at_knot_.nav = states.nav[knot];
  at_knot_.x = states.x[knot];
  const Eigen::Matrix3d C_n_e = geo::C_n_e(geo::geodetic_from_ecef(at_knot_.nav.r_eb_e));
  const UpdateContext context = update_context(mission_, layout_, cursor, navigator, C_n_e);
  for (; next_measurement_ < measurements_.size() && measurements_[next_measurement_].knot == knot; ++next_measurement_) {
    const KnotMeasurement& m = measurements_[next_measurement_];
    if (!is_in(m)) continue;
    const std::optional<Linearised> z = estimate::linearise(m.what, mission_, options_, at_knot_, context);
    if (!z) continue;
    const Eigen::LLT<ComponentCov> R(z->R);
    const Components nu = R.matrixL().solve(z->nu);
    const auto dof = static_cast<double>(nu.size());
    const double u2 = nu.squaredNorm() / dof;
    const double weight = is_gnss(m.what.kind) ? loss_.weight(u2) : 1.0;
    weights_[next_measurement_] = weight;
    add_equations(knot, std::sqrt(weight) * R.matrixL().solve(z->H), -std::sqrt(weight) * nu);
    if (is_gnss(m.what.kind)) cost_ += dof * (loss_.value(u2) - weight * u2);  // instead of the weighted square
  }
}

// estimate at the next knot = propagated + e, so  d_next = Phi d + e + w:  equations in d, d_next and the border, whitened.
void BatchProblem::add_transition(std::size_t knot, const BatchStates& states, const Propagation& arrived,
                                  const Eigen::MatrixXd& Q) {
  const std::vector<int>& at_knots = unknowns_.at_knots();
  const auto size = static_cast<Eigen::Index>(at_knots.size());
  const auto shared = static_cast<Eigen::Index>(unknowns_.unknown_once().size());
  const Eigen::LLT<Eigen::MatrixXd> llt(Q(at_knots, at_knots));
  if (llt.info() != Eigen::Success)
    throw NumericalError("driving noise between knots is not positive definite", geo::to_string(states.nav[knot].t),
                         "the batch smoother needs white noise on every axis of the error model");
  const Eigen::MatrixXd& Phi = transition_rows(arrived);
  Eigen::VectorXd e(layout_.size());
  e << error_between(states.nav[knot + 1], arrived.navigator().nav()),
      (states.x[knot + 1] - arrived.navigator().x()).tail(layout_.size() - kNav);
  W_.resize(size, 2 * size + shared + 1);
  W_.leftCols(size) = -Phi(Eigen::all, at_knots);
  W_.middleCols(size, size).setIdentity();
  W_.middleCols(2 * size, shared).noalias() = -Phi * of_mission(knot);
  W_.middleCols(2 * size, shared) += of_mission(knot + 1)(at_knots, Eigen::all);
  W_.rightCols<1>() = e(at_knots);
  llt.matrixL().solveInPlace(W_);
  const auto unknowns = W_.leftCols(2 * size + shared);
  const auto target = W_.rightCols<1>();
  G_.setZero(unknowns.cols(), unknowns.cols());
  G_.selfadjointView<Eigen::Lower>().rankUpdate(unknowns.transpose());
  const Eigen::VectorXd right = unknowns.transpose() * target;

  const auto link = static_cast<Eigen::Index>(knot);
  normal_.add_link(link, G_.topLeftCorner(size, size));
  normal_.add_next(link, G_.block(size, 0, size, size));
  normal_.add_link(link + 1, G_.block(size, size, size, size));
  normal_.add_border(link, G_.bottomLeftCorner(shared, size));
  normal_.add_border(link + 1, G_.block(2 * size, size, shared, size));
  normal_.add_corner(G_.bottomRightCorner(shared, shared));
  right_.segment(first_of(knot), 2 * size) += right.head(2 * size);
  right_.tail(shared) += right.tail(shared);
  cost_ += target.squaredNorm();
}

const Eigen::MatrixXd& BatchProblem::transition_rows(const Propagation& arrived) {
  const Eigen::Index rest = layout_.size() - kNav;
  Eigen::MatrixXd all = Eigen::MatrixXd::Identity(layout_.size(), layout_.size());
  blocks_.over(arrived.elapsed(), arrived.renewed_gnss_error()).apply(all.bottomRightCorner(rest, rest));
  all.topLeftCorner(kNav, arrived.Phi_n().cols()) = arrived.Phi_n();
  Phi_ = all(unknowns_.at_knots(), Eigen::all);
  return Phi_;
}

void BatchProblem::remove(const Eigen::VectorXd& d, BatchStates& states) {
  for (std::size_t i = 0; i < states.nav.size(); ++i) remove_error(errors_at(i, d), states.nav[i], states.x[i]);
}

Eigen::VectorXd BatchProblem::errors_at(std::size_t knot, const Eigen::VectorXd& d) {
  Eigen::VectorXd all = of_mission(knot) * d.tail(static_cast<Eigen::Index>(unknowns_.unknown_once().size()));
  all(unknowns_.at_knots()) += d.segment(first_of(knot), static_cast<Eigen::Index>(unknowns_.at_knots().size()));
  return all;
}

namespace {

/// The covariance of the first states of a knot from that of its unknowns and of the mission's.
Eigen::MatrixXd covariance_of(std::vector<Eigen::Index> rows, Eigen::Index border, const Eigen::MatrixXd& own,
                              const Eigen::MatrixXd& of_mission, const SelectedInverse& inverse) {
  for (Eigen::Index i = 0; i < of_mission.cols(); ++i) rows.push_back(border + i);
  Eigen::MatrixXd S(own.rows(), own.cols() + of_mission.cols());
  S << own, of_mission;
  return S * inverse.block(rows) * S.transpose();
}

}  // namespace

Eigen::MatrixXd BatchProblem::nav_covariance(std::size_t knot, const SelectedInverse& inverse) {
  std::vector<Eigen::Index> rows(kNav);
  std::iota(rows.begin(), rows.end(), first_of(knot));
  const auto of_nav = of_mission(knot).topRows<kNav>();
  if (of_nav.isZero(0.0)) return inverse.block(rows);
  return covariance_of(std::move(rows), normal_.first_of_border(), Eigen::MatrixXd::Identity(kNav, kNav), of_nav, inverse);
}

Eigen::MatrixXd BatchProblem::covariance(std::size_t knot, const SelectedInverse& inverse) {
  std::vector<Eigen::Index> rows(unknowns_.at_knots().size());
  std::iota(rows.begin(), rows.end(), first_of(knot));
  const Eigen::MatrixXd all = Eigen::MatrixXd::Identity(layout_.size(), layout_.size());
  return covariance_of(std::move(rows), normal_.first_of_border(), all(Eigen::all, unknowns_.at_knots()), of_mission(knot),
                       inverse);
}

}  // namespace coast::estimate
