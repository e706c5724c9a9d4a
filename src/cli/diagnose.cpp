#include <fmt/format.h>

#include "coast/diagnose/diagnosis.hpp"
#include "coast/io/writers.hpp"
#include "coast/report/render.hpp"
#include "commands.hpp"
#include "diagnosis_json.hpp"
#include "load.hpp"
#include "progress.hpp"

namespace coast::cli {

void diagnose(const std::filesystem::path& run_yaml, const CommonOptions& options) {
  ProgressLine line(options.quiet);
  const study::Progress progress = [&line](const char* what, double fraction) { line.show(what, fraction); };
  const RunConfig config = read_run_config(run_yaml);
  if (config.tight)
    throw InputError({run_yaml.string(), 0, "tightly coupled observations", "positions: effects are sought in fixes", ""});
  Recordings recordings = load(config, [&line](double share) { line.show("solving GNSS positions", share); });
  const std::filesystem::path out = output_folder(run_yaml, options.out);
  line.clear();
  print_inspection(recordings, options.quiet);
  if (!config.effects.empty())
    throw InputError({run_yaml.string(), 0, "`effects` that were found already", "a run without them",
                      "Take them out of the file: they are sought from nothing."});
  const study::Setup setup = setup_of(config, recordings, {});
  const diagnose::MissionInput input{std::move(recordings.imu), std::move(recordings.gnss), setup};
  const diagnose::Diagnosis diagnosis = diagnose::diagnose(input, {}, progress);
  line.clear();
  const std::filesystem::path error_model = std::filesystem::absolute(out / "error_model.diagnosed.yaml");
  const std::string diagnosed = diagnosed_yaml(config.root.resolved_yaml(), diagnosis, error_model.string());
  if (changes_error_model(diagnosis)) io::write_text(error_model, diagnosis.modelled.setup.model.yaml());
  io::write_text(out / "diagnosis.json", diagnosis_json(diagnosis, input));
  io::write_text(out / "run.diagnosed.yaml", diagnosed);
  const report::Page page = diagnosis_page(run_yaml.filename().string(), diagnosis, diagnosed);
  io::write_text(out / "report.json", report::to_json(page));
  io::write_text(out / "report.html", report::render(page));
  if (!options.quiet) fmt::print("{}report: {}\n", diagnosis_text(diagnosis), (out / "report.html").string());
}

}  // namespace coast::cli
