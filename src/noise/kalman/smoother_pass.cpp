#include <cmath>

#include "gain.hpp"
#include "passes.hpp"

namespace coast::noise {

namespace {

/// Filter forward, then the recursion of Bryson & Frazier (1963) / de Jong (1989) backward:
///
///     r <- h' e/S + L' r,    N <- h'h/S + L' N L,    L = Phi (I - k h)
///     x_smooth = a + P r,    V = P - P N P,    Cov(x[k+1], x[k]) = (I - P[k+1] N[k]) L P
///
/// Constant gains are stored once, and if N is constant too the covariances are not computed again.
template <int N>
class SmootherPass {
 public:
  using Model = FixedModel<N>;
  using Matrix = typename Model::Matrix;
  using Vector = typename Model::Vector;

  SmootherPass(const SampleBlock& block, SmootherScratch& scratch) : model_(block), steps_(scratch.steps) {}

  /// @param share  of the signal: 0 smooths only minus the mean
  void forward(const StaticSignal& signal, const MeanCurve& mean, double share = 1.0) {
    const GridTime time(signal);
    Gain<N> gain(model_);
    gains_.clear();
    resting_ = false;
    Vector a = Vector::Zero();
    steps_.resize(static_cast<std::size_t>(signal.length()) * kPerStep);
    double* out = steps_.data();
    const auto put = [&](double e) {
      for (int i = 0; i < N; ++i) out[i] = a(i);
      out[N] = e;
      out += kPerStep;
    };
    std::uint64_t at = 0;
    for (const StaticSignal::Run& run : signal.runs) {
      for (; at < run.start; ++at) {
        store(gain, at, false);
        put(0.0);
        a = (model_.Phi * a).eval();
        gain.skip();
      }
      for (std::size_t i = 0; i < run.count; ++i, ++at) {
        const double e = share * signal.values[run.first + i] - mean.level - mean.drift * time.at(at) - model_.h.dot(a);
        if (!gain.steady() || i == 0 || !resting_) store(gain, at, true);
        resting_ = gain.steady();
        put(e);
        a = (model_.Phi * (a + gain.k * e)).eval();
        gain.step();
      }
    }
    count_ = static_cast<std::size_t>(at);
  }

  /// visitor.state(step, a, e, x_smooth, observed) for every step, from the last to the first, and
  /// visitor.covariance(step, V, lagged, observed, times): V of the smoothed states, lagged = Cov(x[k+1], x[k]) except at the
  /// last step, which hold for `times` steps that end at `step`.
  template <class Visitor>
  void backward(Visitor&& visitor) const {
    Vector r = Vector::Zero();
    Matrix N_r = Matrix::Zero();
    const Matrix* P_next = nullptr;
    std::size_t end = count_;
    for (std::size_t g = gains_.size(); g-- > 0;) {
      const Stored& gain = gains_[g];
      const auto begin = static_cast<std::size_t>(gain.from);
      // From predicted state to predicted state.
      const Matrix L = gain.observed ? Matrix(model_.Phi * (Matrix::Identity() - gain.k * model_.h)) : model_.Phi;
      const Matrix LP = L * gain.P;
      SteadyState<N> rest;
      bool resting = false;
      Matrix V = Matrix::Zero();
      Matrix lagged = Matrix::Zero();
      std::size_t same = 0;
      for (std::size_t step = end; step-- > begin;) {
        const double* in = steps_.data() + step * kPerStep;
        const Vector a = Eigen::Map<const Vector>(in);
        if (!resting) {
          lagged = LP;
          if (P_next != nullptr) lagged -= *P_next * N_r * LP;
          N_r = (L.transpose() * N_r * L).eval();
          if (gain.observed) N_r.noalias() += model_.h.transpose() * model_.h / gain.S;
          V = gain.P - gain.P * N_r * gain.P;
          visitor.covariance(step, V, lagged, gain.observed, 1.0);
          resting = (end - step) % SteadyState<N>::kStride == 0 && rest.reached(N_r);
          P_next = &gain.P;
        } else {
          ++same;
        }
        r = (L.transpose() * r).eval();
        if (gain.observed) r += model_.h.transpose() * (in[N] / gain.S);
        visitor.state(step, a, in[N], Vector(a + gain.P * r), gain.observed);
      }
      if (same > 0) visitor.covariance(begin, V, lagged, gain.observed, static_cast<double>(same));
      P_next = &gain.P;
      end = begin;
    }
  }

  [[nodiscard]] std::size_t steps() const { return count_; }
  [[nodiscard]] const Model& model() const { return model_; }

 private:
  static constexpr std::size_t kPerStep = N + 1;  ///< predicted state, innovation

  /// Valid from a grid index on.
  struct Stored {
    std::uint64_t from = 0;
    bool observed = true;
    double S = 0.0;
    Matrix P;
    Vector k;
  };
  void store(const Gain<N>& gain, std::uint64_t from, bool observed) {
    gains_.push_back({from, observed, gain.S, gain.P, gain.k});
  }

  Model model_;
  std::vector<Stored> gains_;
  std::vector<double>& steps_;
  std::size_t count_ = 0;
  bool resting_ = false;
};

template <int N>
struct MomentSums {
  using Matrix = typename FixedModel<N>::Matrix;
  using Vector = typename FixedModel<N>::Vector;
  using Row = typename FixedModel<N>::Row;

  void state(std::size_t step, const Vector& a, double e, const Vector& x, bool observed) {
    products.noalias() += x * x.transpose();
    if (step + 1 < count) lagged.noalias() += after * x.transpose();
    if (step + 1 == count) last += x * x.transpose();
    if (step == 0) first += x * x.transpose();
    const double left = e + h.dot(a - x);
    if (observed) residual += left * left;
    after = x;
  }
  void covariance(std::size_t step, const Matrix& V, const Matrix& lag, bool observed, double times) {
    if (!with_covariances) return;
    products += times * V;
    if (step + 1 < count) lagged += times * lag;
    if (step + 1 == count) last += V;
    if (step == 0) first += V;
    if (observed) residual += times * (h * V).dot(h);
  }

  std::size_t count;
  Row h;
  bool with_covariances = true;
  Matrix products = Matrix::Zero();
  Matrix lagged = Matrix::Zero();
  Matrix first = Matrix::Zero();
  Matrix last = Matrix::Zero();
  Vector after = Vector::Zero();
  double residual = 0.0;
};

template <int N>
BlockMoments moments(const SampleBlock& block, const StaticSignal& signal, const MeanCurve& mean,
                     const std::vector<MeanCurve>& doubt, SmootherScratch& scratch) {
  SmootherPass<N> pass(block, scratch);
  pass.forward(signal, mean);
  MomentSums<N> sums{pass.steps(), pass.model().h};
  pass.backward(sums);
  // The smoother is linear: its output for a curve adds to the second moments with the variance of the curve's coefficient.
  sums.with_covariances = false;
  for (const MeanCurve& curve : doubt) {
    pass.forward(signal, curve, 0.0);
    sums.after.setZero();
    pass.backward(sums);
  }
  const Eigen::Index n = block.h.size();
  const auto cut = [n](const auto& m) { return Eigen::MatrixXd(m.topLeftCorner(n, n)); };
  BlockMoments result;
  result.first = cut(sums.first);
  result.before = cut((sums.products - sums.last).eval());
  result.after = cut((sums.products - sums.first).eval());
  result.lagged = cut(sums.lagged);
  result.transitions = static_cast<double>(pass.steps()) - 1.0;
  result.records = 1.0;
  result.residual = sums.residual;
  result.samples = static_cast<double>(signal.values.size());
  return result;
}

/// Every `stride`-th smoothed output. A constant variance is stored at the first of its steps and distributed afterwards.
template <int N>
struct OutputCollector {
  using Matrix = typename FixedModel<N>::Matrix;
  using Vector = typename FixedModel<N>::Vector;

  void state(std::size_t step, const Vector&, double, const Vector& x, bool) {
    if (step % stride == 0) result.mean.col(column(step)) = rows * x.head(rows.cols());
  }
  void covariance(std::size_t step, const Matrix& V, const Matrix&, bool, double times) {
    const std::size_t end = step + static_cast<std::size_t>(times);
    const Eigen::VectorXd variance = (rows * V.topLeftCorner(rows.cols(), rows.cols()) * rows.transpose()).diagonal();
    for (std::size_t at = (step + stride - 1) / stride * stride; at < end; at += stride)
      result.variance.col(column(at)) = variance;
  }
  [[nodiscard]] Eigen::Index column(std::size_t step) const { return static_cast<Eigen::Index>(step / stride); }

  const Eigen::MatrixXd& rows;
  std::size_t stride;
  SmoothedOutputs& result;
};

template <int N>
SmoothedOutputs smoothed_outputs(const SampleBlock& block, const Eigen::MatrixXd& rows, const StaticSignal& signal,
                                 const MeanCurve& mean, std::size_t stride) {
  SmootherScratch scratch;
  SmootherPass<N> pass(block, scratch);
  pass.forward(signal, mean);
  const auto points = static_cast<Eigen::Index>((pass.steps() + stride - 1) / stride);
  SmoothedOutputs result{{}, Eigen::MatrixXd(rows.rows(), points), Eigen::MatrixXd(rows.rows(), points)};
  for (Eigen::Index i = 0; i < points; ++i) result.at.push_back(static_cast<std::uint64_t>(i) * stride);
  OutputCollector<N> collector{rows, stride, result};
  pass.backward(collector);
  return result;
}

}  // namespace

BlockMoments moment_pass(const SampleBlock& block, const StaticSignal& signal, const MeanCurve& mean,
                         const std::vector<MeanCurve>& doubt, SmootherScratch& scratch) {
  return with_size(block.h.size(), [&](auto size) { return moments<size()>(block, signal, mean, doubt, scratch); });
}

SmoothedOutputs smoothing_pass(const SampleBlock& block, const Eigen::MatrixXd& rows, const StaticSignal& signal,
                               const MeanCurve& mean, std::size_t stride) {
  return with_size(block.h.size(), [&](auto size) { return smoothed_outputs<size()>(block, rows, signal, mean, stride); });
}

}  // namespace coast::noise
