// Output files and messages of `coast diagnose`.

#include <fmt/format.h>

#include "coast/io/results_folder.hpp"
#include "coast/io/writers.hpp"
#include "common/results.hpp"
#include "diagnose/result.hpp"

namespace coast::jobs {

namespace {

constexpr const char* kErrorModel = "error_model.diagnosed.yaml";  // next to the run file, so that both can be moved

}  // namespace

std::vector<std::string> files_of(const DiagnosisConfig&) {
  return {"diagnosis.json", "run.diagnosed.yaml", kErrorModel, "report.json", "report.html"};
}

void write(const DiagnosisConfig& config, const DiagnosisResult& result, const std::filesystem::path& folder) {
  const std::string diagnosed = diagnosed_yaml(config.run.root.resolved_yaml(), result.diagnosis, kErrorModel);
  io::begin_results(folder / "diagnosis.json");
  if (changes_error_model(result.diagnosis))
    io::write_text(folder / kErrorModel, result.diagnosis.modelled.setup.model.yaml());
  else
    std::filesystem::remove(folder / kErrorModel);  // of an earlier diagnosis
  io::write_text(folder / "run.diagnosed.yaml", diagnosed);
  write_page(
      diagnosis_page(config.run.file.filename().string(), result, diagnosed, changed_lines(result.diagnosis, kErrorModel)),
      folder);
  io::write_text(folder / "diagnosis.json", diagnosis_json(result));
}

std::string told(const DiagnosisConfig&, const DiagnosisResult& result, const std::filesystem::path& folder) {
  std::string text = diagnosis_text(result);
  if (!changed_lines(result.diagnosis, kErrorModel).empty())
    text += fmt::format("the run with it: {}\n", (folder / "run.diagnosed.yaml").string());
  return text + fmt::format("report: {}\n", (folder / "report.html").string());
}

}  // namespace coast::jobs
