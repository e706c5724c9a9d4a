#pragma once
// The page of `coast process`: all information needed to accept or reject a trajectory.

#include "coast/jobs/process.hpp"
#include "coast/report/page.hpp"

namespace coast::jobs {

/// Input of the page.
struct ProcessPage {
  const RunConfig& config;
  const ProcessResult& result;
};
[[nodiscard]] report::Page make_page(const ProcessPage& page);

}  // namespace coast::jobs
