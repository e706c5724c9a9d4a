#pragma once
// What `coast diagnose` leaves: diagnosis.json, run.diagnosed.yaml, the page, and the lines for the terminal.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coast/diagnose/diagnosis.hpp"
#include "coast/report/page.hpp"

namespace coast::cli {

/// What the search finds in the user's own simulation.
struct SimulationCheck {
  std::string source;
  diagnose::Diagnosis diagnosis;
  std::string of_another_drive = {};  ///< why its figures say little of the recording; empty where it is of the same drive
  /// Whether the simulation has an effect too, of about that size.
  [[nodiscard]] bool has(const diagnose::Finding& finding) const;
};

/// Schema coast.diagnosis/1 (docs/schema/diagnosis.schema.json). Effects by what they explain, most first.
[[nodiscard]] std::string diagnosis_json(const diagnose::Diagnosis& diagnosis, const diagnose::MissionInput& input,
                                         const std::optional<SimulationCheck>& simulation);
[[nodiscard]] std::string diagnosis_text(const diagnose::Diagnosis& diagnosis,
                                         const std::optional<SimulationCheck>& simulation);
/// The run's own configuration with what was found: by its key what has one, `effects` of the rest, the GNSS noise, and the
/// error model of that name where it has changed. @param resolved  run.resolved.yaml
[[nodiscard]] std::string diagnosed_yaml(const std::string& resolved, const diagnose::Diagnosis& diagnosis,
                                         const std::string& error_model);
/// The keys of the run file that state findings: lever arm, time offset.
[[nodiscard]] std::vector<diagnose::RunKey> keys_found(const diagnose::Diagnosis& diagnosis);
/// Why all that was found is no better than nothing: the recording is no likelier with it, or outages drift farther. Empty
/// where it is better, and where nothing was found.
[[nodiscard]] std::string why_not_accepted(const diagnose::Diagnosis& diagnosis);
/// Why an effect that was found is not among the findings.
[[nodiscard]] std::string_view why_rejected(diagnose::Rejected::Reason reason);
/// Whether an error model with what was found differs from the configured one.
[[nodiscard]] bool changes_error_model(const diagnose::Diagnosis& diagnosis);
[[nodiscard]] report::Page diagnosis_page(const std::string& title, const diagnose::Diagnosis& diagnosis,
                                          const std::string& diagnosed_yaml, const std::optional<SimulationCheck>& simulation);
/// The section that sets the recording among its twins.
[[nodiscard]] report::Section twin_section(const diagnose::Diagnosis& diagnosis,
                                           const std::optional<SimulationCheck>& simulation);
/// Name and axis; of noise, the sensor too.
[[nodiscard]] std::string full_name(const diagnose::Hypothesis& hypothesis);
[[nodiscard]] std::string full_name(const diagnose::NoiseFinding& finding);
/// A sentence that says whether the user's own simulation has it; empty where there is none.
[[nodiscard]] std::string_view in_simulation(const diagnose::Finding& finding,
                                             const std::optional<SimulationCheck>& simulation);
/// What was found, how large and what else it could be, in a paragraph.
[[nodiscard]] std::string explanation(const diagnose::Finding& finding);
[[nodiscard]] std::string explanation(const diagnose::NoiseFinding& finding);

}  // namespace coast::cli
