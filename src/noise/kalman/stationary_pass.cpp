#include "stationary_pass.hpp"

#include <cmath>
#include <memory>
#include <numbers>
#include <span>

#include "fixed_model.hpp"
#include "stationary_gain.hpp"

namespace coast::noise {

namespace {

/// Innovations and, if wanted, predicted states of a record.
struct Trace {
  explicit Trace(std::size_t length, std::size_t states)
      : e(std::make_unique_for_overwrite<double[]>(length)), a(std::make_unique_for_overwrite<double[]>(length * states)) {}
  std::unique_ptr<double[]> e;
  std::unique_ptr<double[]> a;
};

template <int N>
class Loop {
 public:
  using Matrix = typename FixedModel<N>::Matrix;
  using Vector = typename FixedModel<N>::Vector;
  using Row = typename FixedModel<N>::Row;

  Loop(const StationaryGain& gain, const SampleBlock& block) : states_(block.h.size()) {
    F_.topLeftCorner(states_, states_) = gain.F;
    g_.head(states_) = gain.g;
    h_.head(states_) = block.h;
  }

  /// @return sum of squared innovations
  template <bool WithStates>
  double forward(const StaticSignal& signal, const MeanCurve& mean, const Eigen::VectorXd& start, Trace& trace) const {
    const GridTime time(signal);
    const double level = mean.level + mean.drift * time.at(0);
    const double drift = mean.drift * time.step();
    const Matrix F = F_;
    const Vector g = g_;
    const Row h = h_;
    Vector a = Vector::Zero();
    a.head(states_) = start;
    double squares = 0.0;
    for (std::size_t t = 0; t < signal.values.size(); ++t) {
      const double z = signal.values[t] - level - drift * static_cast<double>(t);
      const double e = z - h.dot(a);
      squares += e * e;
      trace.e[t] = e;
      if constexpr (WithStates) Eigen::Map<Vector>(trace.a.get() + t * N) = a;
      a = (F * a + g * z).eval();
    }
    return squares;
  }

  /// rho: of states (a, c, d) as in StartSums.
  [[nodiscard]] Eigen::VectorXd products(std::span<const double> e) const {
    const Matrix Ft = F_.transpose();
    const Vector g = g_;
    const Vector h = h_.transpose();
    Vector rho = Vector::Zero();
    double level = 0.0;
    double drift = 0.0;
    for (std::size_t t = e.size(); t-- > 0;) {
      drift += level;
      level += e[t] + g.dot(rho);
      rho = (Ft * rho - h * e[t]).eval();
    }
    Eigen::VectorXd all(states_ + 2);
    all << rho.head(states_), level, drift;
    return all;
  }

  /// lambda[t] = h' e[t] + F' lambda[t+1]
  void sensitivity(std::size_t length, const Trace& trace, Eigen::MatrixXd& lambda_a, Eigen::VectorXd& lambda_e) const {
    const Matrix Ft = F_.transpose();
    const Vector h = h_.transpose();
    Vector lambda = Vector::Zero();
    Matrix with_a = Matrix::Zero();
    Vector with_e = Vector::Zero();
    for (std::size_t t = length; t-- > 0;) {
      const double e = trace.e[t];
      with_a.noalias() += lambda * Eigen::Map<const Vector>(trace.a.get() + t * N).transpose();
      with_e += lambda * e;
      lambda = (Ft * lambda + h * e).eval();
    }
    lambda_a = with_a.topLeftCorner(states_, states_);
    lambda_e = with_e.head(states_);
  }

 private:
  Eigen::Index states_;
  Matrix F_ = Matrix::Zero();
  Vector g_ = Vector::Zero();
  Row h_ = Row::Zero();
};

/// States (a, c, d) of the columns 1 and tau.
Eigen::MatrixXd columns_of(const StaticSignal& signal, Eigen::Index states) {
  const GridTime time(signal);
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(states + 2, 2);
  columns(states, 0) = 1.0;
  columns(states, 1) = time.at(0);
  columns(states + 1, 1) = time.step();
  return columns;
}

template <int N>
InnovationSums innovations(const StationaryGain& gain, const SampleBlock& block, const StaticSignal& signal) {
  const Loop<N> loop(gain, block);
  const std::size_t length = signal.values.size();
  const Eigen::Index n = block.h.size();
  Trace trace(length, 0);
  const double squares = loop.template forward<false>(signal, {}, Eigen::VectorXd::Zero(n), trace);
  const Eigen::VectorXd rho = loop.products({trace.e.get(), length});
  const Eigen::MatrixXd W = start_sums(gain, block, {}, length).W;
  const StartCorrection start(gain, block, W);
  const Eigen::MatrixXd columns = columns_of(signal, n);
  Eigen::Matrix3d plain;
  plain(0, 0) = squares;
  plain.block(1, 0, 2, 1) = columns.transpose() * rho;
  plain.block(0, 1, 1, 2) = plain.block(1, 0, 2, 1).transpose();
  plain.bottomRightCorner(2, 2) = columns.transpose() * W * columns;
  InnovationSums sums;
  sums.positive = start.positive;
  sums.products = plain / gain.S;
  sums.log_determinant = static_cast<double>(length) * std::log(gain.S) + start.log_determinant;
  if (n == 0) return sums;
  Eigen::MatrixXd r(n, 3);  // minus X'e
  r.col(0) = rho.head(n);
  r.rightCols(2) = (W * columns).topRows(n);
  sums.products -= r.transpose() * start.D * start.B * r / (gain.S * gain.S);
  return sums;
}

/// Derivatives of the products of the columns' innovations, and of the log-determinant of the start.
struct StartSlopes {
  Eigen::Matrix2d products;
  double log_determinant = 0.0;
};
StartSlopes start_slopes(const StationaryGain& gain, const StationaryGain& slope, const StartCorrection& start,
                         const Eigen::MatrixXd& dD, const Eigen::MatrixXd& W, const Eigen::MatrixXd& dW,
                         const Eigen::MatrixXd& columns) {
  const Eigen::Index n = start.M.rows();
  const double S = gain.S;
  const double dS = slope.S;
  const Eigen::MatrixXd r = (W * columns).topRows(n);
  const Eigen::MatrixXd dr = (dW * columns).topRows(n);
  const Eigen::MatrixXd dM = (dW.topLeftCorner(n, n) - start.M * (dS / S)) / S;  // of M/S
  StartSlopes result;
  result.products = columns.transpose() * (dW - W * (dS / S)) * columns / S;
  if (n == 0) return result;
  const Eigen::MatrixXd DB = start.D * start.B;
  const Eigen::MatrixXd dDB = start.B.transpose() * (dD - start.D * dM * start.D) * start.B;
  const Eigen::MatrixXd cross = dr.transpose() * DB * r;
  result.products -= (cross + cross.transpose() + r.transpose() * dDB * r - r.transpose() * DB * r * (2.0 * dS / S)) / (S * S);
  result.log_determinant = (start.B * (dM * start.D + start.M * dD / S)).trace();
  return result;
}

// The start b that maximises the likelihood given the record: at it, as at the maximising mean, the derivatives of the other
// quantities are those with b held.
template <int N>
ScoreSums score(const StationaryGain& gain, const SampleBlock& block, const std::vector<SampleBlock>& derivatives,
                const StaticSignal& signal, const MeanCurve& mean) {
  const Loop<N> loop(gain, block);
  const std::size_t length = signal.values.size();
  const auto samples = static_cast<double>(length);
  const Eigen::Index n = block.h.size();
  const double S = gain.S;
  std::vector<StationaryGain> slopes;
  for (const SampleBlock& derivative : derivatives) slopes.push_back(slope_of(gain, block, derivative));
  const StartSums sums = start_sums(gain, block, slopes, length);
  const StartCorrection start(gain, block, sums.W);
  Trace trace(length, N);
  double squares = loop.template forward<false>(signal, mean, Eigen::VectorXd::Zero(n), trace);
  Eigen::VectorXd w = Eigen::VectorXd::Zero(n);
  if (n > 0) w = start.B * -loop.products({trace.e.get(), length}).head(n) / S;
  const Eigen::VectorXd b = start.D * w;
  squares = loop.template forward<true>(signal, mean, b, trace);
  Eigen::MatrixXd lambda_a;
  Eigen::VectorXd lambda_e;
  loop.sensitivity(length, trace, lambda_a, lambda_e);
  lambda_a += lambda_e * gain.k.transpose();  // of the updated state

  ScoreSums result;
  result.log_likelihood =
      -0.5 * (samples * std::log(2.0 * std::numbers::pi * S) + start.log_determinant + squares / S + w.dot(start.D * w));
  result.gradient.resize(static_cast<Eigen::Index>(slopes.size()));
  const Eigen::MatrixXd columns = columns_of(signal, n);
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    const Eigen::MatrixXd dD = derivatives[i].P_first - slopes[i].P;
    const StartSlopes d = start_slopes(gain, slopes[i], start, dD, sums.W, sums.dW[i], columns);
    const double e_de = -derivatives[i].Phi.cwiseProduct(lambda_a).sum() - lambda_e.dot(block.Phi * slopes[i].k);
    result.gradient(static_cast<Eigen::Index>(i)) =
        -0.5 * ((samples - squares / S) * slopes[i].S / S + d.log_determinant + 2.0 * e_de / S - w.dot(dD * w));
    result.products.push_back(d.products);
  }
  return result;
}

}  // namespace

std::optional<InnovationSums> stationary_innovations(const SampleBlock& block, const StaticSignal& signal) {
  if (!may_be_stationary(signal)) return {};
  const std::optional<StationaryGain> gain = stationary_gain(block);
  if (!gain) return {};
  return with_size(block.h.size(), [&](auto size) { return innovations<size()>(*gain, block, signal); });
}

std::optional<ScoreSums> stationary_score(const SampleBlock& block, const std::vector<SampleBlock>& derivatives,
                                          const StaticSignal& signal, const MeanCurve& mean) {
  if (!may_be_stationary(signal)) return {};
  const std::optional<StationaryGain> gain = stationary_gain(block);
  if (!gain) return {};
  return with_size(block.h.size(), [&](auto size) { return score<size()>(*gain, block, derivatives, signal, mean); });
}

}  // namespace coast::noise
