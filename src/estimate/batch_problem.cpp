#include "batch_problem.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "coast/geo/earth.hpp"
#include "coast/record/error.hpp"
#include "measurement.hpp"
#include "propagation.hpp"

namespace coast::estimate {

namespace {

constexpr double kLeastPrior = 1e-8;  ///< of a state that is known at the start, in driving noise of a second

Eigen::MatrixXd columns(const Eigen::MatrixXd& M, const std::vector<int>& which) {
  return M(Eigen::all, which);
}

bool is_gnss(UpdateKind kind) {
  return kind == UpdateKind::kGnssPosition || kind == UpdateKind::kGnssVelocity;
}

}  // namespace

BatchProblem::BatchProblem(const Mission& mission, const StateLayout& layout, const FilterOptions& options,
                           const FilterState& start, const KnotStore& knots, const std::vector<KnotMeasurement>& measurements,
                           const RobustLoss& loss)
    : mission_(mission),
      layout_(layout),
      options_(options),
      start_(start),
      knots_(knots),
      measurements_(measurements),
      loss_(loss),
      unknowns_(layout, start.P),
      blocks_(layout),
      normal_(static_cast<Eigen::Index>(knots.size()), static_cast<Eigen::Index>(unknowns_.at_knots().size()),
              static_cast<Eigen::Index>(unknowns_.unknown_once().size())),
      right_(normal_.unknowns()),
      weights_(measurements.size(), 0.0) {}

Eigen::MatrixXd BatchProblem::moved(std::size_t knot) const {
  return unknowns_.moved(knots_.time(knot) - knots_.time(0));
}

BatchStates BatchProblem::filtered() const {
  BatchStates states;
  for (std::size_t i = 0; i < knots_.size(); ++i) {
    const Knot knot = knots_.nominal_at(i);
    states.nav.push_back(knot.post.nav);
    states.x.push_back(knot.post.x);
  }
  const Eigen::VectorXd at_end = states.x.back()(unknowns_.once());
  const Eigen::VectorXd at_start = moved(knots_.size() - 1).colPivHouseholderQr().solve(at_end);
  for (std::size_t i = 0; i < knots_.size(); ++i) states.x[i](unknowns_.once()) = moved(i) * at_start;
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
  const Eigen::MatrixXd own = columns(J, unknowns_.at_knots());
  const Eigen::MatrixXd shared = columns(J, unknowns_.once()) * moved(knot);
  normal_.add_link(link, own.transpose() * own);
  normal_.add_border(link, shared.transpose() * own);
  normal_.add_corner(shared.transpose() * shared);
  right_.segment(normal_.first_of(link), own.cols()) += own.transpose() * target;
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
  const FilterState state{states.nav[knot], states.x[knot], Eigen::MatrixXd::Zero(layout_.size(), layout_.size())};
  const Eigen::Matrix3d C_n_e = geo::C_n_e(geo::geodetic_from_ecef(state.nav.r_eb_e));
  const UpdateContext context = update_context(mission_, layout_, cursor, navigator, C_n_e);
  for (; next_measurement_ < measurements_.size() && measurements_[next_measurement_].knot == knot; ++next_measurement_) {
    const KnotMeasurement& m = measurements_[next_measurement_];
    if (!is_in(m)) continue;
    const std::optional<Linearised> z = estimate::linearise(m.what, mission_, options_, state, context);
    if (!z) continue;
    const Eigen::LLT<ComponentCov> R(z->R);
    const Components nu = R.matrixL().solve(z->nu);
    const auto dof = static_cast<double>(nu.size());
    const double u2 = nu.squaredNorm() / dof;
    const double weight = is_gnss(m.what.kind) ? loss_.weight(u2) : 1.0;
    weights_[next_measurement_] = weight;
    add_equations(knot, std::sqrt(weight) * R.matrixL().solve(z->H), -std::sqrt(weight) * nu);
    if (is_gnss(m.what.kind)) cost_ += dof * (loss_.value(u2) - weight * u2);  // in place of the weighted square
  }
}

// estimate at the next knot = propagated + e, so  d_next = Phi d + e + w
void BatchProblem::add_transition(std::size_t knot, const BatchStates& states, const Propagation& arrived,
                                  const Eigen::MatrixXd& Q) {
  const std::vector<int>& at_knots = unknowns_.at_knots();
  Eigen::VectorXd e(layout_.size());
  e << error_between(states.nav[knot + 1], arrived.navigator().nav()),
      (states.x[knot + 1] - arrived.navigator().x()).tail(layout_.size() - kNav);
  const Eigen::LLT<Eigen::MatrixXd> llt(Q(at_knots, at_knots));
  if (llt.info() != Eigen::Success)
    throw NumericalError("driving noise between knots is not positive definite", geo::to_string(states.nav[knot].t),
                         "the batch smoother needs white noise on every axis of the error model");
  const Eigen::MatrixXd Phi = full_transition(arrived)(at_knots, Eigen::all);
  const auto size = static_cast<Eigen::Index>(at_knots.size());
  const Eigen::MatrixXd next = llt.matrixL().solve(Eigen::MatrixXd::Identity(size, size));
  const Eigen::MatrixXd own = -next * columns(Phi, at_knots);
  const Eigen::MatrixXd shared = -next * columns(Phi, unknowns_.once()) * moved(knot);
  const Eigen::VectorXd target = next * e(at_knots);

  const auto link = static_cast<Eigen::Index>(knot);
  normal_.add_link(link, own.transpose() * own);
  normal_.add_next(link, next.transpose() * own);
  normal_.add_link(link + 1, next.transpose() * next);
  normal_.add_border(link, shared.transpose() * own);
  normal_.add_border(link + 1, shared.transpose() * next);
  normal_.add_corner(shared.transpose() * shared);
  right_.segment(normal_.first_of(link), size) += own.transpose() * target;
  right_.segment(normal_.first_of(link + 1), size) += next.transpose() * target;
  right_.tail(shared.cols()) += shared.transpose() * target;
  cost_ += target.squaredNorm();
}

Eigen::MatrixXd BatchProblem::full_transition(const Propagation& arrived) {
  Eigen::MatrixXd Phi = Eigen::MatrixXd::Identity(layout_.size(), layout_.size());
  const Eigen::Index rest = layout_.size() - kNav;
  blocks_.over(arrived.elapsed()).apply(Phi.bottomRightCorner(rest, rest));
  Phi.topLeftCorner(kNav, arrived.Phi_n().cols()) = arrived.Phi_n();
  return Phi;
}

void BatchProblem::remove(const Eigen::VectorXd& d, BatchStates& states) const {
  const Eigen::VectorXd shared = d.tail(static_cast<Eigen::Index>(unknowns_.unknown_once().size()));
  Eigen::VectorXd all(layout_.size());
  for (std::size_t i = 0; i < states.nav.size(); ++i) {
    all(unknowns_.at_knots()) =
        d.segment(normal_.first_of(static_cast<Eigen::Index>(i)), static_cast<Eigen::Index>(unknowns_.at_knots().size()));
    all(unknowns_.once()) = moved(i) * shared;
    remove_error(all, states.nav[i], states.x[i]);
  }
}

std::vector<Eigen::Index> BatchProblem::rows_of(std::size_t knot) const {
  std::vector<Eigen::Index> rows;
  const Eigen::Index first = normal_.first_of(static_cast<Eigen::Index>(knot));
  for (std::size_t i = 0; i < unknowns_.at_knots().size(); ++i) rows.push_back(first + static_cast<Eigen::Index>(i));
  for (Eigen::Index i = normal_.first_of_border(); i < normal_.unknowns(); ++i) rows.push_back(i);
  return rows;
}

Eigen::MatrixXd BatchProblem::covariance_at(std::size_t knot, const Eigen::MatrixXd& of_unknowns) const {
  const auto own = static_cast<Eigen::Index>(unknowns_.at_knots().size());
  const auto shared = static_cast<Eigen::Index>(unknowns_.unknown_once().size());
  Eigen::MatrixXd S = Eigen::MatrixXd::Zero(layout_.size(), own + shared);
  for (Eigen::Index i = 0; i < own; ++i) S(unknowns_.at_knots()[static_cast<std::size_t>(i)], i) = 1.0;
  S(unknowns_.once(), Eigen::seqN(own, shared)) = moved(knot);
  return S * of_unknowns * S.transpose();
}

}  // namespace coast::estimate
