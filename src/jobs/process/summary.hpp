#pragma once

#include <string>

#include "coast/jobs/process.hpp"

namespace coast::jobs {

/// summary.json by schema coast.summary/1. Absent values are omitted.
[[nodiscard]] std::string summary_json(const ProcessResult& result);
[[nodiscard]] NisSummary nis_of(const std::vector<estimate::InnovationRecord>& innovations);
/// innovations.csv: one line each, N, E, D (others as in estimate::InnovationRecord), used and rejected ones.
[[nodiscard]] std::string innovations_csv(const ProcessResult& result);
/// The lines at the end of a run on the terminal.
[[nodiscard]] std::string summary_text(const ProcessResult& result);
/// "without GNSS", "with 3 satellites"
[[nodiscard]] std::string gnss_left(const study::Outage& outage);

}  // namespace coast::jobs
