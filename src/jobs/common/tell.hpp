#pragma once
// Messages for a job's events.

#include "coast/jobs/job.hpp"
#include "coast/record/event.hpp"

namespace coast::jobs {

/// Reports the warnings among the events.
void tell_warnings(const record::Events& events, const Progress& progress);

}  // namespace coast::jobs
