#pragma once
// The named unknowns of a baseline; their set changes as satellites rise and set.

#include <Eigen/Core>
#include <array>
#include <compare>
#include <optional>
#include <vector>

#include "coast/record/satellite.hpp"

namespace coast::carrier {

struct Unknown {
  enum class Kind : std::uint8_t { kPosition, kVelocity, kZenithDelay, kInterFrequencyBias, kIonosphere, kAmbiguity };
  Kind kind = Kind::kPosition;
  record::Satellite satellite;
  char band = '0';  ///< of ambiguities and GLONASS's inter-frequency biases; x, y or z of the velocity
  int arc = 0;      ///< of ambiguities

  auto operator<=>(const Unknown&) const = default;
};

/// ECEF components, in the order that a state must have them.
inline constexpr std::array kVelocityUnknowns{Unknown{Unknown::Kind::kVelocity, {}, 'x', 0},
                                              Unknown{Unknown::Kind::kVelocity, {}, 'y', 0},
                                              Unknown{Unknown::Kind::kVelocity, {}, 'z', 0}};

/// Change of one unknown: x <- factor x + value, variance <- factor^2 variance + added. With factor 0 its previous estimate is
/// discarded.
struct StateChange {
  Unknown unknown;
  double factor = 1.0;
  double value = 0.0;
  double added = 0.0;
  bool gone = false;  ///< it is removed
};

/// Mean and covariance of a changing set of unknowns. The first three are the position, ECEF, m; ambiguities are in cycles,
/// delays in m, inter-frequency biases in m per GLONASS channel number, velocities in m/s.
class RelativeState {
 public:
  RelativeState();
  /// @param named  the unknowns after the position, in order
  RelativeState(const std::vector<Unknown>& named, Eigen::VectorXd mean, Eigen::MatrixXd covariance);

  Eigen::VectorXd x;
  Eigen::MatrixXd P;
  std::optional<Eigen::Matrix3d> C_b_e;  ///< attitude of the antenna, if known

  [[nodiscard]] Eigen::Index size() const { return x.size(); }
  [[nodiscard]] const std::vector<Unknown>& unknowns() const { return unknowns_; }
  /// -1 if not present.
  [[nodiscard]] Eigen::Index index(const Unknown& unknown) const;
  Eigen::Index add(const Unknown& unknown, double value, double variance);
  /// Discards its previous estimate.
  void reset(Eigen::Index i, double value, double variance);
  /// x <- factor x, with driving noise.
  void evolve(Eigen::Index i, double factor, double added);
  template <class Predicate>
  void remove_if(const Predicate& gone) {
    std::vector<Eigen::Index> kept;
    for (Eigen::Index i = 0; i < size(); ++i)
      if (!gone(unknowns_[static_cast<std::size_t>(i)])) kept.push_back(i);
    keep(kept);
  }
  /// Changes of named unknowns, in order, since the last call, so that a filter with its own copy can follow.
  [[nodiscard]] std::vector<StateChange> take_changes();

 private:
  void keep(const std::vector<Eigen::Index>& kept);
  void note(Eigen::Index i, double factor, double value, double added);
  std::vector<Unknown> unknowns_;
  std::vector<StateChange> changes_;
};

}  // namespace coast::carrier
