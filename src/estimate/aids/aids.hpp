#pragma once
// The kinds of aids, and what several of them share; private to the room.

#include "../antenna.hpp"
#include "coast/estimate/aid.hpp"

namespace coast::estimate {

[[nodiscard]] AidKind odometer_kind();
[[nodiscard]] AidKind heading_kind();
[[nodiscard]] AidKind baseline_kind();
[[nodiscard]] AidKind attitude_kind();
[[nodiscard]] AidKind height_kind();
[[nodiscard]] AidKind position_kind();

/// Position of a point of the body and its derivative, e.
[[nodiscard]] AntennaPrediction point_position(const FilterState& state, const UpdateContext& context,
                                               const Eigen::Vector3d& point_b);

/// Rows with standard deviations: those of the file, or the stated ones where it has none.
/// @param unit  of values and standard deviations of the file in SI units
[[nodiscard]] std::vector<record::AidSample> with_sd(const record::AidRecording& rows, const Eigen::Vector3d& stated_sd,
                                                     double unit = 1.0);

/// At most one sample in each interval: neighbours have common errors, and each sample costs the filter an update.
[[nodiscard]] std::vector<record::AidSample> thinned(const std::vector<record::AidSample>& samples, double interval_s);

}  // namespace coast::estimate
