#include "noise_scores.hpp"

#include <array>
#include <cmath>

#include "backward_recursion.hpp"

namespace coast::estimate {

namespace {

using Eigen::Index;
using NavVector = Eigen::Matrix<double, kNav, 1>;

/// Index of each part among the free parameters.
class Places {
 public:
  explicit Places(const std::vector<NoiseParameter>& parameters) {
    at_.fill(-1);
    for (std::size_t i = 0; i < parameters.size(); ++i)
      at_[static_cast<std::size_t>(parameters[i].part)] = static_cast<Index>(i);
  }
  [[nodiscard]] Index operator()(NoisePart part) const { return at_[static_cast<std::size_t>(part)]; }

 private:
  std::array<Index, static_cast<std::size_t>(NoisePart::kCount)> at_;
};

/// Parts of the noise of measurements; the white noise affects the differences of members.
constexpr std::array kOfUpdates{NoisePart::kScaleHorizontal, NoisePart::kScaleVertical, NoisePart::kScaleVelocity,
                                NoisePart::kGyroX,           NoisePart::kGyroY,         NoisePart::kGyroZ,
                                NoisePart::kAccelX,          NoisePart::kAccelY,        NoisePart::kAccelZ};

/// dR with respect to the logarithm of a parameter; empty if it does not affect the measurement.
ComponentCov slope_of_R(NoisePart part, const Measurement& what, const AppliedUpdate& update, const Eigen::Matrix3d& C_n_e,
                        const NoiseModel& model) {
  const GnssScale& scale = model.adjustment.gnss_scale;
  const auto rotated = [&](const Eigen::Matrix3d& slope_n) -> ComponentCov { return C_n_e * slope_n * C_n_e.transpose(); };
  if (what.kind == UpdateKind::kGnssPosition && (part == NoisePart::kScaleHorizontal || part == NoisePart::kScaleVertical)) {
    const bool horizontal = part == NoisePart::kScaleHorizontal;
    const Eigen::Vector3d s(scale.horizontal, scale.horizontal, scale.vertical);
    const Eigen::Vector3d ds = horizontal ? Eigen::Vector3d(s.x(), s.y(), 0.0) : Eigen::Vector3d(0.0, 0.0, s.z());
    const Eigen::Matrix3d half = ds.asDiagonal() * model.mission.gnss.fixes[what.index].position_cov_n * s.asDiagonal();
    return rotated(half + half.transpose());
  }
  if (what.kind == UpdateKind::kGnssVelocity && part == NoisePart::kScaleVelocity)
    return rotated(2.0 * scale.velocity * scale.velocity * model.mission.gnss.fixes[what.index].velocity->cov_n);
  if (what.kind != UpdateKind::kMemberDifference) return {};
  // White noise of all members has the same factor; R = S - H K S is diagonal.
  const Index axis = static_cast<Index>(part) -
                     static_cast<Index>(what.sensor == noise::Sensor::kGyro ? NoisePart::kGyroX : NoisePart::kAccelX);
  if (axis < 0 || axis > 2) return {};
  const ComponentCov S = update.S_inv.llt().solve(ComponentCov::Identity(3, 3));
  ComponentCov slope = ComponentCov::Zero(3, 3);
  slope(axis, axis) = 2.0 * (S(axis, axis) - (update.H * (update.K * S.col(axis)))(axis));
  return slope;
}

/// Results of the backward pass for the forward one.
struct Disturbances {
  std::array<NavVector, 6> white;    ///< Q r of the white noise in the interval, in the order of AxisNoise
  std::vector<Components> u;         ///< of the updates
  Eigen::Vector3d gnss;              ///< H' u at the knot, rows of the correlated error
  Eigen::Vector3d behind, behind_t;  ///< the same of all later knots, times exp(-t/tau); times t/tau exp(-t/tau)
};

/// The correlated GNSS error over an interval: dphi is phi steps by the logarithm of the correlation time.
struct Decay {
  double phi, steps;
  double driven;  ///< 1 - phi^2
};

Decay decay_of(const Knot& knot, const CorrelatedGnss& gnss) {
  if (knot.renews_gnss_error) return {0.0, 0.0, 1.0};
  const double steps = knot.interval / gnss.time_s;
  return {std::exp(-steps), steps, -std::expm1(-2.0 * steps)};
}

class BackwardScores {
 public:
  explicit BackwardScores(const NoiseModel& model)
      : model_(model),
        place_(model.parameters),
        recursion_(model.layout),
        gradient_(Eigen::VectorXd::Zero(static_cast<Index>(model.parameters.size()))) {}

  void through_interval(const RecordedKnot& knot, Disturbances& left) {
    const Eigen::VectorXd& r = recursion_.r();
    const auto N = recursion_.N().topLeftCorner<kNav, kNav>();
    for (std::size_t i = 0; i < kWhiteNoise.size(); ++i) {
      if (place_(kWhiteNoise[i]) < 0) continue;
      left.white[i].noalias() = knot.white[i] * r.head<kNav>();
      add(kWhiteNoise[i], r.head<kNav>().dot(left.white[i]) - knot.white[i].cwiseProduct(N).sum());
    }
    if (!model_.layout.gnss_error()) {
      recursion_.through_transition(knot.knot);
      return;
    }
    add_driving_noise_of_gnss(knot.knot);
    recursion_.through_transition(knot.knot);
    add_decay_of_gnss(knot);
  }

  void through_updates(const RecordedKnot& knot, Disturbances& left) {
    const std::vector<AppliedUpdate>& updates = knot.knot.updates;
    left.u.resize(updates.size());
    left.gnss.setZero();
    left.behind = behind_;
    left.behind_t = behind_t_;
    for (std::size_t k = updates.size(); k-- > 0;) {
      const AppliedUpdate& update = updates[k];
      Components& u = left.u[k];
      u = update.S_inv * update.y - update.K.transpose() * recursion_.r();
      const ComponentCov D = update.S_inv + update.K.transpose() * (recursion_.N() * update.K);
      for (const NoisePart part : kOfUpdates) {
        if (place_(part) < 0) continue;
        const ComponentCov dR = slope_of_R(part, knot.measurements[k], update, knot.C_n_e, model_);
        if (dR.size() > 0) add(part, 0.5 * (u.dot(dR * u) - D.cwiseProduct(dR).sum()));
      }
      if (model_.layout.gnss_error()) left.gnss += update.H.middleCols<3>(*model_.layout.gnss_error()).transpose() * u;
      recursion_.through_update(update);
    }
    behind_ += left.gnss;
  }

  void at_start() {
    const Eigen::VectorXd& r = recursion_.r();
    for (std::size_t i = 0; i < model_.start.size(); ++i) {
      const StartSlope& start = model_.start[i];
      gradient_(static_cast<Index>(i)) +=
          -r.dot(start.estimate) + 0.5 * (r.dot(start.P * r) - start.P.cwiseProduct(recursion_.N()).sum());
    }
  }

  [[nodiscard]] const Eigen::VectorXd& gradient() const { return gradient_; }

 private:
  void add(NoisePart part, double score) {
    if (place_(part) >= 0) gradient_(place_(part)) += score;
  }
  // q = s^2 (1 - phi^2)
  void add_driving_noise_of_gnss(const Knot& knot) {
    const CorrelatedGnss& gnss = model_.adjustment.correlated_gnss;
    const auto [phi, steps, driven] = decay_of(knot, gnss);
    for (int axis = 0; axis < 3; ++axis) {
      const Index g = *model_.layout.gnss_error() + axis;
      const double s = axis < 2 ? gnss.horizontal_m : gnss.vertical_m;
      const double half = 0.5 * (recursion_.r()(g) * recursion_.r()(g) - recursion_.N()(g, g)) * s * s;
      add(axis < 2 ? NoisePart::kCorrelatedHorizontal : NoisePart::kCorrelatedVertical, 2.0 * driven * half);
      add(NoisePart::kCorrelatedTime, -2.0 * steps * phi * phi * half);
    }
  }
  // dphi = phi dt/tau; r and N are now those before the interval, Phi' r and Phi' N Phi.
  void add_decay_of_gnss(const RecordedKnot& knot) {
    const Decay decay = decay_of(knot.knot, model_.adjustment.correlated_gnss);
    const Eigen::VectorXd& r = recursion_.r();
    for (int axis = 0; axis < 3; ++axis) {
      const Index g = *model_.layout.gnss_error() + axis;
      const double along = r(g) * knot.P_gnss.row(axis).dot(r) - knot.P_gnss.row(axis).dot(recursion_.N().col(g));
      add(NoisePart::kCorrelatedTime, decay.steps * (along - r(g) * knot.knot.post.x(g)));
    }
    behind_t_ = decay.phi * (behind_t_ + decay.steps * behind_);
    behind_ *= decay.phi;
  }

  const NoiseModel& model_;
  Places place_;
  BackwardRecursion recursion_;
  Eigen::VectorXd gradient_;
  Eigen::Vector3d behind_ = Eigen::Vector3d::Zero(), behind_t_ = Eigen::Vector3d::Zero();
};

/// The filter applied to the series f_i, in errors d of its estimate: V^-1 f_i is S^-1 e_i.
class InformationPass {
 public:
  explicit InformationPass(const NoiseModel& model)
      : model_(model),
        place_(model.parameters),
        blocks_(model.layout),
        d_(Eigen::MatrixXd::Zero(model.layout.size(), static_cast<Index>(model.parameters.size()))),
        information_(Eigen::MatrixXd::Zero(d_.cols(), d_.cols())) {}

  void through_updates(const RecordedKnot& knot, const Disturbances& at) {
    if (model_.layout.gnss_error()) move_gnss(at);
    for (std::size_t k = 0; k < knot.knot.updates.size(); ++k) {
      const AppliedUpdate& update = knot.knot.updates[k];
      e_.noalias() = update.H * d_;
      if (model_.layout.gnss_error()) add_gnss(update);
      for (const NoisePart part : kOfUpdates) {
        if (place_(part) < 0) continue;
        const ComponentCov dR = slope_of_R(part, knot.measurements[k], update, knot.C_n_e, model_);
        if (dR.size() > 0) e_.col(place_(part)) += dR * at.u[k];
      }
      S_inv_e_.noalias() = update.S_inv * e_;
      information_.noalias() += 0.5 * e_.transpose() * S_inv_e_;
      d_.noalias() -= update.K * e_;
    }
  }

  void through_interval(const RecordedKnot& knot, const Disturbances& at) {
    const auto rest = d_.rows() - kNav;
    nav_.noalias() = knot.knot.Phi_n * d_.topRows(knot.knot.Phi_n.cols());
    blocks_.over(knot.knot.interval, knot.knot.renews_gnss_error).apply(d_.bottomRows(rest));
    d_.topRows<kNav>() = nav_;
    for (std::size_t i = 0; i < kWhiteNoise.size(); ++i)
      if (const Index column = place_(kWhiteNoise[i]); column >= 0) d_.col(column).head<kNav>() += 2.0 * at.white[i];
    const Decay decay = decay_of(knot.knot, model_.adjustment.correlated_gnss);
    before_t_ = decay.phi * (before_t_ + decay.steps * before_);
    before_ *= decay.phi;
  }

  [[nodiscard]] const Eigen::MatrixXd& information() const { return information_; }

 private:
  // The correlated error has covariance s^2 exp(-|t|/tau) between any two knots: effect of its derivatives on H' u.
  void move_gnss(const Disturbances& at) {
    const CorrelatedGnss& gnss = model_.adjustment.correlated_gnss;
    const Eigen::Vector3d s2(gnss.horizontal_m * gnss.horizontal_m, gnss.horizontal_m * gnss.horizontal_m,
                             gnss.vertical_m * gnss.vertical_m);
    before_ += at.gnss;
    by_size_ = 2.0 * s2.cwiseProduct(before_ + at.behind);
    by_time_ = s2.cwiseProduct(before_t_ + at.behind_t);
  }
  void add_gnss(const AppliedUpdate& update) {
    const auto H = update.H.middleCols<3>(*model_.layout.gnss_error());
    if (const Index i = place_(NoisePart::kCorrelatedHorizontal); i >= 0) e_.col(i) += H.leftCols<2>() * by_size_.head<2>();
    if (const Index i = place_(NoisePart::kCorrelatedVertical); i >= 0) e_.col(i) += H.col(2) * by_size_.z();
    if (const Index i = place_(NoisePart::kCorrelatedTime); i >= 0) e_.col(i) += H * by_time_;
  }

  const NoiseModel& model_;
  Places place_;
  BlockTransitions blocks_;
  Eigen::MatrixXd d_, e_, S_inv_e_, nav_;
  Eigen::Vector3d before_ = Eigen::Vector3d::Zero(), before_t_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d by_size_, by_time_;
  Eigen::MatrixXd information_;
};

}  // namespace

NoiseScores noise_scores(const PassRecord& pass, const NoiseModel& model) {
  std::vector<Disturbances> disturbances(pass.size());
  BackwardScores backward(model);
  for (std::size_t i = pass.size(); i-- > 0;) {
    if (i + 1 < pass.size()) backward.through_interval(pass[i], disturbances[i]);
    backward.through_updates(pass[i], disturbances[i]);
  }
  backward.at_start();
  InformationPass forward(model);
  for (std::size_t i = 0; i < pass.size(); ++i) {
    forward.through_updates(pass[i], disturbances[i]);
    if (i + 1 < pass.size()) forward.through_interval(pass[i], disturbances[i]);
  }
  return {backward.gradient(), forward.information()};
}

}  // namespace coast::estimate
