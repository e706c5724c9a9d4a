#include <cmath>
#include <numbers>

#include "gain.hpp"
#include "passes.hpp"

namespace coast::noise {

namespace {

/// Filter and its derivatives side by side. With a_upd = a + k e:
///
///     de = -h da,    d a' = Phi (da + k de + dk e) + dPhi a_upd
///     dS = h dP h' + dr,    dk = (dP h' - k dS)/S,    dP' = Phi dP_upd Phi' + dPhi P_upd Phi' + Phi P_upd dPhi' + dQ
template <int N>
class ScorePass {
 public:
  ScorePass(const SampleBlock& block, const std::vector<SampleBlock>& derivatives)
      : model_(block), gain_(model_), count_(static_cast<Eigen::Index>(derivatives.size())) {
    for (const SampleBlock& derivative : derivatives) {
      slopes_.emplace_back(derivative);
      dP_.push_back(slopes_.back().P1);
      moves_.push_back(!slopes_.back().Phi.isZero(0.0));
    }
    rest_.resize(derivatives.size());
    dk_.setZero(N, count_);
    da_.setZero(N, count_);
    dS_.setZero(count_);
    sums_.gradient.setZero(count_);
    sums_.information.setZero(count_, count_);
    gains();
  }

  ScoreSums run(const StaticSignal& signal, const MeanCurve& mean) {
    const GridTime time(signal);
    std::uint64_t at = 0;
    double samples = 0.0;
    for (const StaticSignal::Run& run : signal.runs) {
      for (; at < run.start; ++at) skip();
      std::size_t i = 0;
      for (; i < run.count && !steady_; ++i) step(signal.values[run.first + i] - mean.level - mean.drift * time.at(at + i));
      rest_of_run({signal.values.data() + run.first + i, run.count - i},
                  {mean.level + mean.drift * time.at(at + i), mean.drift * time.step()});
      at += run.count;
      samples += static_cast<double>(run.count);
    }
    sums_.log_likelihood -= 0.5 * samples * std::log(2.0 * std::numbers::pi);
    return sums_;
  }

 private:
  using Model = FixedModel<N>;
  using Slopes = Eigen::Matrix<double, N, Eigen::Dynamic, 0, N, kMostParameters>;
  using Row = Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, kMostParameters>;
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostParameters, kMostParameters>;
  struct Ramp {
    double start;
    double step;
  };

  void gains() {
    for (Eigen::Index i = 0; i < count_; ++i) {
      const typename Model::Vector dPh = dP_[at(i)] * model_.h.transpose();
      dS_(i) = model_.h.dot(dPh) + slopes_[at(i)].white;
      dk_.col(i) = (dPh - gain_.k * dS_(i)) / gain_.S;
    }
  }
  static std::size_t at(Eigen::Index i) { return static_cast<std::size_t>(i); }

  /// @param right  P_upd Phi'
  void predict_derivative(Eigen::Index i, const typename Model::Matrix& right, const typename Model::Matrix& dP_upd) {
    const Model& slope = slopes_[at(i)];
    typename Model::Matrix next = model_.sparse.congruence(dP_upd);
    // dPhi P_upd Phi' = ((P_upd Phi')' dPhi')'
    if (moves_[at(i)]) next += 2.0 * slope.sparse.right(right.transpose());
    dP_[at(i)] = 0.5 * (next + next.transpose()) + slope.Q;
  }
  void advance_states(const typename Model::Vector& a_upd) {
    da_ = (model_.Phi * da_).eval();
    for (Eigen::Index i = 0; i < count_; ++i)
      if (moves_[at(i)]) da_.col(i) += slopes_[at(i)].Phi * a_upd;
    a_ = model_.Phi * a_upd;
  }

  void skip() {
    advance_states(typename Model::Vector(a_));
    const typename Model::Matrix right = model_.sparse.right(gain_.P);
    for (Eigen::Index i = 0; i < count_; ++i) predict_derivative(i, right, typename Model::Matrix(dP_[at(i)]));
    gain_.skip();
    gains();
    steady_ = false;
  }

  void step(double y) {
    const double e = y - model_.h.dot(a_);
    const Row de = -model_.h * da_;
    const double S = gain_.S;
    sums_.log_likelihood -= 0.5 * (std::log(S) + e * e / S);
    sums_.gradient -= 0.5 / S * ((1.0 - e * e / S) * dS_ + 2.0 * e * de.transpose());
    sums_.information.noalias() += de.transpose() * de / S;
    sums_.information.noalias() += 0.5 / (S * S) * dS_ * dS_.transpose();
    da_ += gain_.k * de + e * dk_;
    advance_states(typename Model::Vector(a_ + gain_.k * e));
    const typename Model::Matrix right = model_.sparse.right(gain_.P - S * gain_.k * gain_.k.transpose());
    for (Eigen::Index i = 0; i < count_; ++i) {
      const typename Model::Matrix cross = dk_.col(i) * gain_.k.transpose();
      predict_derivative(i, right, dP_[at(i)] - dS_(i) * gain_.k * gain_.k.transpose() - S * (cross + cross.transpose()));
    }
    gain_.step();
    gains();
    look();
  }

  /// At rest are filter and derivatives, or neither.
  void look() {
    if (++since_look_ < SteadyState<N>::kStride) return;
    since_look_ = 0;
    bool all = gain_.steady();
    for (std::size_t i = 0; i < rest_.size(); ++i) {
      // Measured against P itself: the derivatives are with respect to logarithms.
      all = rest_[i].reached(gain_.P + dP_[i]) && all;
    }
    steady_ = all;
  }

  void rest_of_run(std::span<const double> values, const Ramp& mean) {
    if (values.empty()) return;
    const typename Model::Row h = model_.h;
    const typename Model::Matrix Phi = model_.Phi;
    const typename Model::Vector k = gain_.k;
    const Slopes Phi_dk = Phi * dk_;
    const typename Model::Vector Phi_k = Phi * k;
    typename Model::Vector a = a_;
    Slopes da = da_;
    Row de(count_);
    Row e_de = Row::Zero(count_);
    Square de_de = Square::Zero(count_, count_);
    double ee = 0.0;
    Slopes next(N, count_);
    for (std::size_t s = 0; s < values.size(); ++s) {
      const double e = values[s] - mean.start - mean.step * static_cast<double>(s) - h.dot(a);
      de.noalias() = -(h * da);
      ee += e * e;
      e_de += e * de;
      for (Eigen::Index i = 0; i < count_; ++i)
        for (Eigen::Index j = 0; j <= i; ++j) de_de(i, j) += de(i) * de(j);
      const typename Model::Vector a_upd = a + k * e;
      next.noalias() = Phi * da;
      for (Eigen::Index i = 0; i < count_; ++i) {
        next.col(i) += Phi_k * de(i) + Phi_dk.col(i) * e;
        if (moves_[at(i)]) next.col(i) += slopes_[at(i)].Phi * a_upd;
      }
      da.swap(next);
      a.noalias() = Phi * a_upd;
    }
    a_ = a;
    da_ = da;
    const double S = gain_.S;
    const auto n = static_cast<double>(values.size());
    sums_.log_likelihood -= 0.5 * (n * std::log(S) + ee / S);
    sums_.gradient -= 0.5 / S * ((n - ee / S) * dS_ + 2.0 * e_de.transpose());
    sums_.information += Square(de_de.template selfadjointView<Eigen::Lower>()) / S + 0.5 * n / (S * S) * dS_ * dS_.transpose();
  }

  Model model_;
  Gain<N> gain_;
  Eigen::Index count_;
  std::vector<Model> slopes_;
  std::vector<bool> moves_;  ///< the derivative has a part in Phi
  std::vector<typename Model::Matrix> dP_;
  std::vector<SteadyState<N>> rest_;
  Slopes dk_;
  Slopes da_;
  Eigen::VectorXd dS_;
  typename Model::Vector a_ = Model::Vector::Zero();
  int since_look_ = 0;
  bool steady_ = false;
  ScoreSums sums_;
};

}  // namespace

ScoreSums score_pass(const SampleBlock& block, const std::vector<SampleBlock>& derivatives, const StaticSignal& signal,
                     const MeanCurve& mean) {
  return with_size(block.h.size(), [&](auto size) { return ScorePass<size()>(block, derivatives).run(signal, mean); });
}

}  // namespace coast::noise
