#include "coast/estimate/effect_pass.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>

#include "backward_recursion.hpp"
#include "coast/geo/earth.hpp"
#include "coast/parallel.hpp"
#include "propagation.hpp"

namespace coast::estimate {

namespace {

/// The white noise of each axis of the sensors in an interval.
struct OwnNoise {
  Eigen::Matrix<double, kNav, 6> w = {};  ///< effect of a constant error of the root of its density
  OwnSlopes slopes = {};                  ///< times the noise level
};

/// Densities over those of the error model: gyro x, y, z, accelerometer x, y, z. Behind the last level it goes on.
Eigen::Vector<double, 6> noise_levels(const record::ImuRecording& imu, geo::GpsTime t) {
  Eigen::Vector<double, 6> levels = Eigen::Vector<double, 6>::Ones();
  if (imu.noise.empty()) return levels;
  const auto at = std::ranges::upper_bound(imu.noise, t, {}, &record::NoiseLevel::to);
  const record::NoiseLevel& level = at == imu.noise.end() ? imu.noise.back() : *at;
  levels << level.gyro, level.accel;
  return levels;
}

/// Columns of the transition: effect of a unit of every coefficient on the navigation states within an interval, with the
/// sign of the error of a state: estimate - truth.
class DrivenColumns {
 public:
  DrivenColumns(const Mission& mission, const StateLayout& layout, const Effects& effects)
      : mission_(mission),
        layout_(layout),
        effects_(effects),
        navigator_(layout, mission.increments, mission.earth_rate),
        W_(kNav, effects.size() + 6),
        gyro_b_(3, effects.size()),
        accel_b_(gyro_b_),
        gyro_e_(3, W_.cols()),
        accel_e_(gyro_e_) {}

  /// From a knot to the next one.
  void over(const Knot& knot, geo::GpsTime end) {
    navigator_.set(knot.post);
    W_.setZero();
    slopes_.setZero(6, effects_.size());
    slopes_known_ = false;
    begin_fold();
    SampleCursor cursor{knot.next_sample, knot.remainder};
    walk(mission_.imu, cursor, end, navigator_, [&](const SampleStep& step) { take(step, cursor.next_sample); });
    close_fold();
    if (restart_at(mission_, end) != nullptr) W_.middleRows<3>(kPsi).setZero();
  }
  [[nodiscard]] NavRows W() const { return W_.leftCols(effects_.size()); }
  [[nodiscard]] OwnNoise own_noise() const { return {W_.rightCols<6>(), slopes_}; }

 private:
  void take(const SampleStep& step, std::size_t next_sample) {
    SampleDynamics dynamics = navigator_.propagate(step.raw);
    navigator_.set_time(step.at);
    if (step.coasting) dynamics.without_sensors();
    gyro_b_.setZero();
    accel_b_.setZero();
    const SampleView sample{step.whole ? next_sample - 1 : next_sample, dynamics.dtheta_b / dynamics.dt,
                            dynamics.dv_b / dynamics.dt, navigator_.nav()};
    effects_.add_sensor_errors(sample, gyro_b_, accel_b_);
    const Eigen::Matrix3d C = dynamics.dt * dynamics.C_b_e;
    gyro_e_.leftCols(effects_.size()).noalias() += C.lazyProduct(gyro_b_);
    accel_e_.leftCols(effects_.size()).noalias() += C.lazyProduct(accel_b_);
    gyro_e_.rightCols<6>().leftCols<3>() += C * layout_.gyro_noise_b();
    accel_e_.rightCols<3>() += C * layout_.accel_noise_b();
    if (!std::exchange(slopes_known_, true)) {
      effects_.add_own_slopes(sample, slopes_);
      slopes_ = noise_levels(mission_.imu, step.at).asDiagonal() * slopes_;
    }
    fold_.add(dynamics);
    if (TransitionAccumulator::substep_due(fold_.h)) close_fold();
  }
  void close_fold() {
    if (!(fold_.h > 0.0)) return;
    fold_.advance(W_, navigator_.gravity_gradient(), mission_.earth_rate);
    fold_.add_gyro_errors(W_, gyro_e_);
    fold_.add_accel_errors(W_, accel_e_);
    navigator_.advance_sensor_states();
    begin_fold();
  }
  void begin_fold() {
    fold_ = {};
    gyro_e_.setZero();
    accel_e_.setZero();
  }

  const Mission& mission_;
  const StateLayout& layout_;
  const Effects& effects_;
  Navigator navigator_;
  Fold fold_;
  NavRows W_;
  OwnSlopes slopes_;  ///< at the first sample
  bool slopes_known_ = false;
  Eigen::Matrix3Xd gyro_b_, accel_b_;  ///< of the current sample
  Eigen::Matrix3Xd gyro_e_, accel_e_;  ///< integrals over the fold
};

/// r and N of states and coefficients together. The coefficients are constants that the filter does not estimate: their
/// rows of the gain are zero,
///
///     Phi = [Phi_x W; 0 I],   H = [H_x D],   K = [K_x; 0].
class EffectRecursion {
 public:
  EffectRecursion(const StateLayout& layout, Eigen::Index effects, const EffectPassOptions& options)
      : of_states_(layout),
        layout_(layout),
        blocks_(layout),
        options_(options),
        r_(Eigen::VectorXd::Zero(effects)),
        own_noise_(r_),
        N_cross_(Eigen::MatrixXd::Zero(layout.size(), effects)),
        N_(Eigen::MatrixXd::Zero(effects, effects)),
        null_x_(Eigen::MatrixXd::Zero(layout.size(), options.draws)),
        null_(Eigen::MatrixXd::Zero(effects, options.draws)) {}

  void through_transition(const Knot& knot, const NavRows& W, const OwnNoise& own) {
    const NavCov N_nav = of_states_.N().topLeftCorner<kNav, kNav>();
    Eigen::Vector<double, 6> information;
    for (Eigen::Index axis = 0; axis < 6; ++axis)
      information(axis) = own.w.col(axis).dot(N_nav * own.w.col(axis)) / knot.interval;
    const Eigen::VectorXd of_noise = own.slopes.transpose() * information;
    own_noise_ += of_noise;
    r_ += of_noise;
    const Eigen::MatrixXd NW = of_states_.N().leftCols<kNav>() * W;
    // W' N W + W' C + C' W, C the cross part: one product, of which half is needed.
    const auto C = N_cross_.topRows<kNav>();
    Eigen::MatrixXd left(2 * kNav, W.cols()), right(2 * kNav, W.cols());
    left << W, C;
    right << NW.topRows<kNav>() + C, W;
    N_.triangularView<Eigen::Lower>() += left.transpose() * right;
    N_cross_ += NW;
    times_phi_transposed(knot, N_cross_);
    r_.noalias() += W.transpose() * of_states_.r().head<kNav>();
    null_.noalias() += W.transpose() * null_x_.topRows<kNav>();
    times_phi_transposed(knot, null_x_);
    of_states_.through_transition(knot);
  }

  void through_update(geo::GpsTime t, const AppliedUpdate& u, const Eigen::MatrixXd& D) {
    const Eigen::VectorXd innovation = u.S_inv * u.y - u.K.transpose() * of_states_.r();
    r_.noalias() += D.transpose() * innovation;
    draw(t, u, D);
    const Eigen::MatrixXd NK = of_states_.N() * u.K;               // n x m
    const Eigen::MatrixXd KtN_cross = u.K.transpose() * N_cross_;  // m x p
    const Eigen::MatrixXd weight = u.S_inv + u.K.transpose() * NK;
    Eigen::MatrixXd left(2 * D.rows(), D.cols()), right(2 * D.rows(), D.cols());
    left << D, KtN_cross;
    right << weight * D - KtN_cross, -D;
    N_.triangularView<Eigen::Lower>() += left.transpose() * right;
    // H' S^-1 D + (I - K H)' (N_cross - N K D)
    N_cross_.noalias() -= NK * D;
    N_cross_.noalias() += u.H.transpose() * (weight * D - KtN_cross);
    of_states_.through_update(u);
  }

  [[nodiscard]] Evidence at(geo::GpsTime t) const {
    return {t, of_states_.r(), of_states_.N(), r_, own_noise_, N_cross_, N_, null_x_, null_};
  }

 private:
  void times_phi_transposed(const Knot& knot, Eigen::MatrixXd& M) {
    if (M.cols() == 0) return;
    const auto rest = layout_.size() - kNav;
    const Eigen::MatrixXd nav = knot.Phi_n.transpose() * M.topRows<kNav>();
    blocks_.over(knot.interval, knot.renews_gnss_error).apply_transposed(M.bottomRows(rest));
    M.topRows<kNav>().setZero();
    M.topRows(nav.rows()) += nav;
  }
  // As through_update, with drawn innovations.
  void draw(geo::GpsTime t, const AppliedUpdate& u, const Eigen::MatrixXd& D) {
    if (null_.cols() == 0) return;
    Eigen::MatrixXd S_inv_y = Eigen::MatrixXd::Zero(u.y.size(), null_.cols());
    if (!u.S_inv.isZero(0.0)) {
      const ComponentCov L = Eigen::LLT<ComponentCov>(u.S_inv).matrixL();
      options_.draw(t, L.transpose() * u.y, S_inv_y);
      S_inv_y = L.triangularView<Eigen::Lower>() * S_inv_y;  // of y with covariance S
    }
    S_inv_y.noalias() -= u.K.transpose() * null_x_;
    null_.noalias() += D.transpose() * S_inv_y;
    null_x_.noalias() += u.H.transpose() * S_inv_y;
  }

  BackwardRecursion of_states_;
  const StateLayout& layout_;
  BlockTransitions blocks_;
  const EffectPassOptions& options_;
  Eigen::VectorXd r_;
  Eigen::VectorXd own_noise_;
  Eigen::MatrixXd N_cross_, N_;  ///< of N the lower triangle
  Eigen::MatrixXd null_x_, null_;
};

/// An update with the same gain whose innovation is not used.
AppliedUpdate silent(AppliedUpdate update) {
  update.S_inv.setZero();
  return update;
}

/// All that the recursion needs of a knot.
struct PreparedKnot {
  Knot knot;
  NavRows W;                       ///< over the interval to the next knot; none behind the last one
  OwnNoise own;                    ///< likewise
  std::vector<Eigen::MatrixXd> D;  ///< by update
};

/// Prepares knots, which do not depend on each other.
class Preparation {
 public:
  Preparation(const Mission& mission, const StateLayout& layout, const KnotStore& knots, const Effects& effects)
      : mission_(mission),
        layout_(layout),
        knots_(knots),
        effects_(effects),
        driven_(mission, layout, effects),
        navigator_(layout, mission.increments, mission.earth_rate) {}

  [[nodiscard]] PreparedKnot of(std::size_t k) {
    PreparedKnot prepared{.knot = knots_.at(k), .W = {}, .own = {}, .D = {}};
    const Knot& knot = prepared.knot;
    if (k + 1 < knots_.size()) {
      driven_.over(knot, knots_.time(k + 1));
      prepared.W = driven_.W();
      prepared.own = driven_.own_noise();
    }
    navigator_.set(knot.post);
    const SampleCursor cursor{knot.next_sample, knot.remainder};
    const Eigen::Matrix3d C_n_e = geo::C_n_e(geo::geodetic_from_ecef(knot.post.nav.r_eb_e));
    const UpdateContext context = update_context(mission_, layout_, cursor, navigator_, C_n_e);
    for (const AppliedUpdate& update : knot.updates) {
      prepared.D.emplace_back(Eigen::MatrixXd::Zero(update.y.size(), effects_.size()));
      effects_.add_measurement_errors({update.kind, knot.next_sample, knot.post.nav, context}, prepared.D.back());
    }
    return prepared;
  }

 private:
  const Mission& mission_;
  const StateLayout& layout_;
  const KnotStore& knots_;
  const Effects& effects_;
  DrivenColumns driven_;
  Navigator navigator_;
};

}  // namespace

// Knots are prepared by all threads, some at a time; the recursion takes them in order.
void effect_pass(const Mission& mission, const StateLayout& layout, const KnotStore& knots, const Effects& effects,
                 const EffectPassOptions& options, const std::function<void(const Evidence&)>& visit) {
  constexpr std::size_t kAtATime = 64;
  constexpr std::size_t kTokens = 8;
  EffectRecursion recursion(layout, effects.size(), options);
  std::size_t left = knots.size();
  const auto next = [&](tbb::flow_control& control) {
    if (left == 0) control.stop();
    return std::exchange(left, left - std::min(left, kAtATime));
  };
  const auto prepare = [&](std::size_t end) {
    Preparation preparation(mission, layout, knots, effects);
    std::vector<PreparedKnot> prepared;  // the last one first
    for (std::size_t k = end; k-- > end - std::min(end, kAtATime);) prepared.push_back(preparation.of(k));
    return std::pair(end, std::move(prepared));
  };
  const auto recur = [&](const std::pair<std::size_t, std::vector<PreparedKnot>>& chunk) {
    for (const PreparedKnot& one : chunk.second) {
      const geo::GpsTime t = one.knot.post.nav.t;
      if (one.W.cols() > 0) recursion.through_transition(one.knot, one.W, one.own);
      const bool counted = !options.counts || options.counts(t);
      for (std::size_t u = one.D.size(); u-- > 0;)
        recursion.through_update(t, counted ? one.knot.updates[u] : silent(one.knot.updates[u]), one.D[u]);
      visit(recursion.at(t));
    }
    if (options.progress) options.progress(1.0 - static_cast<double>(chunk.first) / static_cast<double>(knots.size()));
  };
  coast::parallel_pipeline(kTokens, tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order, next) &
                                        tbb::make_filter<std::size_t, std::pair<std::size_t, std::vector<PreparedKnot>>>(
                                            tbb::filter_mode::parallel, prepare) &
                                        tbb::make_filter<std::pair<std::size_t, std::vector<PreparedKnot>>, void>(
                                            tbb::filter_mode::serial_in_order, recur));
}

}  // namespace coast::estimate
