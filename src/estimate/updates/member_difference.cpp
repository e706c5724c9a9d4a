#include <cmath>
#include <limits>

#include "coast/estimate/update.hpp"

namespace coast::estimate {

namespace {

using Means = record::MemberBlocks::Means;

const Eigen::Vector3d& mean_of(const Means& means, noise::Sensor sensor) {
  return sensor == noise::Sensor::kGyro ? means.gyro : means.accel;
}

/// Mean of some members on each axis, weighted by their white noise, and the weight of each one in it.
class WeightedMean {
 public:
  WeightedMean(const StateLayout& layout, const record::MemberBlocks::Block& block, noise::Sensor sensor)
      : layout_(layout),
        sensor_(sensor),
        seconds_(block.to - block.from),
        share_(Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(block.means.size()))) {}

  /// Variance of the white noise of a member's mean over the block.
  [[nodiscard]] Eigen::Vector3d variance_of(std::size_t member) const {
    const StateLayout::Member& m = layout_.members()[member];
    return (sensor_ == noise::Sensor::kGyro ? m.gyro_density : m.accel_density) / seconds_;
  }
  void add(std::size_t member, const Means& means) {
    const Eigen::Vector3d information = variance_of(member).cwiseInverse();
    const Eigen::Vector3d before = information_;
    information_ += information;
    share_.array().colwise() *= before.cwiseQuotient(information_).array();
    share_.col(static_cast<Eigen::Index>(member)) = information.cwiseQuotient(information_);
    value_ = (before.cwiseProduct(value_) + information.cwiseProduct(mean_of(means, sensor_))).cwiseQuotient(information_);
  }
  [[nodiscard]] bool is_empty() const { return information_.isZero(0.0); }
  [[nodiscard]] const Eigen::Vector3d& value() const { return value_; }
  [[nodiscard]] Eigen::Vector3d variance() const { return information_.cwiseInverse(); }
  [[nodiscard]] const Eigen::Matrix3Xd& share() const { return share_; }

 private:
  const StateLayout& layout_;
  noise::Sensor sensor_;
  double seconds_;
  Eigen::Vector3d information_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d value_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3Xd share_;  ///< 3 x members
};

}  // namespace

// z = mean_j - weighted mean of those before j = (e_j + n_j) - sum_i share_i (e_i + n_i), e = H x. Weights are 1/N_i, the
// inverse of the white noise; a sum with such weights has the same covariance with each of its parts, so a difference is
// uncorrelated with the mean that includes j, with every other difference, and with the sum of all that the strapdown
// integrates.
std::optional<Linearised> member_difference(const FilterState& state, const StateLayout& layout,
                                            const record::MemberBlocks::Block& block, noise::Sensor sensor, std::size_t j) {
  if (!block.means[j]) return std::nullopt;
  WeightedMean before(layout, block, sensor);
  for (std::size_t i = 0; i < j; ++i)
    if (block.means[i]) before.add(i, *block.means[i]);
  if (before.is_empty()) return std::nullopt;
  const Eigen::Vector3d signal = before.value();  // input of scale factors
  Linearised m;
  m.kind = UpdateKind::kMemberDifference;
  m.H = Eigen::MatrixXd::Zero(3, layout.size());
  for (const StateLayout::SensorBlock& b : layout.sensors()) {
    if (b.sensor != sensor || !b.member || *b.member > j || !block.means[*b.member]) continue;
    const double part = *b.member == j ? 1.0 : -before.share()(b.axis, static_cast<Eigen::Index>(*b.member));
    m.H.block(b.axis, b.offset, 1, b.size) = part * (b.signal_axis ? signal(*b.signal_axis) : 1.0) * b.own_output;
  }
  m.nu = mean_of(*block.means[j], sensor) - before.value() - m.H * state.x;
  m.R = (before.variance_of(j) + before.variance()).asDiagonal();
  return m;
}

}  // namespace coast::estimate
