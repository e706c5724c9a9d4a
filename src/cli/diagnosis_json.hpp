#pragma once
// What `coast diagnose` leaves: diagnosis.json, run.diagnosed.yaml, the page, and the lines for the terminal.

#include <string>

#include "coast/diagnose/diagnosis.hpp"
#include "coast/report/page.hpp"

namespace coast::cli {

/// Schema coast.diagnosis/1.
[[nodiscard]] std::string diagnosis_json(const diagnose::Diagnosis& diagnosis, const diagnose::MissionInput& input);
[[nodiscard]] std::string diagnosis_text(const diagnose::Diagnosis& diagnosis);
/// The run's own configuration with what was found under `effects`, in place of those that stood there.
/// @param resolved  run.resolved.yaml
[[nodiscard]] std::string diagnosed_yaml(const std::string& resolved, const diagnose::Diagnosis& diagnosis);
[[nodiscard]] report::Page diagnosis_page(const std::string& title, const diagnose::Diagnosis& diagnosis,
                                          const std::string& diagnosed_yaml);
/// What was found, how large and what else it could be, in a paragraph.
[[nodiscard]] std::string explanation(const diagnose::Finding& finding);

}  // namespace coast::cli
