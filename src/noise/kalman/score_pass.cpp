#include <cmath>
#include <numbers>

#include "gain_slopes.hpp"
#include "passes.hpp"

namespace coast::noise {

namespace {

/// The filter of the columns 1 and tau with its derivatives, only for the products of their innovations:
///
///     d(e_c e_d / S) = (de_c e_d + e_c de_d)/S - e_c e_d dS/S^2
template <int N>
class MeanColumns {
 public:
  MeanColumns(const FixedModel<N>& model, std::size_t count)
      : model_(model), state_(Columns::Zero()), slopes_(count, state_), products_(count, Eigen::Matrix2d::Zero()) {}

  [[nodiscard]] const std::vector<Eigen::Matrix2d>& products() const { return products_; }

  void skip(const GainSlopes<N>& gains) {
    for (std::size_t i = 0; i < slopes_.size(); ++i) slopes_[i] = advanced(i, slopes_[i], state_, gains);
    state_ = model_.sparse.left(state_);
  }
  void step(double tau, const GainSlopes<N>& gains) {
    const Eigen::RowVector2d e = Eigen::RowVector2d(1.0, tau) - model_.h * state_;
    const double S = gains.S();
    const Columns updated = state_ + gains.k() * e;
    for (std::size_t i = 0; i < slopes_.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      const Eigen::RowVector2d de = -model_.h * slopes_[i];
      const Eigen::Matrix2d cross = de.transpose() * e;
      products_[i] += (cross + cross.transpose()) / S - gains.dS()(at) / (S * S) * e.transpose() * e;
      slopes_[i] = advanced(i, slopes_[i] + gains.k() * de + gains.dk().col(at) * e, updated, gains);
    }
    state_ = model_.sparse.left(updated);
  }
  /// With constant gains. A stationary filter follows a ramp by a ramp: once second differences vanish, the rest is summed.
  void rest(std::size_t count, double tau, double tau_step, const GainSlopes<N>& gains) {
    const auto tau_at = [&](std::size_t i) { return tau + static_cast<double>(i) * tau_step; };
    std::size_t done = 0;
    while (done < count) {
      if (count - done < 3 * kStride) {
        step(tau_at(done++), gains);
        continue;
      }
      const Eigen::MatrixXd first = innovations(tau_at(done));
      for (std::size_t i = 0; i < kStride; ++i) step(tau_at(done++), gains);
      const Eigen::MatrixXd second = innovations(tau_at(done));
      const std::vector<Columns> before = states();
      for (std::size_t i = 0; i < kStride; ++i) step(tau_at(done++), gains);
      const Eigen::MatrixXd third = innovations(tau_at(done));
      if ((first - 2.0 * second + third).cwiseAbs().maxCoeff() > kStraight) continue;
      leap(count - done, third, (third - second) / static_cast<double>(kStride), before, gains);
      return;
    }
  }

 private:
  using Columns = Eigen::Matrix<double, N, 2>;
  static constexpr std::size_t kStride = 64;
  static constexpr double kStraight = 1e-12;  // relative to columns of size 1

  [[nodiscard]] Columns advanced(std::size_t i, const Columns& slope, const Columns& updated,
                                 const GainSlopes<N>& gains) const {
    const auto at = static_cast<Eigen::Index>(i);
    Columns next = model_.sparse.left(slope);
    if (!gains.dPhi(at).empty()) next += gains.dPhi(at).left(updated);
    return next;
  }
  /// Rows: the columns, then their derivatives.
  [[nodiscard]] Eigen::MatrixXd innovations(double tau) const {
    Eigen::MatrixXd e(static_cast<Eigen::Index>(slopes_.size()) + 1, 2);
    e.row(0) = Eigen::RowVector2d(1.0, tau) - model_.h * state_;
    for (std::size_t i = 0; i < slopes_.size(); ++i) e.row(static_cast<Eigen::Index>(i) + 1) = -model_.h * slopes_[i];
    return e;
  }
  [[nodiscard]] std::vector<Columns> states() const {
    std::vector<Columns> all{state_};
    all.insert(all.end(), slopes_.begin(), slopes_.end());
    return all;
  }
  /// `count` steps at once: innovations from `start` on, each changing by `change`. @param before  states one stride earlier
  void leap(std::size_t count, const Eigen::MatrixXd& start, const Eigen::MatrixXd& change, const std::vector<Columns>& before,
            const GainSlopes<N>& gains) {
    const auto n = static_cast<double>(count);
    const double ones = n * (n - 1.0) / 2.0;
    const double squares = (n - 1.0) * n * (2.0 * n - 1.0) / 6.0;
    const auto sum_of = [&](Eigen::Index i, Eigen::Index j) -> Eigen::Matrix2d {
      return n * start.row(i).transpose() * start.row(j) + squares * change.row(i).transpose() * change.row(j) +
             ones * (start.row(i).transpose() * change.row(j) + change.row(i).transpose() * start.row(j));
    };
    const double S = gains.S();
    const Eigen::Matrix2d plain = sum_of(0, 0);
    const double strides = n / static_cast<double>(kStride);
    for (std::size_t i = 0; i < slopes_.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      const Eigen::Matrix2d cross = sum_of(at + 1, 0);
      products_[i] += (cross + cross.transpose()) / S - gains.dS()(at) / (S * S) * plain;
      slopes_[i] += (slopes_[i] - before[i + 1]).eval() * strides;
    }
    state_ += (state_ - before[0]).eval() * strides;
  }

  const FixedModel<N>& model_;
  Columns state_;
  std::vector<Columns> slopes_;
  std::vector<Eigen::Matrix2d> products_;
};

/// Filter and its derivatives together. With a_upd = a + k e:
///
///     de = -h da,    d a' = Phi (da + k de + dk e) + dPhi a_upd
template <int N>
class ScorePass {
 public:
  ScorePass(const SampleBlock& block, const std::vector<SampleBlock>& derivatives)
      : model_(block), slopes_(model_, derivatives), count_(slopes_.count()), columns_(model_, derivatives.size()) {
    da_.setZero(N, count_);
    sums_.gradient.setZero(count_);
    sums_.information.setZero(count_, count_);
  }

  ScoreSums run(const StaticSignal& signal, const MeanCurve& mean) {
    const GridTime time(signal);
    std::uint64_t at = 0;
    double samples = 0.0;
    for (const StaticSignal::Run& run : signal.runs) {
      for (; at < run.start; ++at) skip();
      std::size_t i = 0;
      for (; i < run.count && !slopes_.steady(); ++i) {
        columns_.step(time.at(at + i), slopes_);
        step(signal.values[run.first + i] - mean.level - mean.drift * time.at(at + i));
      }
      columns_.rest(run.count - i, time.at(at + i), time.step(), slopes_);
      rest_of_run({signal.values.data() + run.first + i, run.count - i},
                  {mean.level + mean.drift * time.at(at + i), mean.drift * time.step()});
      at += run.count;
      samples += static_cast<double>(run.count);
    }
    sums_.log_likelihood -= 0.5 * samples * std::log(2.0 * std::numbers::pi);
    sums_.products = columns_.products();
    return sums_;
  }

 private:
  using Model = FixedModel<N>;
  using Slopes = typename GainSlopes<N>::Slopes;
  using Row = Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, kMostParameters>;
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostParameters, kMostParameters>;
  struct Ramp {
    double start;
    double step;
  };

  void advance_states(const typename Model::Vector& a_upd) {
    da_ = model_.sparse.left(da_);
    for (Eigen::Index i = 0; i < count_; ++i)
      if (!slopes_.dPhi(i).empty()) da_.col(i) += slopes_.dPhi(i).left(a_upd);
    a_ = model_.sparse.left(a_upd);
  }

  void skip() {
    advance_states(typename Model::Vector(a_));
    columns_.skip(slopes_);
    slopes_.skip();
  }

  void step(double y) {
    const double e = y - model_.h.dot(a_);
    const Row de = -model_.h * da_;
    const double S = slopes_.S();
    const Eigen::VectorXd& dS = slopes_.dS();
    sums_.log_likelihood -= 0.5 * (std::log(S) + e * e / S);
    sums_.gradient -= 0.5 / S * ((1.0 - e * e / S) * dS + 2.0 * e * de.transpose());
    sums_.information.noalias() += de.transpose() * de / S;
    sums_.information.noalias() += 0.5 / (S * S) * dS * dS.transpose();
    da_ += slopes_.k() * de + e * slopes_.dk();
    advance_states(typename Model::Vector(a_ + slopes_.k() * e));
    slopes_.step();
  }

  void rest_of_run(std::span<const double> values, const Ramp& mean) {
    if (values.empty()) return;
    const typename Model::Row h = model_.h;
    const typename Model::Matrix Phi = model_.Phi;
    const typename Model::Vector k = slopes_.k();
    const Slopes Phi_dk = Phi * slopes_.dk();
    const SparseTransition<N> sparse = model_.sparse;
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
      next = sparse.left(da);
      for (Eigen::Index i = 0; i < count_; ++i) {
        next.col(i) += Phi_k * de(i) + Phi_dk.col(i) * e;
        if (!slopes_.dPhi(i).empty()) next.col(i) += slopes_.dPhi(i).left(a_upd);
      }
      da.swap(next);
      a = sparse.left(a_upd);
    }
    a_ = a;
    da_ = da;
    const double S = slopes_.S();
    const Eigen::VectorXd& dS = slopes_.dS();
    const auto n = static_cast<double>(values.size());
    sums_.log_likelihood -= 0.5 * (n * std::log(S) + ee / S);
    sums_.gradient -= 0.5 / S * ((n - ee / S) * dS + 2.0 * e_de.transpose());
    sums_.information += Square(de_de.template selfadjointView<Eigen::Lower>()) / S + 0.5 * n / (S * S) * dS * dS.transpose();
  }

  Model model_;
  GainSlopes<N> slopes_;
  Eigen::Index count_;
  MeanColumns<N> columns_;
  Slopes da_;
  typename Model::Vector a_ = Model::Vector::Zero();
  ScoreSums sums_;
};

}  // namespace

ScoreSums score_pass(const SampleBlock& block, const std::vector<SampleBlock>& derivatives, const StaticSignal& signal,
                     const MeanCurve& mean) {
  return with_size(block.h.size(), [&](auto size) { return ScorePass<size()>(block, derivatives).run(signal, mean); });
}

}  // namespace coast::noise
