#pragma once

#include <optional>
#include <vector>

#include "coast/estimate/forward_filter.hpp"
#include "coast/record/trajectory.hpp"

namespace coast::jobs {

/// The fix that supports an epoch of the solution: the nearest one used by the filter, if close enough.
class GnssCourse {
 public:
  explicit GnssCourse(const estimate::Mission& mission);
  /// A measurement of the filter, in time order.
  void add(const estimate::Measurement& measurement, bool used);
  /// For tight coupling, which uses observations and reports no fixes: all fixes except the withheld ones.
  void add_all_but(const std::vector<estimate::Withheld>& withheld);
  /// @return none if farther than 1.5 usual fix intervals, or 2 s, from every fix used so far
  [[nodiscard]] std::optional<record::GnssSupport> at(geo::GpsTime t) const;

 private:
  [[nodiscard]] geo::GpsTime time_of(std::size_t fix) const;

  const estimate::Mission& mission_;
  double reach_s_ = 0.0;
  std::vector<std::size_t> used_;  ///< ascending
};

}  // namespace coast::jobs
