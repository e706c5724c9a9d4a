#include "stationary_gain.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace coast::noise {

namespace {

Eigen::MatrixXd symmetric(const Eigen::MatrixXd& M) {
  return 0.5 * (M + M.transpose());
}

/// A stretch of the filter: from a known state to one of covariance C, which depends on the first by A; J is the information
/// of its samples about the first. They are joined as in Sarkka & Garcia-Fernandez (2021).
struct Steps {
  Eigen::MatrixXd A;
  Eigen::MatrixXd C;
  Eigen::MatrixXd J;
};

std::optional<Steps> one_sample(const SampleBlock& block) {
  const Eigen::VectorXd Q_h = block.Q * block.h.transpose();
  const double S = block.h.dot(Q_h) + block.white;
  if (!(S > 0.0) || !std::isfinite(S)) return {};
  const Eigen::VectorXd K = Q_h / S;
  const Eigen::RowVectorXd h_Phi = block.h * block.Phi;
  return Steps{block.Phi - K * h_Phi, symmetric(block.Q - K * Q_h.transpose()), h_Phi.transpose() * h_Phi / S};
}

Steps doubled(const Steps& s) {
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(s.A.rows(), s.A.cols());
  const Eigen::PartialPivLU<Eigen::MatrixXd> between(one + s.C * s.J);
  const Eigen::MatrixXd through = s.A * between.inverse();
  return {through * s.A, symmetric(s.C + through * s.C * s.A.transpose()),
          symmetric(s.J + s.A.transpose() * s.J * between.inverse() * s.A)};
}

/// Largest change relative to the diagonal.
double change(const Eigen::MatrixXd& now, const Eigen::MatrixXd& before) {
  double largest = 0.0;
  for (Eigen::Index i = 0; i < now.rows(); ++i)
    for (Eigen::Index j = 0; j <= i; ++j) {
      const double scale = std::sqrt(now(i, i) * now(j, j));
      if (scale > 0.0) largest = std::max(largest, std::abs(now(i, j) - before(i, j)) / scale);
    }
  return largest;
}

StationaryGain gain_of(const Eigen::MatrixXd& P, const SampleBlock& block) {
  StationaryGain gain;
  gain.P = P;
  gain.k = P * block.h.transpose();
  gain.S = block.h.dot(gain.k) + block.white;
  gain.k /= gain.S;
  gain.g = block.Phi * gain.k;
  gain.F = block.Phi - gain.g * block.h;
  return gain;
}

/// X = F X F' + H
Eigen::MatrixXd accumulated(Eigen::MatrixXd F, Eigen::MatrixXd H) {
  constexpr int kMost = 60;
  constexpr double kNothing = 1e-18;
  if (H.size() == 0) return H;
  for (int i = 0; i < kMost; ++i) {
    const Eigen::MatrixXd more = F * H * F.transpose();
    H += more;
    if (more.cwiseAbs().maxCoeff() <= kNothing * H.cwiseAbs().maxCoeff()) break;
    F = (F * F).eval();
  }
  return symmetric(H);
}

}  // namespace

std::optional<StationaryGain> stationary_gain(const SampleBlock& block) {
  constexpr int kMost = 45;
  constexpr double kRounding = 1e-15;
  constexpr double kSettled = 1e-11;
  if (block.h.size() == 0) return gain_of(block.P_first, block);
  std::optional<Steps> stretch = one_sample(block);
  if (!stretch) return {};
  bool settled = false;
  for (int i = 0; i < kMost && !settled; ++i) {
    Steps next = doubled(*stretch);
    settled = change(next.C, stretch->C) < kRounding;
    stretch = std::move(next);
    if (!stretch->C.allFinite() || !stretch->J.allFinite()) return {};
  }
  if (!settled) return {};
  const auto predicted = [&](const Eigen::MatrixXd& C) { return symmetric(block.Phi * C * block.Phi.transpose() + block.Q); };
  StationaryGain gain = gain_of(predicted(stretch->C), block);
  if (!(gain.S > 0.0)) return {};
  const Eigen::MatrixXd again = predicted(gain.P - gain.S * gain.k * gain.k.transpose());
  if (!(change(again, gain.P) < kSettled)) return {};
  return gain;
}

// P = F P F' + g r g' + Q with the gain that minimises it: the derivative by the gain is zero.
StationaryGain slope_of(const StationaryGain& gain, const SampleBlock& block, const SampleBlock& derivative) {
  const Eigen::MatrixXd P_upd = gain.P - gain.S * gain.k * gain.k.transpose();
  const Eigen::MatrixXd turned = derivative.Phi * P_upd * block.Phi.transpose();
  StationaryGain slope;
  slope.P = accumulated(gain.F, turned + turned.transpose() + derivative.Q + derivative.white * gain.g * gain.g.transpose());
  const Eigen::VectorXd P_h = slope.P * block.h.transpose();
  slope.S = block.h.dot(P_h) + derivative.white;
  slope.k = (P_h - gain.k * slope.S) / gain.S;
  slope.g = derivative.Phi * gain.k + block.Phi * slope.k;
  slope.F = derivative.Phi - slope.g * block.h;
  return slope;
}

namespace {

/// One binary digit of the number of steps after the other: A for the steps so far, W over them.
class Doubling {
 public:
  Doubling(Eigen::MatrixXd A, const Eigen::RowVectorXd& C, std::vector<Eigen::MatrixXd> dA)
      : A_(std::move(A)),
        W_(C.transpose() * C),
        dA_(std::move(dA)),
        dW_(dA_.size(), Eigen::MatrixXd::Zero(W_.rows(), W_.cols())) {
    first_ = {A_, W_, dA_};
  }
  StartSums over(std::uint64_t steps) {
    int digit = 63;
    while ((steps >> static_cast<unsigned>(digit)) == 0) --digit;
    for (--digit; digit >= 0; --digit) {
      twice();
      if (((steps >> static_cast<unsigned>(digit)) & 1U) != 0) one_more();
    }
    return {W_, dW_};
  }

 private:
  struct First {
    Eigen::MatrixXd A;
    Eigen::MatrixXd W;
    std::vector<Eigen::MatrixXd> dA;
  };
  void twice() {
    const Eigen::MatrixXd WA = W_ * A_;
    for (std::size_t i = 0; i < dA_.size(); ++i) {
      const Eigen::MatrixXd cross = dA_[i].transpose() * WA;
      dW_[i] = (dW_[i] + A_.transpose() * dW_[i] * A_ + cross + cross.transpose()).eval();
      dA_[i] = (dA_[i] * A_ + A_ * dA_[i]).eval();
    }
    W_ += A_.transpose() * WA;
    A_ = (A_ * A_).eval();
  }
  void one_more() {
    const Eigen::MatrixXd WA = W_ * first_.A;
    for (std::size_t i = 0; i < dA_.size(); ++i) {
      const Eigen::MatrixXd cross = first_.dA[i].transpose() * WA;
      dW_[i] = (first_.A.transpose() * dW_[i] * first_.A + cross + cross.transpose()).eval();
      dA_[i] = (dA_[i] * first_.A + A_ * first_.dA[i]).eval();
    }
    W_ = (first_.W + first_.A.transpose() * WA).eval();
    A_ = (A_ * first_.A).eval();
  }

  Eigen::MatrixXd A_;
  Eigen::MatrixXd W_;
  std::vector<Eigen::MatrixXd> dA_;
  std::vector<Eigen::MatrixXd> dW_;
  First first_;
};

}  // namespace

StartSums start_sums(const StationaryGain& gain, const SampleBlock& block, const std::vector<StationaryGain>& slopes,
                     std::uint64_t steps) {
  const Eigen::Index n = block.h.size();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n + 2, n + 2);
  A.topLeftCorner(n, n) = gain.F;
  A.col(n).head(n) = gain.g;
  A(n, n) = A(n, n + 1) = A(n + 1, n + 1) = 1.0;
  Eigen::RowVectorXd C = Eigen::RowVectorXd::Zero(n + 2);
  C.head(n) = -block.h;
  C(n) = 1.0;
  std::vector<Eigen::MatrixXd> dA;
  for (const StationaryGain& slope : slopes) {
    Eigen::MatrixXd& d = dA.emplace_back(Eigen::MatrixXd::Zero(n + 2, n + 2));
    d.topLeftCorner(n, n) = slope.F;
    d.col(n).head(n) = slope.g;
  }
  return Doubling(A, C, std::move(dA)).over(steps);
}

StartCorrection::StartCorrection(const StationaryGain& gain, const SampleBlock& block, const Eigen::MatrixXd& W)
    : D(block.P_first - gain.P), M(W.topLeftCorner(block.h.size(), block.h.size())) {
  const Eigen::Index n = block.h.size();
  if (n == 0) return;
  const Eigen::PartialPivLU<Eigen::MatrixXd> factor(Eigen::MatrixXd::Identity(n, n) + M * D / gain.S);
  const double determinant = factor.determinant();
  positive = determinant > 0.0 && std::isfinite(determinant);
  log_determinant = std::log(determinant);
  B = factor.inverse();
}

bool may_be_stationary(const StaticSignal& signal) {
  constexpr std::size_t kLong = 20000;
  return signal.values.size() >= kLong && signal.values.size() == signal.length();
}

}  // namespace coast::noise
