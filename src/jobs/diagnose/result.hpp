#pragma once
// A diagnosis as text and page.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coast/jobs/diagnose.hpp"
#include "coast/report/page.hpp"

namespace coast::jobs {

/// Schema coast.diagnosis/1 (docs/schema/diagnosis.schema.json). Effects in decreasing order of their explained part.
[[nodiscard]] std::string diagnosis_json(const DiagnosisResult& result);
[[nodiscard]] std::string diagnosis_text(const DiagnosisResult& result);
/// What a quick diagnosis leaves out.
inline constexpr std::string_view kQuick =
    "Quick: one search, and no simulated twins. A likelier explanation that only another order of the search leads to, or that "
    "takes the place of one of these, is found without --quick.";
/// The run's own configuration with the findings: by their key if they have one, else as `effects`, the GNSS noise, and the
/// name of the error model if it has changed. @param resolved  run.resolved.yaml
[[nodiscard]] std::string diagnosed_yaml(const std::string& resolved, const diagnose::Diagnosis& diagnosis,
                                         const std::string& error_model);
/// Only those lines of it that differ from the configuration.
[[nodiscard]] std::string changed_lines(const diagnose::Diagnosis& diagnosis, const std::string& error_model);
/// The keys of the run file for findings: lever arm, time offset.
[[nodiscard]] std::vector<diagnose::RunKey> keys_found(const diagnose::Diagnosis& diagnosis);
/// Why the findings are no improvement: the recording is no likelier with them, or outages drift farther. Empty
/// if they are an improvement, or if there are none.
[[nodiscard]] std::string why_not_accepted(const diagnose::Diagnosis& diagnosis);
/// Why a detected effect is not among the findings.
[[nodiscard]] std::string_view why_rejected(diagnose::Rejected::Reason reason);
/// Whether the error model with the findings differs from the configured one.
[[nodiscard]] bool changes_error_model(const diagnose::Diagnosis& diagnosis);
/// @param changed  changed_lines()
[[nodiscard]] report::Page diagnosis_page(const std::string& title, const DiagnosisResult& result,
                                          const std::string& diagnosed_yaml, const std::string& changed);
/// The section that compares the recording with its twins.
[[nodiscard]] report::Section twin_section(const diagnose::Diagnosis& diagnosis,
                                           const std::optional<SimulationCheck>& simulation);
/// Name and axis; for noise, the sensor too.
[[nodiscard]] std::string full_name(const diagnose::Finding& finding);
[[nodiscard]] std::string full_name(const diagnose::NoiseFinding& finding);
/// A sentence on whether the user's own simulation has the finding; empty without simulation.
[[nodiscard]] std::string_view in_simulation(const diagnose::Finding& finding,
                                             const std::optional<SimulationCheck>& simulation);
/// The finding, its size and its alternatives, in a paragraph.
[[nodiscard]] std::string explanation(const diagnose::Finding& finding);
[[nodiscard]] std::string explanation(const diagnose::NoiseFinding& finding);

}  // namespace coast::jobs
