#pragma once
// The covariance recursion of the filter and its derivatives, step by step until both are stationary. Private to the room.

#include <optional>
#include <vector>

#include "gain_increments.hpp"
#include "riccati_slopes.hpp"

namespace coast::noise {

/// By increments of low rank up to the first hole, if the start allows it; else by the Riccati recursion.
template <int N>
class GainSlopes {
 public:
  using Model = FixedModel<N>;
  using Vector = typename Model::Vector;
  using Slopes = Eigen::Matrix<double, N, Eigen::Dynamic, 0, N, kMostParameters>;

  /// @param model  must outlive this
  GainSlopes(const Model& model, const std::vector<SampleBlock>& derivatives)
      : model_(model), slopes_(derivatives.begin(), derivatives.end()) {
    if (GainIncrements<N>::apply_to(model))
      increments_.emplace(model, slopes_);
    else
      riccati_.emplace(model, slopes_);
  }
  GainSlopes(const GainSlopes&) = delete;
  GainSlopes& operator=(const GainSlopes&) = delete;
  GainSlopes(GainSlopes&&) = delete;
  GainSlopes& operator=(GainSlopes&&) = delete;
  ~GainSlopes() = default;

  [[nodiscard]] Eigen::Index count() const { return static_cast<Eigen::Index>(slopes_.size()); }
  [[nodiscard]] const SparseTransition<N>& dPhi(Eigen::Index i) const { return slopes_[static_cast<std::size_t>(i)].sparse; }
  [[nodiscard]] double S() const { return riccati_ ? riccati_->gain.S : increments_->S; }
  [[nodiscard]] const Vector& k() const { return riccati_ ? riccati_->gain.k : increments_->k; }
  [[nodiscard]] const Slopes& dk() const { return riccati_ ? riccati_->dk : increments_->dk; }
  [[nodiscard]] const Eigen::VectorXd& dS() const { return riccati_ ? riccati_->dS : increments_->dS; }
  [[nodiscard]] bool steady() const { return riccati_ ? riccati_->steady() : increments_->steady(); }

  void step() {
    ++steps_;
    riccati_ ? riccati_->step() : increments_->step();
  }
  /// A hole needs P itself, which the increments do not keep.
  void skip() {
    if (!riccati_) {
      riccati_.emplace(model_, slopes_);
      for (std::uint64_t i = 0; i < steps_ && !riccati_->steady(); ++i) riccati_->step();
    }
    riccati_->skip();
  }

 private:
  const Model& model_;
  std::vector<Model> slopes_;
  std::optional<GainIncrements<N>> increments_;
  std::optional<RiccatiSlopes<N>> riccati_;
  std::uint64_t steps_ = 0;
};

}  // namespace coast::noise
