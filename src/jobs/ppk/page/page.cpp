#include "ppk/page/page.hpp"

#include <fmt/format.h>

#include "coast/report/panels.hpp"
#include "common/page_parts.hpp"

namespace coast::jobs {

namespace {

using report::Verdict;

report::Tile fix_tile(const PpkSummary& s) {
  constexpr double kGood = 0.95, kUsable = 0.5;
  report::Tile tile;
  tile.label = "Fixed";
  tile.value = percent(s.fix_rate());
  tile.unit = "%";
  tile.verdict = s.fix_rate() >= kGood ? Verdict::kGood : s.fix_rate() >= kUsable ? Verdict::kWarn : Verdict::kBad;
  tile.explanation = "Epochs with integer ambiguities, of those that the rover should have recorded.";
  tile.section = "quality";
  const auto all = static_cast<double>(s.expected);
  const auto share = [&](record::FixQuality quality, std::size_t n) {
    if (n > 0) tile.shares.push_back({report::name_of(quality), static_cast<double>(n) / all, report::tone_of(quality)});
  };
  share(record::FixQuality::kFixed, s.fixed);
  share(record::FixQuality::kFloat, s.floats);
  share(record::FixQuality::kSingle, s.single);
  return tile;
}

report::Tile separation_tile(const PpkSummary& s) {
  constexpr double kGood = 0.05;
  report::Tile tile;
  tile.label = "Forward less backward, 95 %";
  tile.value = number(100.0 * s.separation.p95);
  tile.unit = "cm";
  tile.verdict = s.separation.far == 0 && s.separation.p95 < kGood ? Verdict::kGood : Verdict::kWarn;
  tile.explanation =
      "Both ways through the recording know the integers that most epochs of an arc agree on, and find the others by "
      "themselves: centimetres where both are right.";
  tile.section = "separation";
  return tile;
}

std::vector<report::Tile> tiles(const PpkResult& result) {
  const PpkSummary s = summary_of(result);
  std::vector<report::Tile> all{fix_tile(s)};
  if (s.fixed > 0) {
    report::Tile& sd = all.emplace_back();
    sd.label = "Sigma of fixes N / E / D";
    sd.value = triple(1000.0 * s.fixed_sd_n);
    sd.unit = "mm";
    sd.explanation = "Medians, as the phases' residuals let it be expected.";
    sd.section = "quality-sigma";
  }
  if (s.separation.epochs > 0) all.push_back(separation_tile(s));
  report::Tile& baseline = all.emplace_back();
  baseline.label = "Baseline";
  baseline.value = number(s.baseline_m / 1000.0);
  baseline.unit = "km";
  baseline.explanation = "Median distance from the base.";
  report::Tile& left_out = all.emplace_back();
  left_out.label = "Observations left out";
  const auto observations = static_cast<double>(s.left_out + s.used);
  left_out.value = percent(observations > 0.0 ? static_cast<double>(s.left_out) / observations : 0.0);
  left_out.unit = "%";
  left_out.explanation = "Phases and codes that contradict the others of their epoch.";
  left_out.section = "residuals";
  report::Tile& noise = all.emplace_back();
  noise.label = "Noise phase / code";
  noise.value = fmt::format("{} / {}", number(result.solution.noise.phase), number(result.solution.noise.code));
  noise.explanation =
      "Of phases and codes over that of a geodetic receiver in the open, as the "
      "residuals have it.";
  noise.section = "residuals";
  return all;
}

report::Section input_section(const PpkConfig& config, const PpkResult& result) {
  report::Section section;
  section.id = "input";
  section.title = "What was read";
  report::Table& table = section.tables.emplace_back();
  table.id = "recordings";
  table.columns = {{"quantity", "", false}, {"value", "", false}};
  const std::vector<carrier::PpkEpoch>& epochs = result.solution.epochs;
  table.rows = {cells({"rover", fmt::format("{}: {}", config.rover.filename().string(), result.rover)}),
                cells({"base", fmt::format("{}: {}", config.base.filename().string(), result.base)}),
                cells({"base's antenna, ECEF", fmt::format("{:.4f}, {:.4f}, {:.4f} m: {}", result.r_base_e.x(),
                                                           result.r_base_e.y(), result.r_base_e.z(), result.base_from)}),
                cells({"signals", signals_in_words(result.solution.signals)}),
                cells({"from", geo::to_string(epochs.front().shown)}),
                cells({"to", geo::to_string(epochs.back().shown)}),
                cells({"interval", fmt::format("{} s", number(result.solution.interval_s))})};
  if (!result.events.empty()) section.tables.push_back(event_table(result.events));
  return section;
}

}  // namespace

double seconds(const PpkResult& result, const carrier::PpkEpoch& epoch) {
  return epoch.t - result.solution.epochs.front().t;
}

report::Page ppk_page(const PpkConfig& config, const PpkResult& result) {
  report::Page page;
  page.title = config.rover.filename().string();
  page.subtitle = "Carrier-phase positions against " + config.base.filename().string();
  page.start = result.solution.epochs.front().t;
  page.tiles = tiles(result);
  page.sections = {ppk_position_section(result), ppk_quality_section(result), ppk_satellite_section(result),
                   ppk_residual_section(result), input_section(config, result)};
  page.sections.back().notes.push_back({report::Note::Kind::kCode, "ppk.resolved.yaml", config.map.resolved_yaml()});
  page.footer = fmt::format("coast {}, coast ppk", COAST_VERSION);
  return page;
}

}  // namespace coast::jobs
