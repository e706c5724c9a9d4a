#pragma once

#include <optional>
#include <vector>

#include "coast/estimate/forward_filter.hpp"
#include "coast/record/trajectory.hpp"

namespace coast::cli {

/// Which fix an epoch of the solution rests on: the nearest one that the filter has used, if there is one at hand.
class GnssCourse {
 public:
  explicit GnssCourse(const estimate::Mission& mission);
  /// A measurement of the filter, in the order of time.
  void add(const estimate::Measurement& measurement, bool used);
  /// Of tight coupling, which uses observations and tells of no fixes: all fixes but those that are withheld.
  void add_all_but(const std::vector<estimate::Withheld>& withheld);
  /// @return nothing farther than one and a half usual intervals of the fixes, or 2 s, from every fix used so far
  [[nodiscard]] std::optional<record::GnssSupport> at(geo::GpsTime t) const;

 private:
  [[nodiscard]] geo::GpsTime time_of(std::size_t fix) const;

  const estimate::Mission& mission_;
  double reach_s_ = 0.0;
  std::vector<std::size_t> used_;  ///< ascending
};

}  // namespace coast::cli
