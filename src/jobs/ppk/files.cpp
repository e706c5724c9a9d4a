// Output files and messages of `coast ppk`.

#include <fmt/format.h>

#include "coast/geo/units.hpp"
#include "coast/io/results_folder.hpp"
#include "coast/io/writers.hpp"
#include "common/results.hpp"
#include "ppk/page/page.hpp"

namespace coast::jobs {

namespace {

bool base_moves(const PpkConfig& config) {
  return config.base_at.how == carrier::BaseAt::How::kMoving;
}

}  // namespace

std::vector<std::string> files_of(const PpkConfig& config) {
  std::vector<std::string> files{"ppk.pos", "ppk.json", "residuals.csv", "ppk.resolved.yaml", "report.json", "report.html"};
  if (base_moves(config)) files.emplace_back("baselines.csv");
  if (config.projection) files.emplace_back("ppk.grid.csv");
  return files;
}

void write(const PpkConfig& config, const PpkResult& result, const std::filesystem::path& folder) {
  const report::Page page = ppk_page(config, result);
  io::begin_results(folder / "ppk.json");
  io::write_gnss_pos(folder / "ppk.pos", result.fixes);
  io::write_text(folder / "residuals.csv", residuals_csv(result));
  if (config.projection) io::write_gnss_grid(folder / "ppk.grid.csv", result.fixes, *config.projection);
  if (base_moves(config)) io::write_text(folder / "baselines.csv", baselines_csv(result));
  io::write_text(folder / "ppk.resolved.yaml", config.map.resolved_yaml());
  write_page(page, folder);
  io::write_text(folder / "ppk.json", ppk_json(config, result));
}

std::string told(const PpkConfig& config, const PpkResult& result, const std::filesystem::path& folder) {
  std::string text;
  for (const std::string& sentence : ppk_sentences(result)) text += sentence + "\n";
  if (!result.fixes.fixes.empty()) text += fmt::format("positions: {}\n", (folder / "ppk.pos").string());
  if (config.projection && !result.fixes.fixes.empty())
    text += fmt::format("in {}: {}\n", config.projection->name(), (folder / "ppk.grid.csv").string());
  return text;
}

void require_positions(const PpkConfig& config, const PpkResult& result, const std::filesystem::path& folder) {
  if (!result.fixes.fixes.empty()) return;
  throw NumericalError(
      "no epoch with a position", "",
      fmt::format("fewer than four satellites above elevation_mask_deg: {:g} whose codes agree; {} shows "
                  "what was seen",
                  config.options.differences.elevation_mask / geo::kDegree, (folder / "report.html").string()));
}

}  // namespace coast::jobs
