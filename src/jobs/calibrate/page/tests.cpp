// Records not used for the estimate, compared with it.

#include <fmt/format.h>

#include <array>

#include "calibrate/page/parts.hpp"
#include "calibrate/units.hpp"
#include "coast/report/panels.hpp"
#include "common/page_parts.hpp"

namespace coast::jobs {

std::optional<report::Table> tests_table(const CalibratedAxis& axis) {
  if (axis.tests.empty()) return {};
  report::Table table;
  table.id = id_of(axis) + "-tests";
  table.title = "Held against other records";
  table.caption =
      "Only level and drift were fitted to them. Variance: of the standardised innovations, 1 where the estimate holds. "
      "Whiteness: p of the portmanteau test. Log-likelihood: a sample's, less that of the records estimated from.";
  table.columns = {
      {"record", "", false}, {"variance", ""}, {"whiteness, p", ""}, {"log-likelihood", ""}, {"Allan curve", "", false}};
  double samples = 0.0;
  for (const noise::StaticSignal& signal : axis.signals) samples += static_cast<double>(signal.values.size());
  const double own = axis.result.best().fit.log_likelihood / samples;
  for (const TestedRecord& tested : axis.tests) {
    std::vector<report::Cell> row = cells({record_name(tested.source), fmt::format("{:.3f}", tested.test.innovation_variance),
                                           fmt::format("{:.2g}", tested.test.whiteness.p_value),
                                           fmt::format("{:+.4f}", tested.test.log_likelihood_per_sample - own)});
    const noise::CurveBand& band = tested.test.band;
    row.push_back({band.tau.empty() ? "no band"
                   : band.inside    ? "inside"
                                    : "outside",
                   band.tau.empty() ? report::Verdict::kNone
                   : band.inside    ? report::Verdict::kGood
                                    : report::Verdict::kWarn});
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::optional<report::Panel> tests_panel(const CalibratedAxis& axis) {
  if (axis.tests.empty()) return {};
  constexpr std::array kTones{report::Tone::kForward, report::Tone::kSmoothed, report::Tone::kSbas, report::Tone::kSingle,
                              report::Tone::kPpp};
  const char* unit = sheet_units(axis.axis.sensor).signal;
  report::Panel panel;
  panel.id = id_of(axis) + "-tests-allan";
  panel.title = "Allan deviation of other records";
  panel.caption =
      "Records that nothing was estimated from, and the band that 95 of 100 realisations of the estimate, as long as the first "
      "of "
      "them, do not leave anywhere.";
  std::vector<const noise::AllanCurve*> curves;
  for (const TestedRecord& tested : axis.tests) curves.push_back(&tested.test.curve);
  report::Plot& plot = panel.plots.emplace_back(allan_plot(curves, unit));
  if (const noise::CurveBand& band = axis.tests.front().test.band; !band.tau.empty()) {
    report::Line& line = report::add_line(plot, "realisations, median", band_series(band, unit), report::Tone::kMuted);
    line.band_label = "95 % of all curves";
    line.width_px = 1.0;
  }
  for (std::size_t i = 0; i < axis.tests.size(); ++i)
    report::add_line(plot, record_name(axis.tests[i].source), allan_series(*curves[i], unit, false), kTones[i % kTones.size()])
        .width_px = 1.4;
  return panel;
}

}  // namespace coast::jobs
