#include "backward_recursion.hpp"

#include <Eigen/LU>
#include <cmath>

namespace coast::estimate {

namespace {

record::NavCovariance covariance_of(const NavRows& PN, const Knot& knot) {
  const Eigen::MatrixXd& P = knot.P_post;
  const Eigen::Matrix<double, kNav, kNav> nav = P.topLeftCorner<kNav, kNav>() - PN * P.leftCols<kNav>();
  return nav_covariance_n(nav, knot.post.nav.r_eb_e);
}

/// States in units of their own sigma: metres and radians together would lose digits. A known state has unit scale: any
/// division by it is undone by a multiplication.
Eigen::VectorXd sigmas(const Eigen::MatrixXd& P) {
  return P.diagonal().unaryExpr([](double variance) { return variance > 0.0 ? std::sqrt(variance) : 1.0; });
}

}  // namespace

BackwardRecursion::BackwardRecursion(const StateLayout& layout, Carries carries)
    : layout_(layout),
      carries_(carries),
      blocks_(layout),
      r_(Eigen::VectorXd::Zero(layout.size())),
      N_(Eigen::MatrixXd::Zero(layout.size(), layout.size())) {}

// r = (I + L P)^-1 l,  N = (I + L P)^-1 L, with the future's L and l about this knot's own estimate.
void BackwardRecursion::begin(const Knot& knot, const Future& behind) {
  Eigen::VectorXd moved(layout_.size());
  moved << error_between(knot.post.nav, behind.nav), (knot.post.x - behind.x).tail(layout_.size() - kNav);
  const Eigen::VectorXd s = sigmas(knot.P_post);
  const Eigen::MatrixXd P = s.cwiseInverse().asDiagonal() * knot.P_post * s.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd L = s.asDiagonal() * behind.information * s.asDiagonal();
  const Eigen::VectorXd l = s.cwiseProduct(behind.vector + behind.information * moved);
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(Eigen::MatrixXd::Identity(L.rows(), L.cols()) + L * P);
  r_ = lu.solve(l).cwiseQuotient(s);
  const Eigen::MatrixXd N = lu.solve(L);
  N_ = s.cwiseInverse().asDiagonal() * (0.5 * (N + N.transpose())) * s.cwiseInverse().asDiagonal();
}

// The inverse of begin():  L = (I - N P)^-1 N,  l = (I - N P)^-1 r
Future BackwardRecursion::future(const Knot& knot) const {
  const Eigen::VectorXd s = sigmas(knot.P_post);
  const Eigen::MatrixXd P = s.cwiseInverse().asDiagonal() * knot.P_post * s.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd N = s.asDiagonal() * N_ * s.asDiagonal();
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(Eigen::MatrixXd::Identity(N.rows(), N.cols()) - N * P);
  const Eigen::MatrixXd L = lu.solve(N);
  Future future;
  future.nav = knot.post.nav;
  future.x = knot.post.x;
  future.information = s.cwiseInverse().asDiagonal() * (0.5 * (L + L.transpose())) * s.cwiseInverse().asDiagonal();
  future.vector = lu.solve(s.cwiseProduct(r_)).cwiseQuotient(s);
  return future;
}

void BackwardRecursion::through_transition(const Knot& knot) {
  const auto rest = layout_.size() - kNav;
  const auto ns = knot.Phi_n.cols();
  // Phi = [Phi_n; 0 D]: navigation rows dense, the others by their blocks.
  Eigen::MatrixXd r_rest = r_.tail(rest);
  blocks_.over(knot.interval, knot.renews_gnss_error).apply_transposed(r_rest);
  const Eigen::VectorXd through_nav = knot.Phi_n.transpose() * r_.head<kNav>();
  r_.setZero();
  r_.tail(rest) = r_rest;
  r_.head(ns) += through_nav;
  if (carries_ == Carries::kVector) return;

  times_phi(knot);  // N Phi
  N_.transposeInPlace();
  times_phi(knot);  // Phi' N Phi, N symmetric
  N_ = 0.5 * (N_ + N_.transpose()).eval();
}

void BackwardRecursion::through_update(const AppliedUpdate& u) {
  const Eigen::VectorXd gained = u.K.transpose() * r_;
  r_.noalias() += u.H.transpose() * (u.S_inv * u.y - gained);
  if (carries_ == Carries::kVector) return;
  // (I - K H)' N (I - K H) + H' S^-1 H, one factor after the other: if a fix ends a long outage I - K H is small, and
  // multiplied out the product would be the difference of terms 1e8 times as large.
  const Eigen::MatrixXd NK = N_ * u.K;
  N_.noalias() -= NK * u.H;
  const Eigen::MatrixXd KtN = u.K.transpose() * N_;
  N_.noalias() -= u.H.transpose() * KtN;
  N_ = 0.5 * (N_ + N_.transpose()).eval();
  N_.noalias() += u.H.transpose() * (u.S_inv * u.H);
}

void BackwardRecursion::through_updates(const Knot& knot) {
  for (auto update = knot.updates.rbegin(); update != knot.updates.rend(); ++update) through_update(*update);
  through_slot_changes(knot.slot_factors);
}

void BackwardRecursion::through_slot_changes(const Eigen::VectorXd& factors) {
  const auto slots = factors.size();
  r_.tail(slots).array() *= factors.array();
  if (carries_ == Carries::kVector) return;
  N_.bottomRows(slots).array().colwise() *= factors.array();
  N_.rightCols(slots).array().rowwise() *= factors.transpose().array();
}

SmoothedKnot BackwardRecursion::smoothed_state(const Knot& knot) const {
  SmoothedKnot s;
  s.nav = knot.post.nav;
  s.x = knot.post.x;
  remove_error(knot.P_post * r_, s.nav, s.x);
  return s;
}

SmoothedKnot BackwardRecursion::smoothed(const Knot& knot, bool with_states) const {
  SmoothedKnot s = smoothed_state(knot);
  const Eigen::MatrixXd& P = knot.P_post;
  if (with_states) {
    const Eigen::MatrixXd PN = P * N_;
    s.sd = (P.diagonal() - PN.cwiseProduct(P).rowwise().sum()).cwiseMax(0.0).cwiseSqrt();
    s.cov = covariance_of(PN.topRows<kNav>(), knot);
  } else {
    s.x.resize(0);
    s.cov = covariance_of(P.topRows<kNav>() * N_, knot);
  }
  return s;
}

void BackwardRecursion::times_phi(const Knot& knot) {
  const auto rest = layout_.size() - kNav;
  Eigen::MatrixXd right = N_.rightCols(rest).transpose();
  blocks_.apply_transposed(right);
  const Eigen::MatrixXd nav = N_.leftCols<kNav>() * knot.Phi_n;
  N_.leftCols<kNav>().setZero();
  N_.rightCols(rest) = right.transpose();
  N_.leftCols(knot.Phi_n.cols()) += nav;
}

}  // namespace coast::estimate
