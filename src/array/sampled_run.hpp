#pragma once
// Stretches of a recording without gaps, with smoothed times. Private to the room.

#include <vector>

#include "coast/array/resample.hpp"

namespace coast::array {

/// Means of rates and specific forces over consecutive intervals.
struct SampledRun {
  std::vector<double> edges;  ///< s since the grid's start, increasing; one more than means
  Eigen::Matrix<double, kChannels, Eigen::Dynamic> means;

  [[nodiscard]] Eigen::Index size() const { return means.cols(); }
};

/// @throws std::invalid_argument  corrected times that do not increase
[[nodiscard]] std::vector<SampledRun> sampled_runs(const record::ImuRecording& recording, geo::GpsTime origin,
                                                   const LagOfTag& lag);

}  // namespace coast::array
