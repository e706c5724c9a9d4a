#pragma once
// Sections of an inspection, from what the readers found. Private to the job.

#include "coast/io/contents.hpp"
#include "coast/jobs/inspect.hpp"

namespace coast::jobs {

[[nodiscard]] InspectResult::Section messages_section(const std::vector<io::MessageCount>& messages);
[[nodiscard]] InspectResult::Section observations_section(const record::ObservationRecording& recording);
[[nodiscard]] InspectResult::Section navigation_section(const record::NavigationRecording& recording);
[[nodiscard]] InspectResult::Section trajectory_section(const record::Trajectory& trajectory);
[[nodiscard]] InspectResult::Section marks_section(const record::TimeMarkRecording& recording);

}  // namespace coast::jobs
