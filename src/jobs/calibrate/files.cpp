// Output files and messages of `coast calibrate`.

#include <fmt/format.h>

#include "calibrate/page/page.hpp"
#include "calibrate/result.hpp"
#include "coast/io/results_folder.hpp"
#include "coast/io/writers.hpp"
#include "common/results.hpp"

namespace coast::jobs {

std::vector<std::string> files_of(const CalibrationConfig&) {
  return {"error_model.yaml", "calibration.json", "report.json", "report.html"};
}

void write(const CalibrationConfig& config, const CalibrationResult& result, const std::filesystem::path& folder) {
  const report::Page page = calibration_page(config, result);
  io::begin_results(folder / "calibration.json");
  io::write_text(folder / "error_model.yaml", error_model_yaml(config, result));
  write_page(page, folder);
  io::write_text(folder / "calibration.json", calibration_json(config, result));
}

std::string told(const CalibrationConfig&, const CalibrationResult& result, const std::filesystem::path& folder) {
  return fmt::format("{}error model: {}\n", calibration_text(result), (folder / "error_model.yaml").string());
}

}  // namespace coast::jobs
