#include <fmt/format.h>

#include "coast/geo/units.hpp"
#include "coast/io/results_folder.hpp"
#include "coast/io/writers.hpp"
#include "coast/record/error.hpp"
#include "coast/report/render.hpp"
#include "commands.hpp"
#include "load.hpp"
#include "ppk_page.hpp"
#include "progress.hpp"

namespace coast::cli {

void ppk(const std::filesystem::path& input, const CommonOptions& options) {
  ProgressLine line(options.quiet);
  const PpkConfig config = read_ppk(input);
  const std::filesystem::path out = output_folder(input, options.out);
  line.show("reading", 0.0);
  const PpkResult result = run_ppk(config, [&](double share) { line.show("solving", share); });
  line.show("writing", 0.0);
  const report::Page page = ppk_page(config, result);
  io::begin_results(out / "ppk.json");
  io::write_gnss_pos(out / "ppk.pos", result.fixes);
  io::write_text(out / "residuals.csv", residuals_csv(result));
  io::write_text(out / "ppk.resolved.yaml", config.map.resolved_yaml());
  io::write_text(out / "report.json", report::to_json(page));
  io::write_text(out / "report.html", report::render(page));
  io::write_text(out / "ppk.json", ppk_json(config, result));
  line.clear();
  for (const record::Event& event : result.events)
    if (event.severity == record::Event::Severity::kWarning) fmt::print(stderr, "warning: {}\n", event.text);
  if (!options.quiet)
    for (const std::string& sentence : ppk_sentences(result)) fmt::print("{}\n", sentence);
  if (result.fixes.fixes.empty())
    throw NumericalError("no epoch with a position", "",
                         fmt::format("fewer than four satellites above elevation_mask_deg: {:g} whose codes agree; {} shows "
                                     "what was seen",
                                     config.options.differences.elevation_mask / geo::kDegree, (out / "report.html").string()));
  if (!options.quiet) fmt::print("positions: {}\n", (out / "ppk.pos").string());
}

}  // namespace coast::cli
