#include "estimate/linear_problem.hpp"

#include <Eigen/Dense>
#include <numeric>

#include "coast/geo/earth.hpp"

namespace coast::test {

using namespace estimate;

namespace {

/// What a knot's updates took out of the error: before them it was larger by K y.
Eigen::VectorXd correction(const Knot& knot, Eigen::Index states) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(states);
  for (const AppliedUpdate& update : knot.updates) sum += update.K * update.y;
  return sum;
}

}  // namespace

LinearProblem::LinearProblem(const Mission& mission, const ForwardFilter& filter, const FilterState& start)
    : layout_(filter.layout()), start_(start) {
  for (int i = 0; i < kNav; ++i) at_knots_.push_back(i);
  BlockTransitions blocks(layout_);
  blocks.over(1.0);
  layout_.for_each_block([&](const StateLayout::Block& block) {
    const bool driven = !blocks.driving_noise(block).isZero(0.0);
    for (int i = block.offset; i < block.offset + block.size; ++i)
      if (driven || start.P(i, i) > 0.0) (driven ? at_knots_ : once_).push_back(i);
  });
  filter_forward(filter);
  add_prior();
  for (Eigen::Index k = 0; k < links(); ++k) {
    add_updates(mission, k);
    if (k + 1 < links()) add_transition(filter, k);
  }
  gather();
}

void LinearProblem::filter_forward(const ForwardFilter& filter) {
  FilterOutputs outputs;
  outputs.knots = &knots_;
  outputs.at_knots = [this](const FilterState& state) { predicted_.push_back(state); };
  outputs.measurements = [this](const Measurement& what, bool used) { measured_.push_back({knots_.size(), what, used}); };
  (void)filter.run(start_, outputs);
}

// The error before the first updates is drawn from P. What is known at the start gets a variance that is nothing.
void LinearProblem::add_prior() {
  constexpr double kNothing = 1e-12;  // of the driving noise of a second
  std::vector<int> unknown = at_knots_;
  unknown.insert(unknown.end(), once_.begin(), once_.end());
  Eigen::MatrixXd P = start_.P;
  BlockTransitions blocks(layout_);
  blocks.over(1.0);
  layout_.for_each_block([&](const StateLayout::Block& block) {
    for (int i = 0; i < block.size; ++i)
      if (P(block.offset + i, block.offset + i) == 0.0)
        P(block.offset + i, block.offset + i) = kNothing * blocks.driving_noise(block)(i, i);
  });
  const Eigen::MatrixXd all = Eigen::MatrixXd::Identity(layout_.size(), layout_.size());
  const Eigen::VectorXd target = -correction(knots_.at(0), layout_.size());
  add(0, all(unknown, Eigen::all), Eigen::MatrixXd(), target(unknown), P(unknown, unknown));
}

// y = H (error before this update) + noise
void LinearProblem::add_updates(const Mission& mission, Eigen::Index k) {
  const Knot knot = knots_.at(static_cast<std::size_t>(k));
  Eigen::VectorXd taken_out = correction(knot, layout_.size());
  const Eigen::Matrix3d C_n_e = geo::C_n_e(geo::geodetic_from_ecef(predicted_[static_cast<std::size_t>(k)].nav.r_eb_e));
  for (const AppliedUpdate& update : knot.updates) {
    const record::GnssFix& fix = mission.gnss.fixes[measured_[next_measured_++].what.index];
    const Eigen::Matrix3d& cov_n = update.kind == UpdateKind::kGnssPosition ? fix.position_cov_n : fix.velocity->cov_n;
    add(k, update.H, Eigen::MatrixXd(), update.y - update.H * taken_out, C_n_e * cov_n * C_n_e.transpose());
    taken_out -= update.K * update.y;
  }
}

// Q is the covariance that the filter arrives with where it starts from none.
void LinearProblem::add_transition(const ForwardFilter& filter, Eigen::Index k) {
  const Knot knot = knots_.at(static_cast<std::size_t>(k));
  Knot known = knot;
  known.P_post.setZero();
  std::vector<FilterState> arrived;
  FilterOutputs outputs;
  outputs.at_knots = [&](const FilterState& state) { arrived.push_back(state); };
  (void)filter.resume(known, knots_.time(static_cast<std::size_t>(k) + 1), outputs);

  const Eigen::Index n = layout_.size();
  Eigen::MatrixXd Phi = moved(Eigen::MatrixXd::Identity(n, n), knot.interval);
  Phi.topRows(kNav).setZero();
  Phi.topLeftCorner(kNav, knot.Phi_n.cols()) = knot.Phi_n;
  if (knot.renews_gnss_error) Phi.middleRows<3>(*layout_.gnss_error()).setZero();
  const Eigen::VectorXd target = -correction(knots_.at(static_cast<std::size_t>(k) + 1), n);
  const Eigen::MatrixXd all = Eigen::MatrixXd::Identity(n, n);
  add(k, -Phi(at_knots_, Eigen::all), all(at_knots_, Eigen::all), target(at_knots_), arrived[0].P(at_knots_, at_knots_));
}

void LinearProblem::add(Eigen::Index knot, const Eigen::MatrixXd& of_knot, const Eigen::MatrixXd& of_next,
                        const Eigen::VectorXd& target, const Eigen::MatrixXd& covariance) {
  const Eigen::LLT<Eigen::MatrixXd> llt(covariance);
  const auto whitened = [&](const Eigen::MatrixXd& M) { return llt.matrixL().solve(M).eval(); };
  Rows rows{knot, whitened(of_knot * map(knot)), {}, target - of_knot * offset(knot)};
  if (of_next.size() > 0) {
    rows.of_next = whitened(of_next * map(knot + 1));
    rows.target -= of_next * offset(knot + 1);
  }
  rows.target = whitened(rows.target);
  rows_.push_back(std::move(rows));
}

void LinearProblem::gather() {
  Eigen::Index count = 0;
  for (const Rows& rows : rows_) count += rows.target.size();
  J_ = Eigen::MatrixXd::Zero(count, links() * size() + border());
  target_.resize(count);
  Eigen::Index at = 0;
  for (const Rows& rows : rows_) {
    const Eigen::Index m = rows.target.size();
    J_(Eigen::seqN(at, m), columns(rows.knot)) += rows.of_knot;
    if (rows.of_next.size() > 0) J_(Eigen::seqN(at, m), columns(rows.knot + 1)) += rows.of_next;
    target_.segment(at, m) = rows.target;
    at += m;
  }
  rows_.clear();
}

Eigen::MatrixXd LinearProblem::map(Eigen::Index knot) const {
  Eigen::MatrixXd starting = Eigen::MatrixXd::Zero(layout_.size(), border());
  for (Eigen::Index i = 0; i < border(); ++i) starting(once_[static_cast<std::size_t>(i)], i) = 1.0;
  Eigen::MatrixXd T(layout_.size(), size() + border());
  T << Eigen::MatrixXd::Zero(layout_.size(), size()), moved(starting, elapsed(knot));
  for (Eigen::Index i = 0; i < size(); ++i) {
    T.row(at_knots_[static_cast<std::size_t>(i)]).setZero();
    T(at_knots_[static_cast<std::size_t>(i)], i) = 1.0;
  }
  return T;
}

std::vector<Eigen::Index> LinearProblem::columns(Eigen::Index knot) const {
  std::vector<Eigen::Index> columns(static_cast<std::size_t>(size() + border()));
  std::iota(columns.begin(), columns.begin() + size(), knot * size());
  std::iota(columns.begin() + size(), columns.end(), links() * size());
  return columns;
}

Eigen::VectorXd LinearProblem::offset(Eigen::Index knot) const {
  Eigen::VectorXd d = knots_.at(static_cast<std::size_t>(knot)).post.x - moved(start_.x, elapsed(knot));
  d(at_knots_).setZero();
  return d;
}

Eigen::MatrixXd LinearProblem::moved(Eigen::MatrixXd of_states, double seconds) const {
  if (seconds > 0.0) BlockTransitions(layout_).over(seconds).apply(of_states.bottomRows(layout_.size() - kNav));
  return of_states;
}

double LinearProblem::elapsed(Eigen::Index knot) const {
  return knots_.time(static_cast<std::size_t>(knot)) - knots_.time(0);
}

}  // namespace coast::test
