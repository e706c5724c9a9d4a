// Section: input, alignment of the mission, repaired, rejected and doubtful data.

#include <fmt/format.h>

#include "process/page/parts.hpp"

namespace coast::jobs {

namespace {

report::Table recording_table(const ProcessPage& page) {
  const ProcessResult& r = page.result;
  report::Table table;
  table.id = "recording";
  table.title = "Recording";
  table.columns = {{"quantity", "", false}, {"value", "", false}};
  const double span = r.end - r.start;
  table.rows = {cells({"start", geo::to_string(r.start)}),
                cells({"end", geo::to_string(r.end)}),
                cells({"span", fmt::format("{:.1f} s", span)}),
                cells({"IMU samples", fmt::format("{}", r.imu_samples)}),
                cells({"IMU rate", fmt::format("{} Hz", number(r.imu_rate_hz, 4))}),
                cells({"IMU gaps", fmt::format("{}", r.imu_gaps)}),
                cells({"GNSS epochs", fmt::format("{} ({} used, {} refused, {} withheld)", r.gnss_epochs, r.gnss_used,
                                                  r.gnss_rejected, withheld_fixes(page).size())})};
  table.rows[5][1].verdict = r.imu_gaps == 0 ? report::Verdict::kGood : report::Verdict::kWarn;
  return table;
}

}  // namespace

report::Section input_section(const ProcessPage& page) {
  report::Section section;
  section.id = "input";
  section.title = "What was read";
  section.lead = "The recording as it was understood, before anything was computed from it.";
  if (!page.result.inspection.empty()) {
    report::Table table;
    table.id = "inspection";
    table.columns = {{"what was understood", "", false}};
    for (const std::string& sentence : page.result.inspection) table.rows.push_back(cells({sentence}));
    section.tables.push_back(std::move(table));
  }
  if (!page.result.alignment.empty()) section.notes.push_back({report::Note::Kind::kInfo, "Start", page.result.alignment});
  section.tables.push_back(recording_table(page));
  if (!page.result.events.empty()) section.tables.push_back(event_table(page.result.events));
  return section;
}

}  // namespace coast::jobs
