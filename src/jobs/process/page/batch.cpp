// Section: batch solution of the whole mission: its unknowns, their observability, and convergence.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "process/page/parts.hpp"
#include "process/page/state_words.hpp"

namespace coast::jobs {

namespace {

using estimate::MissionUnknown;
using estimate::Observability;

report::Verdict verdict_of(Observability observability) {
  switch (observability) {
    case Observability::kSeen:
      return report::Verdict::kGood;
    case Observability::kWeaklySeen:
      return report::Verdict::kNone;
    case Observability::kTogether:
    case Observability::kNotSeen:
      return report::Verdict::kWarn;
  }
  return report::Verdict::kNone;
}

std::string in_words(const std::string& state) {
  const StateWords words = words_of(state);
  return words.component.empty() ? words.what : fmt::format("{} {}", words.what, words.component);
}

std::string in_words(const MissionUnknown& unknown) {
  const Observability seen = unknown.observability();
  return seen == Observability::kTogether ? "seen only together with " + in_words(unknown.with)
                                          : std::string(estimate::name(seen));
}

report::Table unknown_table(const std::vector<MissionUnknown>& unknowns) {
  report::Table table;
  table.id = "mission-unknowns";
  table.title = "Unknowns of the whole mission";
  table.caption = fmt::format(
      "Estimated minus configured, or measured minus true. Seen: the sigma behind all measurements is at most {:g} of the one "
      "before; weakly: at most {:g}; above, the estimate is what was stated beforehand. Correlations of more than {:g}: the "
      "mission shows the sum of both, and each as far as the other is known beforehand. Position, velocity, attitude and what "
      "changes over time are taken in the middle of the mission.",
      estimate::kSeenRatio, estimate::kWeaklySeenRatio, estimate::kTogetherCorrelation);
  table.columns = {{"unknown", "", false}, {"component", "", false}, {"estimate", ""},
                   {"sigma", ""},          {"sigma before", ""},     {"ratio", ""},
                   {"unit", "", false},    {"verdict", "", false},   {"most correlated with", "", false},
                   {"correlation", ""}};
  for (const MissionUnknown& unknown : unknowns) {
    const StateWords words = words_of(unknown.name);
    const geo::Unit* unit = unit_for(words.units, std::max(std::abs(unknown.estimate), unknown.posterior_sd));
    const double to_si = unit != nullptr ? unit->to_si : 1.0;
    table.rows.push_back(
        cells({words.what, words.component, number(unknown.estimate / to_si), number(unknown.posterior_sd / to_si, 2),
               number(unknown.prior_sd / to_si, 2), number(unknown.ratio(), 2), unit != nullptr ? std::string(unit->name) : "",
               in_words(unknown), in_words(unknown.with), decimals(unknown.correlation, 3)}));
    table.rows.back()[7].verdict = verdict_of(unknown.observability());
  }
  return table;
}

report::Table solution_table(const estimate::BatchReport& batch) {
  report::Table table;
  table.id = "batch-solution";
  table.title = "Solution";
  table.caption =
      "The condition number is that of the normal equations, scaled; it grows as the IMU gets quieter. Rounding takes about "
      "4e-17 "
      "times as much from the solution, in sigmas.";
  table.columns = {{"figure", "", false}, {"value", ""}};
  table.rows = {cells({"iterations", fmt::format("{}", batch.cost.size())}),
                cells({"come to rest", batch.converged ? "yes" : "no"}),
                cells({"twice the negative log density, first", number(batch.cost.front(), 6)}),
                cells({"last", number(batch.cost.back(), 6)}),
                cells({"condition number", fmt::format("{:.1e}", batch.condition)}),
                cells({"off by rounding, in sigmas", fmt::format("{:.1e}", batch.rounding())})};
  if (!batch.converged) table.rows[1][1].verdict = report::Verdict::kBad;
  return table;
}

}  // namespace

std::optional<report::Section> batch_section(const ProcessPage& page) {
  if (!page.result.batch) return std::nullopt;
  report::Section section;
  section.id = "batch";
  section.title = "Batch";
  section.lead =
      "One adjustment of the whole mission: every state that does not change is one unknown, known by all measurements.";
  if (!page.result.batch->unknowns.empty()) section.tables.push_back(unknown_table(page.result.batch->unknowns));
  section.tables.push_back(solution_table(*page.result.batch));
  for (const record::Event& event : page.result.events)
    if (event.kind == "base_offset_not_seen") section.notes.push_back({report::Note::Kind::kWarning, "", event.text});
  return section;
}

}  // namespace coast::jobs
