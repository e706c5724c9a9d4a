#pragma once
// diagnosis.json, and the lines for the terminal.

#include <string>

#include "coast/diagnose/diagnosis.hpp"

namespace coast::cli {

/// Schema coast.diagnosis/1.
[[nodiscard]] std::string diagnosis_json(const diagnose::Diagnosis& diagnosis, const diagnose::MissionInput& input);
[[nodiscard]] std::string diagnosis_text(const diagnose::Diagnosis& diagnosis);
/// What was found, how large and what else it could be, in a paragraph.
[[nodiscard]] std::string explanation(const diagnose::Finding& finding);

}  // namespace coast::cli
