#pragma once
// What the base's observations say about each satellite at any instant. Private to the room.

#include "receiver_track.hpp"

namespace coast::carrier {

/// Base observations of one satellite minus the model at the base's position.
struct BaseSatellite {
  record::Satellite satellite;
  double elevation = 0.0;
  std::vector<TrackedBand> bands;  ///< code and phase minus the model
};

struct BaseEpoch {
  geo::GpsTime t;
  Eigen::Vector3d r_e = Eigen::Vector3d::Zero();
  std::vector<BaseSatellite> satellites;
};

/// Observations minus the model at the base's position. A phase that is missing for a while at a base that stands goes on with
/// its arc where its residual, less the clock's, has not changed by a fraction of a cycle.
/// @param r_rover_e  approximate
std::vector<BaseEpoch> residuals_of(const std::vector<TrackedEpoch>& base, const BasePosition& position,
                                    const std::optional<Eigen::Vector3d>& r_rover_e, const DifferenceOptions& options);

/// The base's residuals at any instant, linearly between its epochs; before the first and after the last epoch of a base that
/// stands, for up to a minute, those of that epoch.
class BaseInterpolation {
 public:
  BaseInterpolation(std::vector<BaseEpoch> epochs, double longest_gap);

  /// Its epochs before and after an instant; the second with weight w, none if there is only one.
  struct Pair {
    const BaseEpoch* first = nullptr;
    const BaseEpoch* second = nullptr;
    double w = 0.0;
    double age = 0.0;
  };
  [[nodiscard]] Pair around(geo::GpsTime t) const;
  /// One satellite; without bands if it is missing.
  [[nodiscard]] static BaseSatellite satellite_at(const Pair& pair, record::Satellite satellite);

 private:
  std::vector<BaseEpoch> epochs_;
  double gap_;
  bool stands_ = false;
};

}  // namespace coast::carrier
