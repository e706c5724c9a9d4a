#pragma once

#include <string>

#include "process_result.hpp"

namespace coast::cli {

/// summary.json by schema coast.summary/1. What is absent is left out.
[[nodiscard]] std::string summary_json(const ProcessResult& result);
/// innovations.csv: a line each, N, E, D (others as estimate::InnovationRecord has them), what was used and what was refused.
[[nodiscard]] std::string innovations_csv(const std::vector<estimate::InnovationRecord>& innovations);
/// The few lines that end a run on the terminal.
[[nodiscard]] std::string summary_text(const ProcessResult& result);
/// "without GNSS", "with 3 satellites"
[[nodiscard]] std::string gnss_left(const study::Outage& outage);

}  // namespace coast::cli
