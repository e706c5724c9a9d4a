#pragma once
// The unknowns of a baseline with names, since satellites come and go. Private to the room.

#include <Eigen/Core>
#include <compare>
#include <vector>

#include "coast/record/satellite.hpp"

namespace coast::carrier {

struct Unknown {
  enum class Kind : std::uint8_t { kPosition, kZenithDelay, kIonosphere, kAmbiguity };
  Kind kind = Kind::kPosition;
  record::Satellite satellite;
  char band = '0';
  int arc = 0;  ///< of ambiguities

  auto operator<=>(const Unknown&) const = default;
};

/// Mean and covariance of a changing set of unknowns. The first three are the position.
class RelativeState {
 public:
  RelativeState();

  Eigen::VectorXd x;
  Eigen::MatrixXd P;

  [[nodiscard]] Eigen::Index size() const { return x.size(); }
  [[nodiscard]] const std::vector<Unknown>& unknowns() const { return unknowns_; }
  /// -1 where it is not there.
  [[nodiscard]] Eigen::Index index(const Unknown& unknown) const;
  Eigen::Index add(const Unknown& unknown, double value, double variance);
  /// What has been learnt of it is forgotten.
  void reset(Eigen::Index i, double value, double variance);
  template <class Predicate>
  void remove_if(const Predicate& gone) {
    std::vector<Eigen::Index> kept;
    for (Eigen::Index i = 0; i < size(); ++i)
      if (!gone(unknowns_[static_cast<std::size_t>(i)])) kept.push_back(i);
    keep(kept);
  }

 private:
  void keep(const std::vector<Eigen::Index>& kept);
  std::vector<Unknown> unknowns_;
};

}  // namespace coast::carrier
